"""The plots and the 3D view: legal for plotly, with the numbers of the report."""

from dataclasses import replace
import json
import math

from dynamics_node import RobotModel
from dynamics_node.report.formatting import number
from dynamics_node.report.html.figures import page_data
from dynamics_node.report.html.joint_plots import curve_figure, histogram_figure
from dynamics_node.report.html.plots import (
    distribution_figure,
    mass_figure,
    rows,
    short_name,
    tone,
    worst_figure,
)
from dynamics_node.report.html.scene import BALL_DENSITY, ball_radius, ellipsoid, poses, scene
import numpy as np
import plotly.graph_objects as go
import pytest
from support.report_pages import (
    arm7_report,
    block_report,
    loaded_joints,
    pendulum_report,
    refused_report,
    unlimited_report,
    weak_report,
)
from support.robots import ARM7, random_urdf

REPORTS = {
    'arm7': arm7_report,
    'weak': weak_report,
    'unlimited': unlimited_report,
    'pendulum': pendulum_report,
}


def colored(value):
    """Return a figure with a color in the place of every name of one."""
    if isinstance(value, dict):
        return (
            '#123456'
            if set(value) == {'css'}
            else {key: colored(part) for key, part in value.items()}
        )
    return [colored(part) for part in value] if isinstance(value, list) else value


def all_figures(figures):
    yield from (figures[name] for name in ('worst', 'distribution', 'mass'))
    yield from figures['joint']['curves']
    yield from figures['joint']['histograms']


@pytest.mark.parametrize('report', REPORTS.values(), ids=REPORTS)
def test_plotly_accepts_every_figure(report):
    for figure in all_figures(page_data(report())['figures']):
        # Raises at the first property that plotly does not know.
        go.Figure(data=colored(figure['data']), layout=colored(figure['layout']))
        for mode in figure.get('modes', ()):
            go.Layout(colored(mode['layout']))
            assert len(mode['visible']) == len(figure['data'])


@pytest.mark.parametrize('report', [refused_report, block_report])
def test_without_torques_nothing_is_drawn(report):
    assert page_data(report()) is None


def test_the_joint_that_is_shown_first_is_nearest_to_its_limit():
    report = weak_report()
    first = page_data(report)['figures']['joint']['first']
    assert first == int(np.argmax([joint.gravity.share for joint in loaded_joints(report)]))


def test_without_limits_the_joint_with_the_largest_torque_comes_first():
    first = page_data(unlimited_report())['figures']['joint']['first']
    assert first == int(
        np.argmax([joint.gravity.magnitude for joint in loaded_joints(unlimited_report())])
    )


def test_the_bars_are_the_worst_torques_and_their_shares():
    report = arm7_report()
    share, torque, limits = worst_figure(loaded_joints(report))['data']
    joints = loaded_joints(report)
    assert torque['x'] == [abs(joint.gravity.worst) for joint in joints]
    assert share['x'] == [100.0 * joint.gravity.share for joint in joints]
    assert limits['x'] == [joint.effort for joint in joints]


def test_a_joint_over_its_limit_has_another_color():
    report = weak_report()
    share = worst_figure(loaded_joints(report))['data'][0]
    over = [joint.gravity.share > 1.0 for joint in loaded_joints(report)]
    assert any(over) and not all(over)
    assert [color == {'css': 'problem'} for color in share['marker']['color']] == over
    assert [tone(value) for value in (0.5, 0.9, 1.1, math.nan)] == [
        'accent',
        'warning',
        'problem',
        'faint',
    ]


@pytest.mark.parametrize('figure', [worst_figure, distribution_figure])
def test_without_limits_only_torques_are_shown(figure):
    figure = figure(loaded_joints(unlimited_report()))
    assert [mode['label'] for mode in figure['modes']] == ['torque']
    assert [trace['visible'] for trace in figure['data']] == figure['modes'][0]['visible']


def test_a_limit_far_beyond_the_torques_does_not_make_them_invisible():
    joints = [replace(joint, effort=1e4) for joint in loaded_joints(arm7_report())]
    torque = worst_figure(joints)['modes'][1]['layout']['xaxis']
    assert torque['range'][1] < 2.0 * max(joint.gravity.magnitude for joint in joints)


