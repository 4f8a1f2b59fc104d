"""Names and trees: what messages about them look like, and how long large ones take."""

import time

from dynamics_node import RobotDescriptionError
from dynamics_node.urdf import read_urdf
import pytest


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
def test_what_is_said_twice_is_refused(link, joint, problem):
    with pytest.raises(RobotDescriptionError) as caught:
        read_urdf(
            f'<robot name="r"><link name="a"/><link name="b">{link}</link><joint name="j" '
            f'type="fixed"><parent link="a"/><child link="b"/>{joint}</joint></robot>'
        )
    assert problem in caught.value.problems


@pytest.mark.parametrize(
    'written, shown',
    [
        ('a&#10;[FATAL] all is lost', r"'a\n[FATAL] all is lost'"),
        ('\u202eedoc', r"'\u202eedoc'"),
        ('\ufeffa', r"'\ufeffa'"),
    ],
)
def test_a_name_that_cannot_be_printed_is_refused(written, shown):
    for kind, more in (('link', ''), ('joint', 'type="revolute"')):
        with pytest.raises(RobotDescriptionError) as caught:
            read_urdf(f'<robot name="r"><{kind} name="{written}" {more}/></robot>')
        assert caught.value.problems[0] == (
            f'{kind} {shown}: its name has characters that cannot be printed'
        )
        assert all(problem.isprintable() for problem in caught.value.problems)


def test_names_of_all_languages_are_names():
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


def test_the_largest_chains_are_read_within_a_second_or_so():
    # 0.7 s on a slow machine, most of it in proportion to the length.
    for kind in ('fixed', 'prismatic'):
        start = time.process_time()
        assert len(read_urdf(chain(1000, kind)).joints) == 999
        assert time.process_time() - start < 3.0
