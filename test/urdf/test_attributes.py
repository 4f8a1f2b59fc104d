"""What is a number in a URDF, and what is not."""

import time

from dynamics_node import RobotDescriptionError
from dynamics_node.urdf import read_urdf
from dynamics_node.urdf.attributes import is_number
import numpy as np
import pytest

ROBOT = (
    '<robot name="r"><link name="a"/><link name="b"><inertial><origin xyz="{place}"/>'
    '<mass value="{mass}"/><inertia ixx="{inertia}" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
    '</inertial></link><joint name="j" type="revolute"><parent link="a"/><child link="b"/>'
    '<axis xyz="0 0 1"/><limit lower="{lower}" upper="{upper}"/></joint></robot>'
)


def read(place='0 0 0', mass='1', inertia='1', lower='-1', upper='1'):
    """Return a robot of two links, some of its numbers replaced."""
    return read_urdf(
        ROBOT.format(place=place, mass=mass, inertia=inertia, lower=lower, upper=upper)
    )


DIGITS = '1' * 1_000_000


@pytest.mark.parametrize(
    'text',
    [
        # A million characters in one attribute: each looked at a few times, not a million times.
        DIGITS + 'x',
        '.' + DIGITS + 'x',
        '1.' * 500_000,
        '1e' + DIGITS + 'x',
        ' ' * 1_000_000 + 'x',
        '+' * 1_000_000,
    ],
    ids=['digits', 'fraction', 'points', 'exponent', 'blanks', 'signs'],
)
def test_a_long_text_is_judged_at_once(text):
    start = time.process_time()
    assert not is_number(text)
    assert time.process_time() - start < 1.0


@pytest.mark.parametrize('blank', ['\u3000', '\xa0', '\u2028', '\x85'])
def test_only_blanks_of_xml_may_stand_around_a_number(blank):
    for number in (f'{blank}1', f'1{blank}'):
        assert not is_number(number)
        for given in ({'mass': number}, {'inertia': number}, {'place': f'0 0 {number}'}):
            with pytest.raises(RobotDescriptionError, match=r'expected .*finite number'):
                read(**given)
    assert read(mass=' \t\n1\r', place=' 0\t0\n0 ').links[1].inertial.mass == 1.0


@pytest.mark.parametrize('digit', ['\u0661', '\uff11', '\u00b9', '\U0001d7cf'])
def test_only_ascii_digits_make_a_number(digit):
    assert not is_number(digit)
    with pytest.raises(RobotDescriptionError, match='expected a finite number'):
        read(mass=digit)


def test_numbers_larger_than_any_robot_has_are_refused():
    with pytest.raises(RobotDescriptionError) as caught:
        read(place='0 0 -1e31', mass='1e300', inertia='2e30')
    assert caught.value.problems == (
        "link 'b': <origin> xyz: expected at most 1e+30, got '0 0 -1e31'",
        "link 'b': <mass> value: expected at most 1e+30, got '1e300'",
        "link 'b': <inertia> ixx: expected at most 1e+30, got '2e30'",
    )


def test_a_position_limit_larger_than_any_robot_has_is_none():
    # The largest number there is, as simulators write what is unlimited.
    joint = read(lower='-1.79769e+308', upper='1.79769e+308').joints[0]
    assert (joint.lower, joint.upper) == (-np.inf, np.inf)
    joint = read(lower='1e300', upper='1.79769e+308').joints[0]
    assert (joint.lower, joint.upper) == (-np.inf, np.inf)
    joint = read(lower='-1e16', upper='2').joints[0]
    assert (joint.lower, joint.upper) == (-1e16, 2.0)
