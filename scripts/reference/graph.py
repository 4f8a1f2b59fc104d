"""
Topics and services of the node, with their descriptions.

A test compares them with the graph of a running node.
A new topic or service gets one line here; then run scripts/write_reference.py.

"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Entry:
    """A topic or service: name, type and description."""

    name: str
    kind: str
    words: str


SUBSCRIBED = (
    Entry(
        'joint_states',
        'sensor_msgs/msg/JointState',
        'By name: any order, parts, other joints besides, no velocity: all fine. Best effort, '
        'the newest wins. With several publishers, none loses its state to another one',
    ),
    Entry(
        'robot_description',
        'std_msgs/msg/String',
        'As robot_state_publisher publishes it, transient local; not where a parameter gives it',
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
        '`publish_external_torque` is true: name, position, velocity, effort = what pushes the '
        'joints from outside',
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
        'STOPPING, FAULT and the reason',
    ),
    Entry(
        '/diagnostics',
        'diagnostic_msgs/msg/DiagnosticArray',
        'Once a second and on every change: model, joint states (rate, age, publishers, '
        'skipped, rejected by reason), output (rate, limits hit), state machine (reason, '
        'latched fault), external torque (what is missing, efforts that can hardly be torques)',
    ),
)

SERVICES = (
    Entry('~/get_mass_matrix', 'dynamics_interfaces/srv/GetMassMatrix', 'D'),
    Entry('~/get_coriolis_matrix', 'dynamics_interfaces/srv/GetCoriolisMatrix', 'C and C q̇'),
    Entry('~/get_gravity_torque', 'dynamics_interfaces/srv/GetGravityTorque', 'G'),
    Entry(
        '~/get_dynamics',
        'dynamics_interfaces/srv/GetDynamics',
        'D, C, C q̇, G, kinetic and potential energy',
    ),
    Entry(
        '~/inverse_dynamics',
        'dynamics_interfaces/srv/InverseDynamics',
        'The efforts of a motion, with or without friction and gravity',
    ),
    Entry(
        '~/forward_dynamics',
        'dynamics_interfaces/srv/ForwardDynamics',
        'The accelerations that efforts cause; joints that are not in `joints` are held',
    ),
    Entry(
        '~/get_jacobian',
        'dynamics_interfaces/srv/GetJacobian',
        'J of a point of any link, 6 x n, linear rows first, base frame; and where it is',
    ),
    Entry(
        '~/compute_trajectory_effort',
        'dynamics_interfaces/srv/ComputeTrajectoryEffort',
        'The same trajectory with `effort` in every point; points and joints above their limit',
    ),
    Entry(
        '~/get_max_payload',
        'dynamics_interfaces/srv/GetMaxPayload',
        'The largest mass at a point of a link, at a state or over a trajectory, and the joint '
        'that allows no more',
    ),
    Entry(
        '~/set_payload',
        'dynamics_interfaces/srv/SetPayload',
        'The payload in force; m = 0 removes it',
    ),
    Entry(
        '~/set_gravity',
        'dynamics_interfaces/srv/SetGravity',
        'Gravity in force; it points to the earth, in the frame of any link',
    ),
    Entry('~/enable', 'std_srvs/srv/SetBool', 'Accepted, or the reasons why not'),
)

# Topics and services of the program effort_guard.
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
        'not begin near zero. STARTING: the output approaches commands that came again',
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
        'Service. Leaves FAULT: the next commands are taken whatever they are, by a ramp from '
        'zero',
    ),
)

# Topics and services of the markers program; <node> is its parameter `dynamics_node`.
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
        'Subscribed: payload, gravity and limits that change',
    ),
    Entry(
        '<node>/get_parameters',
        'rcl_interfaces/srv/GetParameters',
        'Called once after the dynamics node has started',
    ),
)

# Topics of every node.
OF_EVERY_NODE = ('/rosout', '/parameter_events', '/clock')
