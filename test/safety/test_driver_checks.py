"""Drivers that compensate gravity themselves, and efforts that are no torques."""

import math
from pathlib import Path

from dynamics_node.safety import EffortPlausibility, self_compensating
from dynamics_node.safety.driver_checks import SELF_COMPENSATING
from dynamics_node.urdf import read_urdf
import numpy as np
import pytest

NAMES = ('shoulder', 'elbow', 'wrist')
LIMITS = (90.0, 40.0, 10.0)
G = np.array([-40.0, 15.0, 0.5])  # N m


def rest(check, effort, torque=G, seconds=2.5, start=0.0, velocity=0.001):
    """Let the arm rest for a time; return whether the rest was judged."""
    judged = [
        check.update(time, np.full(len(torque), velocity), np.array(effort), torque)
        for time in start + np.arange(0.0, seconds, 0.1)
    ]
    return any(judged)


@pytest.fixture
def check():
    return EffortPlausibility(NAMES, LIMITS)


@pytest.mark.parametrize(
    'effort',
    [G, 1.4 * G, 0.7 * G, G + [15.0, 5.0, 5.0]],
    ids=['torque', 'payload', 'lighter', 'contact'],
)
def test_plausible_efforts_give_no_warning(check, effort):
    assert rest(check, effort)
    assert check.warning == ''


@pytest.mark.parametrize(
    'effort',
    [0.0 * G, -G, 0.08 * G, 1000.0 * G, [0.1, -0.2, 0.0]],
    ids=['zeros', 'other sign', 'current', 'thousandths', 'without gravity'],
)
def test_implausible_efforts_give_a_warning_with_both_numbers(check, effort):
    assert rest(check, effort)
    assert check.warning == (
        f'shoulder reports {effort[0] + 0.0:.4g} at rest, where the model says that -40 holds it'
    )


def test_the_warning_disappears_with_plausible_efforts(check):
    rest(check, 0.0 * G)
    assert check.warning
    assert rest(check, G, start=3.0)
    assert check.warning == ''


def test_there_is_no_judgment_before_the_arm_has_rested(check):
    assert not rest(check, 0.0 * G, seconds=1.9)
    assert not check.update(2.0, np.array([0.0, 0.0, 0.1]), 0.0 * G, G)  # it moves
    assert not rest(check, 0.0 * G, start=2.1, seconds=1.9)
    assert check.warning == ''


def test_forget_begins_a_new_rest_and_keeps_the_warning(check):
    rest(check, 0.0 * G)
    check.forget()
    rest(check, G, start=3.0, seconds=1.9)
    check.forget()
    assert not rest(check, G, start=5.0, seconds=1.9)
    assert check.warning


@pytest.mark.parametrize(
    'torque, limits',
    [([2.6, 1.1, 0.29], LIMITS), ([0.09, 0.0, 0.0], [math.nan] * 3)],
    ids=['of their limits', 'without limits'],
)
def test_joints_with_little_gravity_torque_are_not_judged(torque, limits):
    check = EffortPlausibility(NAMES, limits)
    assert not rest(check, np.zeros(3), np.array(torque))
    assert check.warning == ''
    assert rest(check, np.zeros(3), 1.2 * np.array(torque), start=3.0)
    assert check.warning


def test_the_joint_nearest_to_its_limit_is_named(check):
    rest(check, [-40.0, 0.0, 0.0], np.array([-40.0, 30.0, 0.5]))
    assert check.warning.startswith('elbow reports 0 at rest')


def test_noise_is_averaged(check):
    rng = np.random.default_rng(0)
    judged = [check.update(0.002 * i, np.zeros(3), rng.normal(G, 30.0), G) for i in range(1200)]
    assert any(judged)
    assert check.warning == ''


URDF = (
    '<robot name="arm"><link name="base"/><ros2_control name="a" type="system"><hardware>'
    '<plugin> {} </plugin></hardware></ros2_control></robot>'
)


@pytest.mark.parametrize(
    'plugin, arm',
    [
        ('ur_robot_driver/URPositionHardwareInterface', 'a Universal Robots arm'),
        ('franka_hardware/FrankaHardwareInterface', 'a Franka arm'),
        ('lbr_ros2_control::SystemInterface', 'a KUKA LBR iiwa'),
    ],
)
def test_a_self_compensating_arm_is_known_by_its_plugin(plugin, arm):
    plugins = read_urdf(URDF.format(plugin)).hardware_plugins
    assert plugins == (plugin,)
    assert self_compensating(plugins) == [f'{plugin} ({arm})']


def test_other_plugins_are_accepted():
    assert self_compensating(('mock_components/GenericSystem', 'my_ur_robot_driver/Arm')) == []
    assert read_urdf('<robot name="arm"><link name="base"/></robot>').hardware_plugins == ()
    assert read_urdf(URDF.format('')).hardware_plugins == ()


def test_the_documents_list_every_self_compensating_plugin():
    text = (Path(__file__).parents[2] / 'docs' / 'arms.md').read_text(encoding='utf-8')
    assert all(f'`{package}`' in text for package in SELF_COMPENSATING)
