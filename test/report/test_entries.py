"""The tables of links, bodies and joints."""

from dynamics_node import RobotModel
from dynamics_node.errors import RobotDescriptionError
from dynamics_node.report import make_report
import numpy as np
import pytest
from support.arms import arm, changed
from support.robots import ARM7, public_robot, random_urdf

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
        {'joint2': 'nobody'},
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
