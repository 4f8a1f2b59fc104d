"""
Start a simulated arm and dynamics_node beside it; the arm's brakes are engaged.

    ros2 launch dynamics_node demo.launch.py
    ros2 service call /dynamics_node/enable std_srvs/srv/SetBool '{data: true}'
    ros2 service call /simulated_robot/set_brakes std_srvs/srv/SetBool '{data: false}'

With `rviz:=true`, RViz shows masses, gravity and torques, drawn by the markers program. With
`namespace:=left` all names are below /left, so that two arms, left and right, run independently.

"""

from pathlib import Path
from xml.etree import ElementTree

from ament_index_python.packages import (
    get_package_prefix,
    get_package_share_directory,
    PackageNotFoundError,
)
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, LogInfo, OpaqueFunction, Shutdown
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

# Packages that show the robot and publish the frames of its links.
VIEWERS = ('rviz2', 'robot_state_publisher')


def generate_launch_description():
    """Return the simulated robot, the node and their arguments."""
    share = Path(get_package_share_directory('dynamics_node'))
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                'robot',
                default_value=str(share / 'config/robots/arm7.urdf'),
                description='Path of the URDF',
            ),
            DeclareLaunchArgument(
                'params_file',
                default_value='',
                description='Parameter file of '
                'the node. Empty: the defaults, with a state_timeout of 0.5 s',
            ),
            DeclareLaunchArgument(
                'namespace',
                default_value='',
                description='Namespace of both nodes and of their topics',
            ),
            DeclareLaunchArgument(
                'view', default_value='false', description='Open the viewer of the simulated robot'
            ),
            DeclareLaunchArgument(
                'rviz', default_value='false', description='Open RViz, if it is installed'
            ),
            OpaqueFunction(function=start),
            OpaqueFunction(function=show, condition=IfCondition(LaunchConfiguration('rviz'))),
        ]
    )


def start(context):
    """Return the simulated robot and the node."""
    robot = file_of('robot', LaunchConfiguration('robot').perform(context))
    params_file = LaunchConfiguration('params_file').perform(context)
    # A simulation on a desktop computer is late more often than a real arm.
    parameters = [file_of('params_file', params_file)] if params_file else [{'state_timeout': 0.5}]
    namespace = LaunchConfiguration('namespace')
    return [
        Node(
            package='dynamics_node',
            executable='simulated_robot',
            name='simulated_robot',
            namespace=namespace,
            parameters=[{'robot_description_file': robot, 'view': LaunchConfiguration('view')}],
            # Its log has the reason; the node alone would only report a missing description.
            output='screen',
            on_exit=Shutdown(reason='the simulated robot has ended'),
        ),
        Node(
            package='dynamics_node',
            executable='dynamics_node',
            name='dynamics_node',
            namespace=namespace,
            parameters=parameters,
            output='screen',
        ),
    ]


def file_of(argument, path):
    """Return the absolute path of an existing file."""
    file = Path(path).expanduser().resolve()
    # launch_ros only warns, and the node would start with the URDF's full effort limits.
    if not file.is_file():
        raise FileNotFoundError(f'{argument}: no such file: {str(file)!r}')
    return str(file)


def show(context):
    """Return RViz and the programs that it needs; without RViz, a log line and the demo alone."""
    missing = [package for package in VIEWERS if not is_installed(package)]
    if missing:
        return [
            LogInfo(
                msg=f'rviz:=true: {" and ".join(missing)} not found, going on without; '
                'install '
                + ' '.join(f'ros-$ROS_DISTRO-{package.replace("_", "-")}' for package in missing)
            )
        ]
    config = Path(get_package_share_directory('dynamics_node')) / 'config/dynamics.rviz'
    robot = file_of('robot', LaunchConfiguration('robot').perform(context))
    text = Path(robot).read_text(encoding='utf-8')
    namespace = LaunchConfiguration('namespace')
    # Link names are the same in every namespace, so each has its own frames.
    frames = [('/tf', 'tf'), ('/tf_static', 'tf_static')]
    return [
        Node(
            package='dynamics_node',
            executable='markers',
            name='markers',
            namespace=namespace,
            output='screen',
        ),
        # The simulated robot already publishes the description.
        Node(
            package='robot_state_publisher',
            executable='robot_state_publisher',
            namespace=namespace,
            parameters=[{'robot_description': text}],
            remappings=[*frames, ('robot_description', '~/robot_description')],
        ),
        Node(
            package='rviz2',
            executable='rviz2',
            namespace=namespace,
            arguments=['-d', str(config), '-f', root_link(text)],
            remappings=[
                *frames,
                ('/robot_description', 'robot_description'),
                ('/dynamics_node/markers', 'dynamics_node/markers'),
            ],
        ),
    ]


def is_installed(package):
    """Return whether a package is installed."""
    try:
        get_package_prefix(package)
    except PackageNotFoundError:
        return False
    return True


def root_link(text):
    """Return the root link of a URDF: the frame of the markers."""
    robot = ElementTree.fromstring(text.encode())
    children = {joint.find('child').get('link') for joint in robot.findall('joint')}
    return next(
        link.get('name') for link in robot.findall('link') if link.get('name') not in children
    )
