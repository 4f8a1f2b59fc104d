"""
Use of rclpy in all rooms of the node: errors, executors, quality of service, hints, process.

What may change here: how rclpy is used. No dynamics in here.

"""
