"""Robotics Toolbox for Python: a Robot of links with the same bodies, fixed links merged."""

import numpy as np
import roboticstoolbox
from spatialmath import SE3

from ..quantities import Call

NAME = 'roboticstoolbox'
PACKAGE = 'roboticstoolbox-python'
NOTE = (
    'Written in Python. Its robot is built link by link with the fixed links merged, which '
    'makes it faster. In version 1.5.0 its coriolis() fails on the copy without friction that '
    'it makes of a robot of links; the robots here have no friction, so they are their own '
    'copy.'
)


class FrictionlessRobot(roboticstoolbox.Robot):
    """A robot that is its own copy without friction."""

    def nofriction(self, *_, **__):
        """Return the robot itself."""
        return self


def robot_of(robot):
    """
    Return the toolbox's robot with every axis along z.

    Parameters
    ----------
    robot : Robot
        A chain of revolute joints.

    Returns
    -------
    roboticstoolbox.Robot

    """
    tree = robot.model.tree
    turns = [np.eye(4), *(_along_z(axis) for axis in tree.axis)]
    links: list = []
    for k in range(robot.n):
        # Body frames are turned such that the joint's axis is their z axis.
        placement = turns[tree.parent[k] + 1].T @ tree.joint_placement[k] @ turns[k + 1]
        J = turns[k + 1].T @ tree.inertia[k] @ turns[k + 1]
        mass, com = J[3, 3], J[:3, 3] / J[3, 3]
        planes = J[:3, :3] - mass * np.outer(com, com)
        links.append(
            roboticstoolbox.Link(
                roboticstoolbox.ET.SE3(SE3(placement, check=False)) * roboticstoolbox.ET.Rz(),
                name=tree.moving_joint_names[k],
                m=mass,
                r=com,
                I=np.trace(planes) * np.eye(3) - planes,
                parent=links[tree.parent[k]] if tree.parent[k] >= 0 else None,
            )
        )
    return FrictionlessRobot(links, name=robot.name, gravity=robot.model.gravity)


def calls(robot):
    """
    Return the toolbox's calls.

    Parameters
    ----------
    robot : Robot

    Returns
    -------
    dict of str to Call

    """
    arm = robot_of(robot)

    def dynamics(q, qd):
        return arm.inertia(q), arm.coriolis(q, qd), arm.gravload(q)

    def mass_matrix(q):
        return (arm.inertia(q),)

    def gravity(q):
        return (arm.gravload(q),)

    def inverse(q, qd, qdd):
        return (arm.rne(q, qd, qdd),)

    def forward(q, qd, tau):
        return (arm.accel(q, qd, tau),)

    return {
        'dynamics': Call(dynamics, ('D', 'C', 'G'), 'inertia, coriolis, gravload'),
        'mass_matrix': Call(mass_matrix, ('D',), 'inertia'),
        'gravity': Call(gravity, ('G',), 'gravload'),
        'inverse': Call(inverse, ('tau',), 'rne'),
        'forward': Call(forward, ('qdd',), 'accel'),
    }


def _along_z(axis):
    # A homogeneous rotation whose third column is the axis.
    helper = np.eye(3)[np.argmin(np.abs(axis))]
    x = np.cross(helper, axis)
    x /= np.linalg.norm(x)
    turn = np.eye(4)
    turn[:3, :3] = np.column_stack([x, np.cross(axis, x), axis])
    return turn
