#!/usr/bin/env python3
"""
Write config/robots/*.yaml: parameter files for a first try of the arms that the demo holds.

The limits follow from the URDF: the largest gravity torque in the range of the joints, plus a
quarter. In `make shell`:

    python scripts/write_robot_configs.py

Then try each file with the demo; its first lines contain the command.

"""

from dataclasses import dataclass
from pathlib import Path
import sys

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / 'test')]

from dynamics_node import RobotModel  # noqa: E402
from dynamics_node.report import make_report  # noqa: E402
import numpy as np  # noqa: E402
from support.robots import ARM7, public_robot  # noqa: E402

FOLDER = ROOT / 'config' / 'robots'
# Limit as a multiple of the largest gravity torque.
MARGIN = 1.25
# Smallest limit as a part of the URDF's limit.
LEAST = 0.05

COMPENSATES = (
    'THE REAL ARM COMPENSATES GRAVITY ITSELF: never enable the output there, it would push',
    'the arm up (docs/arms.md). Use the services and ~/gravity_torque.',
)
UNKNOWN = (
    'It is unknown whether the real arm compensates gravity below its effort interface:',
    'command zero effort and let it go gently before you enable the output (docs/arms.md).',
)


@dataclass(frozen=True)
class Arm:
    """An arm: its URDF in example-robot-data (or of this repository), and a warning."""

    title: str
    urdf: str
    warning: tuple


ARMS = {
    'arm7': Arm(
        'the arm of this repository', '', ('It was designed for the demo; no real one exists.',)
    ),
    'ur5': Arm('Universal Robots UR5', 'ur_description/urdf/ur5_robot.urdf', COMPENSATES),
    'panda': Arm('Franka Panda with its hand', 'panda_description/urdf/panda.urdf', COMPENSATES),
    'kinova_j2s6s200': Arm(
        'Kinova Jaco (Gen2, 6 joints)', 'kinova_description/robots/kinova.urdf', COMPENSATES
    ),
    'xarm7': Arm('UFACTORY xArm7', 'xarm_description/urdf/xarm7.urdf', UNKNOWN),
    'z1': Arm('Unitree Z1 with its gripper', 'z1_description/urdf/z1.urdf', UNKNOWN),
}


def urdf_path(arm):
    """Return the path of an arm's URDF."""
    return public_robot(arm.urdf) if arm.urdf else ARM7


def first_limits(path):
    """Return effort limits for a first try, shape (n,), N m or N, rounded up to a tenth."""
    report = make_report(path)
    robot, own = report.model, {joint.name: joint.gravity for joint in report.joints}
    worst = np.array([own[name].magnitude for name in robot.joint_names])
    allowed = np.where(np.isfinite(robot.effort_limits), robot.effort_limits, np.inf)
    least = np.where(np.isfinite(allowed), LEAST * allowed, 0.1)
    wanted = np.ceil(10.0 * np.maximum(MARGIN * worst, least)) / 10.0
    return np.minimum(wanted, allowed)


def render(name):
    """Return the parameter file of an arm."""
    arm = ARMS[name]
    robot = RobotModel.from_urdf(urdf_path(arm))
    where = f'example-robot-data, {arm.urdf}' if arm.urdf else 'config/robots/arm7.urdf'
    path = 'arm7.urdf' if not arm.urdf else Path(arm.urdf).name
    warning = '\n'.join(f'# {line}' for line in arm.warning)
    joints = '\n'.join(f'      - {joint}' for joint in robot.joint_names)
    limits = ', '.join(f'{limit:.1f}' for limit in first_limits(urdf_path(arm)))
    return f"""# {name}: {arm.title}, for a first try. URDF: {where}.
#
# Simulated only: the demo held this arm in MuJoCo with these parameters; no real one was tried.
{warning}
#
#     python -m dynamics_node.demo.__main__ --robot {path} --params-file {name}.yaml

/**/dynamics_node:
  ros__parameters:
    # The order of the efforts: the effort controller must have the same `joints`.
    joints:
{joints}

    # N m or N: the largest gravity torque in the range of the joints plus a quarter, at least a
    # twentieth of the URDF's limit and never above it. This leaves nothing for a payload.
    effort_limits: [{limits}]
"""


if __name__ == '__main__':
    for name in ARMS:
        path = FOLDER / f'{name}.yaml'
        path.write_text(render(name), encoding='utf-8')
        print(f'wrote {path.relative_to(ROOT)}')