def test_the_boxes_are_quantiles_of_the_report():
    report = arm7_report()
    shares, torques, _, _ = distribution_figure(loaded_joints(report))['data']
    for place, joint in enumerate(loaded_joints(report)):
        known = dict(zip(joint.gravity.levels, joint.gravity.quantiles, strict=True))
        for key, level in (
            ('lowerfence', 0.05),
            ('q1', 0.25),
            ('median', 0.5),
            ('q3', 0.75),
            ('upperfence', 0.95),
        ):
            assert torques[key][place] == known[level]
            assert shares[key][place] == pytest.approx(100.0 * known[level] / joint.effort)


def test_curve_and_histogram_belong_to_their_joint():
    report = arm7_report()
    for place, joint in enumerate(loaded_joints(report)):
        curve, worst = curve_figure(joint, joint.gravity.position[place])['data']
        assert curve['y'] == list(joint.gravity.curve_torques)
        scale = 1.0 if joint.kind == 'prismatic' else 180.0 / math.pi
        np.testing.assert_allclose(curve['x'], scale * np.array(joint.gravity.curve_positions))
        assert worst['y'] == [joint.gravity.worst]
        assert worst['x'] == [scale * joint.gravity.position[place]]
        bars = histogram_figure(joint)['data'][0]
        np.testing.assert_allclose(
            bars['y'], 100.0 * np.array(joint.gravity.counts) / sum(joint.gravity.counts)
        )


def test_a_limit_is_drawn_where_it_is_near_and_not_where_it_would_flatten_the_curve():
    joint = next(joint for joint in loaded_joints(arm7_report()) if joint.gravity.share > 0.3)
    assert len(curve_figure(joint, 0.0)['layout']['shapes']) == 2
    assert not curve_figure(replace(joint, effort=1e4), 0.0)['layout']['shapes']
    weak = replace(joint, effort=0.5 * joint.gravity.magnitude)
    line = histogram_figure(weak)['layout']['shapes'][0]
    assert line['x0'] == line['x1'] == weak.effort


def test_masses_are_those_of_the_bodies():
    report = arm7_report()
    bars = mass_figure(report.bodies)['data'][0]
    assert bars['x'] == [body.mass for body in report.bodies]
    assert sum(bars['x']) == pytest.approx(report.moving_mass)


def test_a_long_name_loses_its_middle():
    assert short_name('shoulder_pan_joint') == 'shoulder_pan_joint'
    cut = short_name('a' * 50 + 'b' * 50)
    assert len(cut) <= 26 and cut.startswith('aaa') and cut.endswith('bbb') and '…' in cut


def test_names_that_look_like_numbers_and_dates_stay_names():
    axis = rows(['1', '2026-01-01', '1'])
    assert axis['type'] == 'linear' and axis['tickvals'] == [0, 1, 2]
    assert axis['ticktext'] == ['1', '2026-01-01', '1']


@pytest.mark.parametrize('seed', range(5))
def test_the_ellipsoid_has_the_second_moments_of_the_body(seed):
    for J in RobotModel.from_urdf(random_urdf(seed)).tree.inertia:
        mass = J[3, 3]
        axes, com = ellipsoid(J), J[:3, 3] / mass
        # Of a solid ellipsoid: m a aᵀ / 5, summed over its semi-axes.
        found = mass / 5.0 * axes @ axes.T + mass * np.outer(com, com)
        np.testing.assert_allclose(found, J[:3, :3], rtol=1e-9, atol=1e-12 * np.trace(J))


def test_the_ellipsoid_of_a_known_solid_is_itself():
    J = np.diag([5.0 * 0.1**2 / 5.0, 5.0 * 0.2**2 / 5.0, 5.0 * 0.3**2 / 5.0, 5.0])
    np.testing.assert_allclose(np.abs(ellipsoid(J)), np.diag([0.1, 0.2, 0.3]), atol=1e-12)


def test_the_ellipsoid_of_a_wrong_tensor_does_not_hide_the_robot():
    text = ARM7.read_text().replace('<mass value="1.40208" />', '<mass value="1.4e-6" />')
    model = RobotModel.from_urdf(text)
    sticks = scene(model)['sticks']
    shapes = [np.array(columns) for columns in scene(model)['ellipsoid']]
    longest = [np.linalg.norm(columns, axis=0).max() for columns in shapes]
    uncapped = [np.linalg.norm(ellipsoid(J), axis=0).max() for J in model.tree.inertia]
    assert sticks and max(uncapped) > 10.0 and max(longest) < 2.0
    for own, whole, J in zip(longest, uncapped, model.tree.inertia, strict=True):
        assert own == pytest.approx(whole) or (own < whole and J[3, 3] < 0.1)


