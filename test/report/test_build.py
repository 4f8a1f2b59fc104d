"""From a URDF to its report, its tables and its JSON."""

import json

from dynamics_node import ArgumentError, RobotDescriptionError, RobotModel
from dynamics_node.report import make_report, to_json
from fuzz.descriptions import descriptions
from hypothesis import given, settings
import numpy as np
import pytest
from support.arms import arm, changed
from support.robots import ARM7, public_robot, random_urdf


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
    calls = []
    make_report(arm(), samples=50, progress=lambda fraction, what: calls.append((fraction, what)))
    fractions = [fraction for fraction, _ in calls]
    assert fractions == sorted(fractions) and (fractions[0], fractions[-1]) == (0.0, 1.0)
    assert any('joint3' in what for _, what in calls)


@pytest.mark.parametrize(
    'options, message',
    [
        ({'gravity': (0, 0)}, 'gravity: expected three'),
        ({'samples': 0}, 'samples: expected 1 to'),
        ({'seed': -1}, 'seed: expected'),
        ({'link': 'unknown'}, "link: 'unknown' is not"),
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


def test_long_and_unprintable_names_are_shortened_and_escaped():
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


def test_it_is_strict_json_and_comes_again():
    texts = [
        json.dumps(to_json(make_report(ARM7, samples=200)), allow_nan=False) for _ in range(2)
    ]
    assert texts[0] == texts[1]
    plain = json.loads(texts[0])
    assert plain['format'] == 1 and 'model' not in plain
    assert [joint['name'] for joint in plain['joints']][:2] == ['shoulder_yaw', 'shoulder_pitch']
    # Infinite: gravity never loads it, and no mass does.
    assert plain['joints'][0]['gravity']['payload_left'] is None
    assert plain['joints'][1]['gravity']['magnitude'] > 0.0
    assert plain['links'][0]['is_physical'] is True
    assert plain['counts'] == {'problem': 0, 'warning': 0, 'note': 0} and plain['is_clean']


def test_numbers_are_not_rounded():
    report = make_report(ARM7, samples=100)
    plain = to_json(report)
    assert plain['joints'][1]['gravity']['worst'] == report.joints[1].gravity.worst
    assert plain['payload']['everywhere'] == report.payload.everywhere


@pytest.mark.parametrize(
    'text',
    [
        changed(arm(), 'link2', mass=-1.0),
        arm().replace('revolute', 'planar', 1),
        arm(effort='inf'),
        '<robot name="a"><link name="b"/></robot>',
    ],
)
def test_what_is_missing_is_null(text):
    json.dumps(to_json(make_report(text, samples=50)), allow_nan=False)


KINOVA = 'kinova_description/robots/kinova.urdf'


@pytest.fixture(scope='module')
def report():
    return make_report(ARM7, samples=50)


def test_links_are_as_the_urdf_has_them(report):
    hand = {link.name: link for link in report.links}['hand']
    text = ARM7.read_text().split('<link name="hand">')[1]
    assert f'value="{hand.mass:g}"' in text.split('/>')[1] + text.split('/>')[2] or (
        hand.mass == pytest.approx(float(text.split('<mass value="')[1].split('"')[0]))
    )
    assert hand.carrier == 'wrist_roll' and hand.has_inertial and hand.is_physical
    base = report.links[0]
    assert base.carrier is None and base.name == report.root
    assert not {link.name: link for link in report.links}['tool_center'].has_inertial


def test_shapes_are_a_yes_or_no():
    by_name = {
        link.name: link
        for link in make_report(changed(arm(), 'link2', shape=False), samples=20).links
    }
    assert by_name['link1'].has_shape and not by_name['link2'].has_shape


def test_bodies_are_those_of_the_model(report):
    tree = report.model.tree
    assert [body.joint for body in report.bodies] == list(tree.moving_joint_names)
    for body, inertia in zip(report.bodies, tree.inertia, strict=True):
        assert body.mass == pytest.approx(inertia[3, 3])
        np.testing.assert_allclose(np.multiply(body.mass, body.com), inertia[:3, 3], atol=1e-12)
    last = {body.joint: body for body in report.bodies}['wrist_roll']
    assert last.link == 'wrist_disc' and last.parent == 'wrist_pitch'
    assert set(last.lumped) == {'flange', 'hand', 'tool_center'}


@pytest.mark.parametrize('seed', range(4))
def test_masses_of_links_bodies_and_the_robot_agree(seed):
    found = make_report(random_urdf(seed), samples=20)
    model = RobotModel.from_urdf(random_urdf(seed))
    assert found.moving_mass == pytest.approx(model.moving_mass)
    assert sum(body.mass for body in found.bodies) == pytest.approx(found.moving_mass)
    assert found.total_mass == pytest.approx(model.moving_mass + model.tree.base_inertia[3, 3])
    for link in found.links:
        body = model.tree.links[link.name].body
        assert link.carrier == (model.tree.moving_joint_names[body] if body >= 0 else None)


def test_joints_have_the_limits_of_the_urdf(report):
    by_name = {joint.name: joint for joint in report.joints}
    pitch, slave = by_name['elbow_pitch'], by_name['right_finger_slide']
    assert (pitch.lower, pitch.upper, pitch.effort, pitch.velocity) == (-2.4, 2.4, 90.0, 2.2)
    assert (pitch.unit, pitch.effort_unit, slave.unit, slave.effort_unit) == (
        'rad',
        'N m',
        'm',
        'N',
    )
    assert slave.mimics == 'left_finger_slide' and slave.gravity is None
    assert pitch.mimics is None and pitch.gravity is not None
    assert pitch.damping == 4.0


def test_mimic_joints_of_a_public_arm_follow_theirs():
    report = make_report(public_robot(KINOVA), samples=20)
    assert set(report.joint_names) == {
        joint.name for joint in report.joints if joint.mimics is None
    }


@pytest.mark.parametrize(
    'leaders',
    [
        {'joint2': 'joint2'},
        {'joint2': 'joint3', 'joint3': 'joint2'},
        {'joint1': 'joint2', 'joint2': 'joint3', 'joint3': 'joint2'},
        {'joint2': 'unknown'},
    ],
)
def test_joints_that_mimic_each_other_in_a_circle_are_refused_and_shown(leaders):
    text = arm()
    for name, leader in leaders.items():
        text = text.replace(
            f'name="{name}" type="revolute">',
            f'name="{name}" type="revolute"><mimic joint="{leader}" multiplier="3" offset="0.5"/>',
        )
    with pytest.raises(RobotDescriptionError):
        RobotModel.from_urdf(text)
    report = make_report(text, samples=20)
    assert report.verdict == 'refused'
    by_name = {joint.name: joint for joint in report.joints}
    for name, leader in leaders.items():
        written = None if leader == name else leader
        assert (by_name[name].mimics, by_name[name].multiplier, by_name[name].offset) == (
            written,
            3.0,
            0.5,
        )
