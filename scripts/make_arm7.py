#!/usr/bin/env python3
"""
Write config/robots/arm7.urdf, the 7-joint arm of the demo and the tests.

Every inertial is computed from homogeneous bodies of stated size and density (`Part`). After a
change here:

    python3 scripts/make_arm7.py            # rewrite the file
    python3 scripts/make_arm7.py --check    # only compare; exit code 1 if the file differs

"""

import argparse
from dataclasses import dataclass
from pathlib import Path
import sys
from xml.etree import ElementTree as ET

import numpy as np

OUTPUT = Path(__file__).resolve().parents[1] / 'config' / 'robots' / 'arm7.urdf'

Vector = tuple[float, float, float]

# Densities [kg/m^3]. A motor module is a motor, a strain wave gear, a brake and two encoders in an
# aluminium housing; 3400 is the mean of that mixture of steel, copper, aluminium and air.
ALUMINIUM = 2700.0
MOTOR_MODULE = 3400.0
HAND_MIXTURE = 1500.0

ALONG_Y = (np.pi / 2, 0.0, 0.0)
COLORS = {'white': '0.92 0.93 0.95 1', 'dark': '0.20 0.22 0.26 1', 'orange': '0.95 0.45 0.10 1'}

HEADER = """
  arm7: a 7-joint arm with a parallel gripper, designed for this package (no product's geometry).
  Written by scripts/make_arm7.py; do not edit by hand.

  Inertials: every link is a set of homogeneous tubes, cylinders and boxes, listed in a comment
    in the link with size and mass. Densities [kg/m^3]: aluminium tubes and boxes 2700,
    motor modules 3400 (mean of motor, strain wave gear, brake, encoders and housing), hand 1500.
    Mass, center of mass and inertia follow from them. Where the tensor is not diagonal in the
    link's axes it is given in its principal axes, and <origin rpy> turns them.
  Limits: effort, velocity and range are of the class that public data sheets of 7-axis research
    arms give (about 90 N m and 2.2 rad/s at the big joints, 12 to 30 N m at the wrist).
  Damping: viscous, N m s/rad, of the order identified for strain wave drives of these sizes.
    There is no Coulomb friction on purpose: nothing but the right torque holds this arm still.
  Reach: 0.85 m from the shoulder to the flange. Units: m, kg, rad, N, s.
"""


@dataclass(frozen=True)
class Part:
    """
    A homogeneous body, fixed in a link.

    A cylinder's size is (outer radius, inner radius, length) along its z axis, a box's its three
    edges, all in m. `xyz` [m] and `rpy` [rad] place its center in the link's frame.

    """

    shape: str
    size: Vector
    density: float
    color: str
    xyz: Vector = (0.0, 0.0, 0.0)
    rpy: Vector = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Link:
    """A rigid link: a name and its parts; a frame has none."""

    name: str
    parts: tuple[Part, ...]


@dataclass(frozen=True)
class Joint:
    """A joint between two links; the limits are (lower, upper, effort, velocity), SI units."""

    name: str
    kind: str
    parent: str
    child: str
    xyz: Vector
    axis: Vector = (0.0, 0.0, 1.0)
    limits: tuple[float, ...] = ()
    damping: float = 0.0
    mimic: str = ''


def tube(outer: float, inner: float, bottom: float, top: float) -> Part:
    """Return an aluminium tube along z, from height `bottom` to `top` [m]."""
    size = (outer, inner, round(top - bottom, 9))
    return Part('cylinder', size, ALUMINIUM, 'white', (0.0, 0.0, (bottom + top) / 2))


def motor(radius: float, length: float, xyz: Vector, rpy: Vector = (0.0, 0.0, 0.0)) -> Part:
    """Return a motor module: a full cylinder of the mixture's density."""
    return Part('cylinder', (radius, 0.0, length), MOTOR_MODULE, 'dark', xyz, rpy)


