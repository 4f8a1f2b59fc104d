"""
Every parameter of the node, in one table.

Declaration, checks and docs/reference.md follow from it. Tests compare it with a running node and
with config/dynamics.yaml.

"""

from collections.abc import Mapping, Sequence
import math
from typing import Any

from .declaration import check_each, DOUBLE, DOUBLES, FLAG, Parameter, TEXT, TEXTS
from ...dynamics.friction import SMOOTHING_VELOCITY
from ...errors import ParameterError
from ...safety.effort_output import STOP_BEHAVIORS

# Largest gravity acceleration, m/s².
MAX_GRAVITY = 20.0

PARAMETERS = (
    Parameter(
        'joints',
        TEXTS,
        (),
        'Joint names: rows of every response and order of the command. '
        'Empty: all movable joints in the order of the URDF',
        read_only=True,
    ),
    Parameter(
        'robot_description',
        TEXT,
        '',
        'URDF text. Empty: the file, or the topic robot_description',
        read_only=True,
    ),
    Parameter(
        'robot_description_file',
        TEXT,
        '',
        'Path of a URDF. Empty: the topic robot_description',
        read_only=True,
    ),
    Parameter(
        'gravity',
        DOUBLES,
        (0.0, 0.0, -9.81),
        'Gravity acceleration in the frame of the root link, m/s², points down',
        length=3,
        low=-MAX_GRAVITY,
        high=MAX_GRAVITY,
    ),
    Parameter(
        'machine_code',
        FLAG,
        False,
        'Compile machine code for the robot in another process at start: saves some '
        'microseconds per state. By default no compiler runs beside an arm',
        read_only=True,
    ),
    Parameter(
        'command_topic',
        TEXT,
        'forward_effort_controller/commands',
        'Topic of the efforts while the output is enabled',
        read_only=True,
    ),
    Parameter(
        'enable_on_start',
        FLAG,
        False,
        'Enable the output as soon as every check passes. Leave it off for arms that compensate '
        'gravity below the effort interface',
        read_only=True,
    ),
    Parameter('publish_dynamics', FLAG, True, 'Publish ~/dynamics while it has a subscriber'),
    Parameter(
        'publish_external_torque',
        FLAG,
        False,
        'Publish ~/external_torque. Needs velocities and efforts in joint_states, and efforts '
        'that are torques',
    ),
    Parameter(
        'external_torque.gain',
        DOUBLE,
        100.0,
        'Gain of the momentum observer, 1/s: 95 % of a step arrive after 3 / gain. A larger gain '
        'is faster and noisier',
        low=0.0,
        low_open=True,
        high=10_000.0,
    ),
    Parameter(
        'state_timeout',
        DOUBLE,
        0.2,
        'Largest age of a joint state, s, on the steady clock',
        low=0.0,
        low_open=True,
        high=10.0,
    ),
    Parameter(
        'allow_several_state_publishers',
        FLAG,
        False,
        'Enable with several publishers of joint_states, if arm and gripper have a broadcaster '
        'each. The queue of joint_states then holds more than one message',
        read_only=True,
    ),
    Parameter(
        'allow_self_compensating_arm',
        FLAG,
        False,
        'Enable although the ros2_control hardware plugin in the URDF drives an arm that '
        'compensates gravity itself: a second gravity torque pushes such an arm up '
        '(docs/arms.md)',
    ),
    Parameter(
        'allow_upward_gravity',
        FLAG,
        False,
        'Enable although gravity points up in the frame of the root link: for an arm that hangs '
        'from a ceiling',
    ),
    Parameter(
        'allow_limits_above_urdf',
        FLAG,
        False,
        'Enable although effort_limits or velocity_limits exceed those of the URDF',
    ),
    Parameter(
        'start_ramp',
        DOUBLE,
        0.5,
        'Time from zero to the full effort, s. A change of payload, gravity, terms, gains, '
        'offsets or limits while efforts are sent takes as long',
        low=0.0,
        high=60.0,
    ),
    Parameter(
        'stop_ramp', DOUBLE, 1.0, 'Time from the last effort to zero, s', low=0.0, high=60.0
    ),
    Parameter(
        'stop_behavior',
        TEXT,
        'ramp_to_zero',
        'How the output stops: ramp_to_zero, zero (as fast as the rate limits allow, at most '
        '1 s) or hold (when joint states end, the last effort stays in force; every other stop '
        'ramps to zero)',
        choices=STOP_BEHAVIORS,
    ),
    Parameter(
        'effort_limits',
        DOUBLES,
        (),
        'Largest effort per joint, N m or N, in the order of joints. Empty: those of the URDF; '
        'a joint without a limit refuses to be enabled',
        low=0.0,
        low_open=True,
        per_joint=True,
    ),
    Parameter(
        'effort_rate_limits',
        DOUBLES,
        (),
        'Largest change of effort per joint, N m/s or N/s. Empty: the effort limit per 0.1 s',
        low=0.0,
        low_open=True,
        per_joint=True,
    ),
    Parameter(
        'velocity_limits',
        DOUBLES,
        (),
        'Speed per joint above which the output stops (runaway), rad/s or m/s, in the order of '
        'joints. Empty: those of the URDF',
        low=0.0,
        low_open=True,
        per_joint=True,
    ),
    Parameter(
        'effort_scale',
        DOUBLES,
        (),
        'Gain on the model effort per joint. Empty: 1',
        low=0.0,
        high=10.0,
        per_joint=True,
    ),
    Parameter(
        'effort_offset',
        DOUBLES,
        (),
        'Calibrated bias per joint, N m or N: added to the model effort after effort_scale and '
        'before the limits. Empty: 0',
        low=-1e6,
        high=1e6,
        per_joint=True,
    ),
    Parameter(
        'compensate.gravity', FLAG, True, 'Whether the gravity torque G is part of the command'
    ),
    Parameter('compensate.coriolis', FLAG, False, 'Whether C qd is part of the command'),
    Parameter(
        'compensate.friction',
        FLAG,
        False,
        'Whether friction is part of the command. It is positive feedback: begin with less than '
        "the arm's friction",
    ),
    Parameter(
        'friction.viscous',
        DOUBLES,
        (),
        'Viscous friction per joint, N m s/rad or N s/m, in the order of joints. '
        'Empty: <dynamics damping> of the URDF',
        low=0.0,
        high=1e6,
        per_joint=True,
    ),
    Parameter(
        'friction.coulomb',
        DOUBLES,
        (),
        'Coulomb friction per joint, N m or N. Empty: <dynamics friction> of the URDF',
        low=0.0,
        high=1e6,
        per_joint=True,
    ),
    Parameter(
        'friction.smoothing_velocity',
        DOUBLES,
        (),
        'Speed at which Coulomb friction has 76 % of its size, rad/s or m/s: one number, or one '
        f'per joint. Empty: {SMOOTHING_VELOCITY:g}. Friction is viscous qd + coulomb '
        'tanh(qd / smoothing)',
        low=0.0,
        low_open=True,
        per_joint=True,
        takes_one=True,
    ),
    Parameter(
        'rotor_inertia',
        DOUBLES,
        (),
        'Inertia of the rotors reflected to the joints (with the square of the gear ratio), '
        'kg m² or kg, per joint. Empty: 0',
        low=0.0,
        high=1e6,
        per_joint=True,
    ),
    Parameter('payload.link', TEXT, '', 'Link that carries the payload'),
    Parameter(
        'payload.mass', DOUBLE, 0.0, 'Mass of the payload, kg; 0: there is none', low=0.0, high=1e5
    ),
    Parameter(
        'payload.com',
        DOUBLES,
        (0.0, 0.0, 0.0),
        'Center of mass of the payload in the frame of its link, m',
        length=3,
        low=-1000.0,
        high=1000.0,
    ),
    Parameter(
        'payload.inertia',
        DOUBLES,
        (0.0,) * 6,
        'Inertia tensor of the payload about its center of mass along the axes of its link, '
        'kg m²: ixx, ixy, ixz, iyy, iyz, izz',
        length=6,
    ),
)


