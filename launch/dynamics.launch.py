"""
Start dynamics_node with a parameter file.

    ros2 launch dynamics_node dynamics.launch.py params_file:=my_dynamics.yaml namespace:=left

"""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    """Return the node and its arguments."""
    share = Path(get_package_share_directory('dynamics_node'))
    return LaunchDescription([
        DeclareLaunchArgument('params_file', default_value=str(share / 'config/dynamics.yaml'),
                              description='Parameter file of the node'),
        DeclareLaunchArgument('namespace', default_value='',
                              description='Namespace of the node and its topics'),
        Node(package='dynamics_node', executable='dynamics_node', name='dynamics_node',
             namespace=LaunchConfiguration('namespace'),
             parameters=[LaunchConfiguration('params_file')], output='screen'),
    ])