LINKS = (
    Link(
        'base',
        (
            Part('cylinder', (0.095, 0.0, 0.02), ALUMINIUM, 'dark', (0.0, 0.0, 0.01)),
            tube(0.06, 0.054, 0.02, 0.16),
            motor(0.05, 0.10, (0.0, 0.0, 0.11)),
        ),
    ),
    Link('shoulder', (tube(0.06, 0.054, 0.0, 0.12), motor(0.05, 0.10, (0.0, 0.0, 0.17), ALONG_Y))),
    Link('upper_arm', (tube(0.052, 0.047, 0.05, 0.16), motor(0.045, 0.09, (0.0, 0.0, 0.115)))),
    Link('elbow', (tube(0.05, 0.046, 0.0, 0.105), motor(0.045, 0.09, (0.0, 0.0, 0.15), ALONG_Y))),
    Link('forearm', (tube(0.042, 0.038, 0.045, 0.20), motor(0.035, 0.075, (0.0, 0.0, 0.1625)))),
    Link(
        'wrist', (tube(0.042, 0.038, 0.0, 0.135), motor(0.035, 0.075, (0.0, 0.0, 0.17), ALONG_Y))
    ),
    Link(
        'hand_offset',
        (
            Part('box', (0.13, 0.06, 0.02), ALUMINIUM, 'white', (0.03, 0.0, 0.045)),
            motor(0.035, 0.075, (0.06, 0.0, 0.0925)),
        ),
    ),
    Link(
        'wrist_disc',
        (Part('cylinder', (0.036, 0.0, 0.02), ALUMINIUM, 'orange', (0.0, 0.0, 0.01)),),
    ),
    Link(
        'flange', (Part('cylinder', (0.0315, 0.01, 0.02), ALUMINIUM, 'white', (0.0, 0.0, 0.01)),)
    ),
    Link('hand', (Part('box', (0.05, 0.13, 0.07), HAND_MIXTURE, 'dark', (0.0, 0.0, 0.035)),)),
    Link(
        'left_finger', (Part('box', (0.02, 0.014, 0.06), ALUMINIUM, 'orange', (0.0, 0.007, 0.03)),)
    ),
    Link(
        'right_finger',
        (Part('box', (0.02, 0.014, 0.06), ALUMINIUM, 'orange', (0.0, -0.007, 0.03)),),
    ),
    Link('tool_center', ()),
)

Y_AXIS = (0.0, 1.0, 0.0)

JOINTS = (
    Joint(
        'shoulder_yaw',
        'revolute',
        'base',
        'shoulder',
        (0.0, 0.0, 0.16),
        limits=(-2.8, 2.8, 90.0, 2.2),
        damping=5.0,
    ),
    Joint(
        'shoulder_pitch',
        'revolute',
        'shoulder',
        'upper_arm',
        (0.0, 0.0, 0.17),
        Y_AXIS,
        (-2.1, 2.1, 90.0, 2.2),
        5.0,
    ),
    Joint(
        'upper_arm_roll',
        'revolute',
        'upper_arm',
        'elbow',
        (0.0, 0.0, 0.16),
        limits=(-2.8, 2.8, 90.0, 2.2),
        damping=4.0,
    ),
    Joint(
        'elbow_pitch',
        'revolute',
        'elbow',
        'forearm',
        (0.0, 0.0, 0.15),
        Y_AXIS,
        (-2.4, 2.4, 90.0, 2.2),
        4.0,
    ),
    Joint(
        'forearm_roll',
        'revolute',
        'forearm',
        'wrist',
        (0.0, 0.0, 0.20),
        limits=(-2.8, 2.8, 30.0, 2.6),
        damping=1.0,
    ),
    Joint(
        'wrist_pitch',
        'revolute',
        'wrist',
        'hand_offset',
        (0.0, 0.0, 0.17),
        Y_AXIS,
        (-2.0, 2.0, 30.0, 2.6),
        1.0,
    ),
    Joint(
        'wrist_roll',
        'revolute',
        'hand_offset',
        'wrist_disc',
        (0.06, 0.0, 0.13),
        limits=(-2.9, 2.9, 12.0, 2.6),
        damping=0.5,
    ),
    Joint('wrist_disc_to_flange', 'fixed', 'wrist_disc', 'flange', (0.0, 0.0, 0.02)),
    Joint('flange_to_hand', 'fixed', 'flange', 'hand', (0.0, 0.0, 0.02)),
    Joint(
        'left_finger_slide',
        'prismatic',
        'hand',
        'left_finger',
        (0.0, 0.0, 0.07),
        Y_AXIS,
        (0.0, 0.04, 40.0, 0.2),
        10.0,
    ),
    Joint(
        'right_finger_slide',
        'prismatic',
        'hand',
        'right_finger',
        (0.0, 0.0, 0.07),
        (0.0, -1.0, 0.0),
        (0.0, 0.04, 40.0, 0.2),
        10.0,
        mimic='left_finger_slide',
    ),
    Joint('hand_to_tool_center', 'fixed', 'hand', 'tool_center', (0.0, 0.0, 0.12)),
)


