"""
Parts of ROS 2 that several rooms of the node use: errors, executors, qualities of service, hints.

What may change here: how rclpy is used. Nothing in here knows dynamics.

"""
