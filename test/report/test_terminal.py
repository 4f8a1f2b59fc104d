"""The report in a terminal."""

import io

from dynamics_node.report import make_report
from dynamics_node.report.terminal import print_report
import pytest
from rich.console import Console
from support.arms import arm, changed
from support.robots import ARM7, public_robot


def printed(report, width=80, color=False):
    """Return what is printed."""
    out = io.StringIO()
    print_report(
        report,
        Console(
            file=out,
            width=width,
            highlight=False,
            force_terminal=color,
            color_system='standard' if color else None,
        ),
    )
    return out.getvalue()


@pytest.fixture(scope='module')
def arm7():
    return make_report(ARM7, samples=200)


@pytest.mark.parametrize('width', [60, 80, 120])
def test_no_line_is_wider_than_the_terminal(arm7, width):
    lines = printed(arm7, width).splitlines()
    assert max(map(len, lines)) <= width


def test_at_80_columns_no_row_of_an_arm_is_broken(arm7):
    text = printed(arm7)
    for joint in arm7.joints:
        for table in ('Joints\n', 'Largest gravity'):
            if table != 'Joints\n' and joint.gravity is None:
                continue
            part = text.split(table, 1)[1]
            assert any(line.startswith(joint.name + ' ') for line in part.splitlines())
    assert 'mimic joints: right_finger_slide = 1 left_finger_slide' in text


def test_the_numbers_are_those_of_the_report(arm7):
    text = printed(arm7, 120)
    row = next(
        line
        for line in text.split('Largest gravity')[1].splitlines()
        if line.startswith('shoulder_pitch')
    )
    load = arm7.joints[1].gravity
    assert f'{load.worst:.3g}' in row and f'{100.0 * load.share:.0f} %' in row
    assert f'{load.payload_left:.3g}' in row
    assert f'{arm7.payload.everywhere:.3g} kg' in text


def test_findings_stand_last_with_the_worst_next_to_the_verdict():
    report = make_report(
        changed(changed(arm(), 'link2', mass=0.007), 'link3', tensor={'izz': 9.0}), samples=200
    )
    text = printed(report)
    assert text.index('Largest gravity') < text.index('Findings') < text.index('warning [grams]')
    assert text.index('warning [grams]') < text.index('problem [triangle')
    assert text.rstrip().endswith('arm: fix before use; 1 problem, 1 warning, 0 notes')


def test_color_only_where_they_are_wanted(arm7, monkeypatch):
    assert '\x1b[' in printed(arm7, color=True)
    assert '\x1b[' not in printed(arm7)
    monkeypatch.setenv('NO_COLOR', '1')
    out = io.StringIO()
    print_report(arm7, Console(file=out, force_terminal=True))
    assert '\x1b[3' not in out.getvalue()


def test_names_are_no_markup():
    text = printed(
        make_report(
            arm().replace('link3', '[bold red]x[/]').replace('joint3', '[link=http://a]j'),
            samples=20,
        ),
        120,
    )
    assert '[bold red]x[/]' in text and '[link=http://a]j' in text


@pytest.mark.parametrize(
    'text',
    [
        changed(arm(), 'link2', mass=-1.0),
        arm().replace('revolute', 'planar', 1),
        '<robot name="a"/>',
        '<robot name="a"><link name="b"/></robot>',
        arm(effort='inf'),
    ],
)
def test_every_robot_can_be_printed(text):
    report = make_report(text, samples=20)
    text = printed(report)
    assert ('refused' in text) == (report.verdict == 'refused')
    for finding in report.findings:
        assert f'[{finding.kind}]' in text


def test_a_gripper_that_weighs_nothing_is_shown():
    text = printed(make_report(public_robot('ur_description/urdf/ur5_gripper.urdf'), samples=50))
    row = next(line for line in text.splitlines() if line.startswith('tool0'))
    assert 'massless' in row


def test_a_guessed_payload_link_names_the_option_to_choose_another():
    assert '--payload-link LINK' in printed(make_report(arm(), samples=20), 120)
    assert '--payload-link' not in printed(make_report(arm(), samples=20, link='gripper'), 120)


def test_a_robot_without_masses_holds_nothing_that_is_known():
    text = arm()
    for link in ('link1', 'link2', 'link3', 'link4', 'link5', 'gripper'):
        text = changed(text, link, inertial=False)
    text = printed(make_report(text, samples=20), 120)
    assert 'It can hold' not in text and 'What it can hold is not known' in text
