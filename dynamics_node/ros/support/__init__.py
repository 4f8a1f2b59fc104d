"""
ROS 2 parts shared by the rooms of the node: errors, executors, quality of service, hints.

What may change here: how rclpy is used. Nothing here depends on dynamics.

"""
