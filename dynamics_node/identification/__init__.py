"""
Identification: from recordings of a moving robot to a URDF whose masses are right.

What may change here: signal processing, estimation and its checks. Without ROS.

"""
