"""From a URDF to its report."""

import json

from dynamics_node import ArgumentError, RobotDescriptionError
from dynamics_node.report import make_report, to_json
from fuzz.descriptions import descriptions
from hypothesis import given, settings
import numpy as np
import pytest
from support.arms import arm
from support.robots import ARM7


def test_a_path_a_text_and_bytes_give_the_same(tmp_path):
    path = tmp_path / 'my arm.urdf'
    path.write_text(arm())
    reports = [
        make_report(source, samples=100) for source in (path, str(path), arm(), arm().encode())
    ]
    assert [report.source for report in reports] == [
        str(path),
        str(path),
        'URDF text',
        'URDF text',
    ]
    assert len({report.joints for report in reports}) == 1


def test_progress_grows_from_nothing_to_all():
    told = []
    make_report(arm(), samples=50, progress=lambda fraction, what: told.append((fraction, what)))
    fractions = [fraction for fraction, _ in told]
    assert fractions == sorted(fractions) and (fractions[0], fractions[-1]) == (0.0, 1.0)
    assert any('joint3' in what for _, what in told)


@pytest.mark.parametrize(
    'options, message',
    [
        ({'gravity': (0, 0)}, 'gravity: expected three'),
        ({'samples': 0}, 'samples: expected 1 to'),
        ({'seed': -1}, 'seed: expected'),
        ({'link': 'nobody'}, "link: 'nobody' is not"),
        ({'point': (0, 1)}, 'point: expected three'),
        ({'point': (0, 0, np.nan)}, 'point'),
    ],
)
def test_wrong_arguments_are_refused(options, message):
    with pytest.raises(ArgumentError, match=message):
        make_report(arm(), **options)


@pytest.mark.parametrize('text', ['', 'no such file', '<html/>', '<robot', b'\xff<robot/>'])
def test_what_is_no_urdf_is_refused(text):
    with pytest.raises(RobotDescriptionError):
        make_report(text)


def test_gravity_is_along_the_vector_that_is_given():
    down, up, none = (
        make_report(ARM7, samples=300, gravity=(0, 0, g)).joints[1].gravity
        for g in (-9.81, 9.81, 0.0)
    )
    assert up.magnitude == pytest.approx(down.magnitude, rel=1e-6)
    assert none.worst == 0.0


def test_one_sample_is_enough():
    found = make_report(arm(), samples=1)
    many = make_report(arm(), samples=4000)
    assert found.joints[1].gravity.magnitude == pytest.approx(
        many.joints[1].gravity.magnitude, rel=1e-6
    )


def test_the_names_of_a_robot_do_no_harm():
    report = make_report(arm(name='a\x85b&#10;c' + 'd' * 500), samples=10)
    assert len(report.robot) < 70 and report.robot.isprintable()


# Hypothesis warns when it would print a long description; the descriptions may be long.
@pytest.mark.filterwarnings('ignore:Generating overly large repr')
@settings(max_examples=100)
@given(descriptions())
def test_a_broken_description_gets_a_report_or_one_clear_error(texts):
    for text in texts:
        try:
            report = make_report(text, samples=8)
        except RobotDescriptionError:
            continue
        json.dumps(to_json(report), allow_nan=False)
        assert report.refusals or report.model is not None


def test_a_payload_says_whether_its_link_was_guessed():
    assert make_report(arm(), samples=20).payload.is_guessed
    assert not make_report(arm(), samples=20, link='gripper').payload.is_guessed


def test_what_is_readable_is_summed_up():
    report = make_report(arm().replace('<mass value="0.7"/>', '<mass value="x"/>'), samples=20)
    assert report.verdict == 'refused'
    # The base and the five links, without the gripper.
    assert report.total_mass == pytest.approx(4.0 + 3.0 + 2.5 + 2.0 + 1.2 + 0.8)
