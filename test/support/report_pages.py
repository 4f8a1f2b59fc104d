"""Reports for the tests of the page, each made once."""

from functools import cache

from dynamics_node.report import make_report

from .hostile_robot import hostile_urdf
from .robots import ARM7, PENDULUM

SAMPLES = 300  # enough for what the page shows; the numbers have tests of their own

REFUSED = """<robot name="refused">
  <link name="base"/>
  <link name="upper"><inertial><mass value="2"/>
    <inertia ixx="0.1" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="fore"><inertial><mass value="-1"/>
    <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="10" velocity="1"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="fore"/>
    <origin xyz="0 0 0.4"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" effort="5" velocity="1"/></joint>
</robot>"""

BLOCK = """<robot name="block"><link name="block"><inertial><mass value="2"/>
  <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>"""


@cache
def arm7_report():
    """Return the report of the arm of this repository."""
    return make_report(ARM7, samples=SAMPLES)


@cache
def weak_report():
    """Return the report of the same arm with motors too weak to hold it."""
    return make_report(ARM7.read_text().replace('effort="90"', 'effort="15"'), samples=SAMPLES)


@cache
def unlimited_report():
    """Return the report of the same arm without effort limits."""
    text = ARM7.read_text()
    for limit in ('90', '30', '12', '40'):
        text = text.replace(f'effort="{limit}"', 'effort="0"')
    return make_report(text, samples=SAMPLES)


@cache
def pendulum_report():
    """Return the report of a pendulum."""
    return make_report(PENDULUM, samples=SAMPLES)


@cache
def refused_report():
    """Return the report of a physically impossible robot."""
    return make_report(REFUSED, samples=SAMPLES)


@cache
def block_report():
    """Return the report of a robot without joints."""
    return make_report(BLOCK, samples=SAMPLES)


@cache
def hostile_report():
    """Return the report of a robot with hostile names."""
    return make_report(hostile_urdf()[0], samples=SAMPLES)


def loaded_joints(report):
    """Return the independent joints in the order of every position."""
    by_name = {joint.name: joint for joint in report.joints}
    return [by_name[name] for name in report.joint_names]
