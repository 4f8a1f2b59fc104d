"""
Topics and services of the node, each with a sentence for users.

A test compares them with the graph of a running node and fails on a missing or superfluous entry.
Add one entry for a new topic; services come from their docstrings. Then run
scripts/write_reference.py.

"""

from dataclasses import dataclass
import inspect

from dynamics_node.ros.services.payload_gravity_services import PayloadGravityServices
from dynamics_node.ros.services.state_services import StateServices
from dynamics_node.ros.services.trajectory_services import TrajectoryServices


@dataclass(frozen=True)
class Entry:
    """A topic or service: its name with `~`, its type, and its meaning."""

    name: str
    kind: str
    words: str


SUBSCRIBED = (
    Entry(
        'joint_states',
        'sensor_msgs/msg/JointState',
        'Read by name: any order, subsets, additional joints and missing velocities are accepted. '
        'Best effort, the newest wins. With several publishers, each keeps its newest state',
    ),
    Entry(
        'robot_description',
        'std_msgs/msg/String',
        'As from robot_state_publisher, transient local; not subscribed if a parameter gives it',
    ),
)

PUBLISHED = (
    Entry(
        '~/gravity_torque',
        'sensor_msgs/msg/JointState',
        'For every usable joint state, while it has a subscriber: name, position, effort = G',
    ),
    Entry(
        '~/dynamics',
        'dynamics_interfaces/msg/JointDynamics',
        'The same, unless `publish_dynamics` is false: D, C at the measured velocity, C q̇, G',
    ),
    Entry(
        '~/external_torque',
        'sensor_msgs/msg/JointState',
        'For every usable joint state with velocity and effort, while '
        '`publish_external_torque` is true: name, position, velocity, effort = the external '
        'torque on each joint',
    ),
    Entry(
        'forward_effort_controller/commands',
        'std_msgs/msg/Float64MultiArray',
        'Only while the output is enabled, in the order of `joints`. The parameter '
        '`command_topic` names another one',
    ),
    Entry(
        '~/state',
        'dynamics_interfaces/msg/OutputState',
        'From the first model on, on every change, transient local: READY, STARTING, ACTIVE, '
        'STOPPING, FAULT or HOLDING, and the reason',
    ),
    Entry(
        '/diagnostics',
        'diagnostic_msgs/msg/DiagnosticArray',
        'Once a second and on every change: model, joint states (rate, age, publishers, '
        'skipped, rejected by reason), output (rate, limits hit), state machine (reason, '
        'latched fault), external torque (missing inputs, efforts that can hardly be torques)',
    ),
)


def _entry(name, kind, doc):
    # The first line of the docstring is a sentence: "Answer ...".
    words = ' '.join(inspect.cleandoc(doc).split('\n\n')[0].split())
    words = words.removeprefix('Answer ').removesuffix('.')
    package = kind.__module__.partition('.')[0]
    return Entry(f'~/{name}', f'{package}/srv/{kind.__name__}', words[0].upper() + words[1:])


SERVICES = (
    *(
        _entry(*service)
        for group in (StateServices, TrajectoryServices, PayloadGravityServices)
        for service in group.declared()
    ),
    Entry('~/enable', 'std_srvs/srv/SetBool', 'Accepted, or every reason for the refusal'),
)

# Of the program effort_guard, in one table: topic or service, type, content.
EFFORT_GUARD = (
    Entry(
        '~/commands',
        'std_msgs/msg/Float64MultiArray',
        'Subscribed. Set the `command_topic` of the dynamics node to it; the parameter '
        '`input_topic` names another one',
    ),
    Entry(
        'forward_effort_controller/commands',
        'std_msgs/msg/Float64MultiArray',
        'Published. The commands, unchanged and at once, or the fade to zero; the parameter '
        '`output_topic` names another one',
    ),
    Entry(
        '~/state',
        'dynamics_interfaces/msg/OutputState',
        'Published on every change, transient local. READY: no effort is in force. ACTIVE: '
        'commands pass. STOPPING: the last command fades. FAULT: it has faded, or commands do '
        'not begin near zero. STARTING: the output approaches returning commands',
    ),
    Entry(
        '/diagnostics',
        'diagnostic_msgs/msg/DiagnosticArray',
        'Published once a second: state, commands passed and refused by kind, fades, silences '
        'bridged, standstills of the guard itself',
    ),
    Entry(
        '~/reset',
        'std_srvs/srv/Trigger',
        'Service. Leaves FAULT: the next commands are taken with any values, by a ramp from zero',
    ),
)

# Of the markers program; <node> is its parameter `dynamics_node`.
MARKERS = (
    Entry(
        '<node>/markers',
        'visualization_msgs/msg/MarkerArray',
        'Published at most 20 times a second, while it has a subscriber: masses, inertia, '
        'gravity and torques ([RViz](rviz.md)). Frame: the root link',
    ),
    Entry(
        'robot_description',
        'std_msgs/msg/String',
        'Subscribed. Used unless the parameters of the dynamics node give a description',
    ),
    Entry(
        'joint_states',
        'sensor_msgs/msg/JointState',
        'Subscribed while there is a subscriber to the markers: position and effort',
    ),
    Entry(
        '<node>/gravity_torque',
        'sensor_msgs/msg/JointState',
        'Subscribed while there is a subscriber to the markers',
    ),
    Entry(
        '/parameter_events',
        'rcl_interfaces/msg/ParameterEvent',
        'Subscribed: changes of payload, gravity and limits',
    ),
    Entry(
        '<node>/get_parameters',
        'rcl_interfaces/srv/GetParameters',
        'Called once after the dynamics node has started',
    ),
)

# Every node has these as well.
OF_EVERY_NODE = ('/rosout', '/parameter_events', '/clock')
