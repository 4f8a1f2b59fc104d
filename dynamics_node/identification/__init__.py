"""
Write-back of better inertial and friction parameters: into the URDF and the node's parameters.

What may change here: where a number is written. Without ROS.

"""