def test_without_mass_there_is_no_shape():
    assert not ellipsoid(np.zeros((4, 4))).any() and ball_radius(0.0) == 0.0


def test_a_ball_weighs_what_its_body_weighs():
    volume = 4.0 / 3.0 * np.pi * ball_radius(2.5) ** 3
    assert volume * BALL_DENSITY == pytest.approx(2.5)


def test_the_scene_is_plain_data_of_the_model():
    model = RobotModel.from_urdf(ARM7)
    data = json.loads(json.dumps(scene(model), allow_nan=False))
    assert data['joints'] == list(model.joint_names)
    assert sum(data['mass']) == pytest.approx(model.moving_mass)
    assert len(data['body']) == len(model.tree.moving_joint_names) == len(data['placement'])
    assert data['prismatic'] == [name.endswith('slide') for name in model.joint_names]
    assert data['limit'] == model.effort_limits.tolist()
    assert np.all(np.array(data['lower']) <= data['neutral'])
    assert np.all(np.array(data['upper']) >= data['neutral'])


def test_a_slider_has_ends_where_the_joint_has_none():
    text = ARM7.read_text()
    model = RobotModel.from_urdf(text.replace('upper="2.1"', 'upper="1e16"'))
    assert (model.position_limits == 1e16).any()
    data = scene(model)
    limits, neutral = model.position_limits, model.neutral_position
    for place, (lower, upper) in enumerate(zip(data['lower'], data['upper'], strict=True)):
        assert lower == limits[place, 0]
        far = limits[place, 1] == 1e16
        assert upper == (neutral[place] + np.pi if far else limits[place, 1])


def test_a_stick_goes_to_every_body_and_from_the_base_to_the_first():
    model = RobotModel.from_urdf(ARM7)
    sticks = scene(model)['sticks']
    assert {body for _, (body, _) in sticks} == set(range(len(model.tree.moving_joint_names)))
    assert [body for (body, _), _ in sticks].count(-1) == 1


def test_a_stick_goes_on_to_the_farthest_link_of_the_last_body():
    text = (
        '<robot name="r"><link name="base"/><link name="rod"/><link name="near"/>'
        '<link name="tool"/><joint name="j" type="continuous"><parent link="base"/>'
        '<child link="rod"/><axis xyz="0 1 0"/></joint>'
        '<joint name="a" type="fixed"><parent link="rod"/><child link="near"/>'
        '<origin xyz="0 0 0.1"/></joint>'
        '<joint name="b" type="fixed"><parent link="near"/><child link="tool"/>'
        '<origin xyz="0 0 0.3"/></joint></robot>'
    )
    sticks = scene(RobotModel.from_urdf(text))['sticks']
    assert sticks[-1] == [[0, [0.0, 0.0, 0.0]], [0, [0.0, 0.0, 0.4]]]


def test_every_joint_has_a_pose_with_the_stated_gravity_torque():
    report = arm7_report()
    found = {pose['joint']: pose for pose in poses(report) if pose['joint'] is not None}
    loads = {joint.name: joint.gravity for joint in report.joints}
    assert sorted(found) == list(range(len(report.joint_names)))
    for place, name in enumerate(report.joint_names):
        torque = report.model.gravity_torque(found[place]['q'])[place]
        assert torque == pytest.approx(loads[name].worst, abs=1e-9)
        words = found[place]['caption'].replace('\u00a0', ' ')
        assert name in words and number(loads[name].worst) in words


def test_the_least_payload_stands_where_the_report_found_it():
    report = arm7_report()
    least = next(pose for pose in poses(report) if pose['label'] == 'least payload')
    held = report.model.max_payload(np.array(least['q']), report.payload.link)
    assert float(held.mass) == pytest.approx(report.payload.everywhere, rel=1e-6)


def test_without_limits_no_payload_is_shown():
    labels = [pose['label'] for pose in poses(unlimited_report()) if pose['joint'] is None]
    assert labels == ['neutral', 'worst conditioning']
