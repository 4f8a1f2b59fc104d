"""Numbers and names of a URDF, and their limits."""

import time

from dynamics_node import RobotDescriptionError
from dynamics_node.urdf import read_urdf
from dynamics_node.urdf.validation import is_number
import numpy as np
import pytest
import yourdfpy  # noqa: F401  (its import is not part of the measured times)

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
        # A million characters in one attribute.
        DIGITS + 'x',
        '.' + DIGITS + 'x',
        '1.' * 500_000,
        '1e' + DIGITS + 'x',
        ' ' * 1_000_000 + 'x',
        '+' * 1_000_000,
    ],
    ids=['digits', 'fraction', 'points', 'exponent', 'blanks', 'signs'],
)
def test_a_long_text_is_matched_in_linear_time(text):
    start = time.process_time()
    assert not is_number(text)
    assert time.process_time() - start < 1.0


@pytest.mark.parametrize('blank', ['\u3000', '\xa0', '\u2028', '\x85'])
def test_only_white_space_of_xml_may_surround_a_number(blank):
    for number in (f'{blank}1', f'1{blank}'):
        assert not is_number(number)
        for values in ({'mass': number}, {'inertia': number}, {'place': f'0 0 {number}'}):
            with pytest.raises(RobotDescriptionError, match=r'expected .*finite number'):
                read(**values)
    assert read(mass=' \t\n1\r', place=' 0\t0\n0 ').links[1].inertial.mass == 1.0


@pytest.mark.parametrize('digit', ['\u0661', '\uff11', '\u00b9', '\U0001d7cf'])
def test_only_ascii_digits_are_digits(digit):
    assert not is_number(digit)
    with pytest.raises(RobotDescriptionError, match='expected a finite number'):
        read(mass=digit)


def test_numbers_above_1e30_are_refused():
    with pytest.raises(RobotDescriptionError) as caught:
        read(place='0 0 -1e31', mass='1e300', inertia='2e30')
    assert caught.value.problems == (
        "link 'b': <origin> xyz: expected at most 1e+30, got '0 0 -1e31'",
        "link 'b': <mass> value: expected at most 1e+30, got '1e300'",
        "link 'b': <inertia> ixx: expected at most 1e+30, got '2e30'",
    )


def test_a_position_limit_above_1e30_is_no_limit():
    # The largest float, as simulators write a missing limit.
    joint = read(lower='-1.79769e+308', upper='1.79769e+308').joints[0]
    assert (joint.lower, joint.upper) == (-np.inf, np.inf)
    joint = read(lower='1e300', upper='1.79769e+308').joints[0]
    assert (joint.lower, joint.upper) == (-np.inf, np.inf)
    joint = read(lower='-1e16', upper='2').joints[0]
    assert (joint.lower, joint.upper) == (-1e16, 2.0)


def chain(count, kind='fixed'):
    """Return a chain of joints of one type."""
    return (
        '<robot name="r"><link name="l0"/>'
        + ''.join(
            f'<link name="l{i}"/><joint name="j{i}" type="{kind}"><parent link="l{i - 1}"/>'
            f'<child link="l{i}"/><axis xyz="0 0 1"/></joint>'
            for i in range(1, count)
        )
        + '</robot>'
    )


INERTIAL = (
    '<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
    '</inertial>'
)


@pytest.mark.parametrize(
    'link, joint, problem',
    [
        ('<inertial/>' + INERTIAL, '', "link 'b' has 2 <inertial>, expected one"),
        (INERTIAL + INERTIAL, '', "link 'b' has 2 <inertial>, expected one"),
        (
            INERTIAL.replace('<mass', '<mass/><mass'),
            '',
            "link 'b': <inertial> has 2 <mass>, expected one",
        ),
        ('', '<origin/><limit/><limit/><limit/>', "joint 'j' has 3 <limit>, expected one"),
        ('', '<parent link="b"/>', "joint 'j' has 2 <parent>, expected one"),
    ],
)
def test_repeated_elements_are_refused(link, joint, problem):
    with pytest.raises(RobotDescriptionError) as caught:
        read_urdf(
            f'<robot name="r"><link name="a"/><link name="b">{link}</link><joint name="j" '
            f'type="fixed"><parent link="a"/><child link="b"/>{joint}</joint></robot>'
        )
    assert problem in caught.value.problems


@pytest.mark.parametrize(
    'written, quoted',
    [
        ('a&#10;[FATAL] all is lost', r"'a\n[FATAL] all is lost'"),
        ('\u202eedoc', r"'\u202eedoc'"),
        ('\ufeffa', r"'\ufeffa'"),
    ],
)
def test_an_unprintable_name_is_refused(written, quoted):
    for kind, more in (('link', ''), ('joint', 'type="revolute"')):
        with pytest.raises(RobotDescriptionError) as caught:
            read_urdf(f'<robot name="r"><{kind} name="{written}" {more}/></robot>')
        assert caught.value.problems[0] == (
            f'{kind} {quoted}: its name has characters that cannot be printed'
        )
        assert all(problem.isprintable() for problem in caught.value.problems)


def test_names_in_any_language_are_accepted():
    name = 'größe 肘 \u0661'
    assert read_urdf(f'<robot name="r"><link name="{name}"/></robot>').root == name


def test_a_long_name_is_refused_and_shortened():
    assert read_urdf(f'<robot name="r"><link name="{"x" * 255}"/></robot>').links
    with pytest.raises(RobotDescriptionError) as caught:
        read_urdf(f'<robot name="r"><link name="{"x" * 1_000_000}"/></robot>')
    [problem] = caught.value.problems
    assert problem == (
        f"link '{'x' * 57}...': its name has 1000000 characters, at most 255 are accepted"
    )


def test_the_longest_chains_are_read_in_time():
    # 0.7 s on a slow machine, mostly proportional to the length.
    for kind in ('fixed', 'prismatic'):
        start = time.process_time()
        assert len(read_urdf(chain(1000, kind)).joints) == 999
        assert time.process_time() - start < 3.0
