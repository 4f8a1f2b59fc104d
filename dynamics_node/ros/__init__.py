"""
The ROS 2 node: the only room that imports rclpy. Convert, call the library, convert back.

What may change here: topics, services, parameters and the words that users see. No mathematics
of motion, and no decision about the output: those are in `dynamics` and `output`.

"""