def rotation(rpy: Vector) -> np.ndarray:
    """Return the 3x3 rotation of URDF's fixed-axis roll, pitch, yaw [rad]."""
    (cr, cp, cy), (sr, sp, sy) = np.cos(rpy), np.sin(rpy)
    roll = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    pitch = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    yaw = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return yaw @ pitch @ roll


def roll_pitch_yaw(r: np.ndarray) -> np.ndarray:
    """Return the angles [rad] of a 3x3 rotation away from pitch = +-90 degrees."""
    pitch = np.arctan2(-r[2, 0], np.hypot(r[0, 0], r[1, 0]))
    return np.array([np.arctan2(r[2, 1], r[2, 2]), pitch, np.arctan2(r[1, 0], r[0, 0])])


def part_mass(part: Part) -> float:
    """Return the mass of a part [kg]: density times volume."""
    if part.shape == 'box':
        return part.density * float(np.prod(part.size))
    outer, inner, length = part.size
    return part.density * np.pi * (outer**2 - inner**2) * length


def part_inertia(part: Part) -> np.ndarray:
    """Return the inertia about the part's own center, in the link's axes [kg m^2], (3, 3)."""
    if part.shape == 'box':
        x, y, z = np.square(part.size)
        moments = np.array([y + z, x + z, x + y]) / 12
    else:
        outer, inner, length = part.size
        across = (3 * (outer**2 + inner**2) + length**2) / 12
        moments = np.array([across, across, (outer**2 + inner**2) / 2])
    turn = rotation(part.rpy)
    return part_mass(part) * turn @ np.diag(moments) @ turn.T


def link_inertial(parts: tuple[Part, ...]) -> tuple[float, np.ndarray, np.ndarray]:
    """
    Return mass [kg], center of mass [m] (3,) and inertia about it [kg m^2] (3, 3) of a link.

    The parts add by Steiner's theorem: I = sum(I_k + m_k (d.d 1 - d d^T)), d from com to part.

    """
    masses = [part_mass(part) for part in parts]
    com = sum(m * np.array(part.xyz) for m, part in zip(masses, parts)) / sum(masses)
    inertia = np.zeros((3, 3))
    for m, part in zip(masses, parts):
        d = np.array(part.xyz) - com
        inertia += part_inertia(part) + m * (d @ d * np.eye(3) - np.outer(d, d))
    return sum(masses), com, inertia


