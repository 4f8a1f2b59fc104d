"""
Start dynamics_node with a parameter file.

    ros2 launch dynamics_node dynamics.launch.py params_file:=my_dynamics.yaml namespace:=left
    ros2 launch dynamics_node dynamics.launch.py robot:=my_arm.urdf joint_states:=/arm/states

With `effort_guard:=true` the commands pass through the effort guard, which fades them to zero when
the node dies. Its parameters belong in the same file, under /**/effort_guard.

"""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    """Return the node and its arguments."""
    share = Path(get_package_share_directory('dynamics_node'))
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                'params_file',
                default_value=str(share / 'config/dynamics.yaml'),
                description='Parameter file of the node',
            ),
            DeclareLaunchArgument(
                'namespace', default_value='', description='Namespace of the node and its topics'
            ),
            DeclareLaunchArgument(
                'robot',
                default_value='',
                description='Path of the URDF. Empty: '
                'from params_file, or the topic robot_description',
            ),
            DeclareLaunchArgument(
                'joint_states',
                default_value='joint_states',
                description='Topic of the joint states',
            ),
            DeclareLaunchArgument(
                'robot_description',
                default_value='robot_description',
                description='Topic of the robot description',
            ),
            DeclareLaunchArgument(
                'effort_guard',
                default_value='false',
                description='Send the commands through the effort guard',
            ),
            DeclareLaunchArgument(
                'controller_topic',
                default_value='forward_effort_controller/commands',
                description='Topic of the effort controller; only with '
                'effort_guard, in place of the parameter command_topic',
            ),
            OpaqueFunction(
                function=start_guard, condition=IfCondition(LaunchConfiguration('effort_guard'))
            ),
            OpaqueFunction(function=start_node),
        ]
    )


def start_guard(context):
    """Return the effort guard, between the node and the effort controller."""
    parameters = file_of('params_file', LaunchConfiguration('params_file').perform(context))
    return [
        Node(
            package='dynamics_node',
            executable='effort_guard',
            name='effort_guard',
            namespace=LaunchConfiguration('namespace'),
            parameters=[parameters, {'output_topic': LaunchConfiguration('controller_topic')}],
            output='screen',
        )
    ]


def start_node(context):
    """Return the node; the argument robot, if given, overrides the parameter file."""
    robot = LaunchConfiguration('robot').perform(context)
    more = [{'robot_description_file': file_of('robot', robot)}] if robot else []
    if IfCondition(LaunchConfiguration('effort_guard')).evaluate(context):
        more.append({'command_topic': 'effort_guard/commands'})
    parameters = file_of('params_file', LaunchConfiguration('params_file').perform(context))
    return [
        Node(
            package='dynamics_node',
            executable='dynamics_node',
            name='dynamics_node',
            namespace=LaunchConfiguration('namespace'),
            parameters=[parameters, *more],
            remappings=[
                (topic, LaunchConfiguration(topic))
                for topic in ('joint_states', 'robot_description')
            ],
            output='screen',
        )
    ]


def file_of(argument, path):
    """Return the absolute path of an existing file."""
    file = Path(path).expanduser().resolve()
    # launch_ros only warns, and the node would start with the URDF's full effort limits.
    if not file.is_file():
        raise FileNotFoundError(f'{argument}: no such file: {str(file)!r}')
    return str(file)