def check_all(values: Mapping[str, Any]) -> dict[str, Any]:
    """
    Check the value of every parameter, and the conditions between them.

    Parameters
    ----------
    values : mapping of str to Any
        Name → value from ROS; a missing name gets its default.

    Returns
    -------
    dict of str to Any
        Name → value of its kind, for all parameters.

    Raises
    ------
    ParameterError
        Lists every problem, one sentence each.

    """
    checked, problems = check_each(PARAMETERS, values)
    size = math.sqrt(sum(item * item for item in checked.get('gravity', ())))
    if size > MAX_GRAVITY:
        problems.append(f'gravity: expected at most {MAX_GRAVITY:g} m/s^2, got {size:.6g}')
    if checked.get('payload.mass') and not checked.get('payload.link', 'unknown'):
        problems.append(
            'payload.link: expected the link that carries payload.mass, got none; '
            'set payload.link first'
        )
    if problems:
        raise ParameterError('; '.join(problems))
    return checked


def check_lengths(values: Mapping[str, Any], joint_names: Sequence[str]) -> None:
    """
    Check that every parameter with one number per joint fits a robot.

    Parameters
    ----------
    values : mapping of str to Any
        Name → value, checked by `check_all`.
    joint_names : sequence of str
        Chosen joints of the robot.

    Raises
    ------
    ParameterError
        If one has another number of entries; empty ones are accepted.

    """
    for parameter in PARAMETERS:
        if not parameter.per_joint:
            continue
        count = len(values[parameter.name])
        if count not in (0, len(joint_names)) and not (parameter.takes_one and count == 1):
            raise ParameterError(
                f'{parameter.name}: expected {len(joint_names)} numbers for '
                f'{", ".join(joint_names)}, or none; got {count}'
            )