def principal_axes(inertia: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the tensor in its principal axes (3, 3), and the smallest rpy [rad] of these axes."""
    if np.abs(inertia - np.diag(np.diag(inertia))).max() < 1e-9 * np.trace(inertia):
        return np.diag(np.diag(inertia)), np.zeros(3)
    _, axes = np.linalg.eigh(inertia)
    # Each principal axis replaces the nearest link axis: small angles.
    axes = axes[:, np.argmax(np.abs(axes), axis=1)]
    axes = axes * np.sign(np.diag(axes))
    return axes.T @ inertia @ axes, roll_pitch_yaw(axes)


def number(value: float) -> str:
    """Return a number with six significant digits, without noise like -0 or 1e-19."""
    return f'{0.0 if abs(value) < 1e-12 else value:.6g}'


def numbers(values) -> str:
    """Return the numbers of a vector, separated by blanks."""
    return ' '.join(number(value) for value in values)


def describe(part: Part) -> str:
    """Return the line of a part in the comment of its link."""
    density = f'{part.density:.0f} kg/m^3'
    if part.shape == 'box':
        return f'box {numbers(part.size)} m, {density}: {part_mass(part):.3f} kg'
    outer, inner, length = part.size
    kind = f'tube r {number(inner)}..{number(outer)}' if inner else f'cylinder r {number(outer)}'
    return f'{kind} length {number(length)} m, {density}: {part_mass(part):.3f} kg'


def add_inertial(element: ET.Element, parts: tuple[Part, ...]) -> None:
    """Add the <inertial> of a link, and a comment with its parts."""
    mass, com, inertia = link_inertial(parts)
    moments, rpy = principal_axes(inertia)
    element.append(ET.Comment('\n      '.join(['', *map(describe, parts)]) + '\n    '))
    inertial = ET.SubElement(element, 'inertial')
    ET.SubElement(inertial, 'origin', xyz=numbers(com), rpy=numbers(rpy))
    ET.SubElement(inertial, 'mass', value=number(mass))
    ET.SubElement(
        inertial,
        'inertia',
        {f'i{"xyz"[i]}{"xyz"[j]}': number(moments[i, j]) for i in range(3) for j in range(i, 3)},
    )


def add_visual(element: ET.Element, part: Part) -> None:
    """Add a part's shape as a <visual> primitive (a tube looks like a cylinder)."""
    visual = ET.SubElement(element, 'visual')
    ET.SubElement(visual, 'origin', xyz=numbers(part.xyz), rpy=numbers(part.rpy))
    geometry = ET.SubElement(visual, 'geometry')
    if part.shape == 'box':
        ET.SubElement(geometry, 'box', size=numbers(part.size))
    else:
        ET.SubElement(
            geometry, 'cylinder', radius=number(part.size[0]), length=number(part.size[2])
        )
    ET.SubElement(visual, 'material', name=part.color)


def add_joint(robot: ET.Element, joint: Joint) -> None:
    """Add a <joint>, with limits and damping where it moves."""
    element = ET.SubElement(robot, 'joint', name=joint.name, type=joint.kind)
    ET.SubElement(element, 'origin', xyz=numbers(joint.xyz), rpy='0 0 0')
    ET.SubElement(element, 'parent', link=joint.parent)
    ET.SubElement(element, 'child', link=joint.child)
    if joint.kind == 'fixed':
        return
    names = ('lower', 'upper', 'effort', 'velocity')
    ET.SubElement(element, 'axis', xyz=numbers(joint.axis))
    ET.SubElement(element, 'limit', dict(zip(names, map(number, joint.limits))))
    ET.SubElement(element, 'dynamics', damping=number(joint.damping), friction='0')
    if joint.mimic:
        ET.SubElement(element, 'mimic', joint=joint.mimic, multiplier='1', offset='0')


def arm7_urdf() -> str:
    """Return the text of arm7.urdf."""
    robot = ET.Element('robot', name='arm7')
    for name, rgba in COLORS.items():
        ET.SubElement(ET.SubElement(robot, 'material', name=name), 'color', rgba=rgba)
    for link in LINKS:
        element = ET.SubElement(robot, 'link', name=link.name)
        if link.parts:
            add_inertial(element, link.parts)
        for part in link.parts:
            add_visual(element, part)
    for joint in JOINTS:
        add_joint(robot, joint)
    ET.indent(robot)
    body = ET.tostring(robot, encoding='unicode')
    return f'<?xml version="1.0"?>\n<!--{HEADER}-->\n{body}\n'


def main(arguments: list[str]) -> int:
    """Write the file, or with --check compare it."""
    parser = argparse.ArgumentParser(description=__doc__.strip().splitlines()[0])
    parser.add_argument('--check', action='store_true', help='write nothing, compare')
    check = parser.parse_args(arguments).check
    if check and OUTPUT.read_text(encoding='utf-8') != arm7_urdf():
        print(f'{OUTPUT} differs from its generator; run python3 {sys.argv[0]}')
        return 1
    if not check:
        OUTPUT.write_text(arm7_urdf(), encoding='utf-8')
    return 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
