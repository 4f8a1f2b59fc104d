"""
Start a simulated arm and dynamics_node beside it; the arm's brakes are engaged.

    ros2 launch dynamics_node demo.launch.py
    ros2 service call /dynamics_node/enable std_srvs/srv/SetBool '{data: true}'
    ros2 service call /simulated_robot/set_brakes std_srvs/srv/SetBool '{data: false}'

"""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    """Return the simulated robot, the node and their arguments."""
    share = Path(get_package_share_directory('dynamics_node'))
    return LaunchDescription([
        DeclareLaunchArgument('robot', default_value=str(share / 'config/robots/arm7.urdf'),
                              description='Path of the URDF'),
        DeclareLaunchArgument('params_file', default_value=str(share / 'config/dynamics.yaml'),
                              description='Parameter file of the node'),
        DeclareLaunchArgument('view', default_value='false',
                              description='Open the viewer of the simulated robot'),
        Node(package='dynamics_node', executable='simulated_robot', name='simulated_robot',
             parameters=[{'robot_description_file': LaunchConfiguration('robot'),
                          'view': LaunchConfiguration('view')}], output='screen'),
        Node(package='dynamics_node', executable='dynamics_node', name='dynamics_node',
             parameters=[LaunchConfiguration('params_file')], output='screen'),
    ])
