"""The poses of the 3D view: those of the report, each with its numbers."""

from dynamics_node.report.formatting import number
from dynamics_node.report.html.poses import poses
import numpy as np
import pytest
from support.report_pages import arm7_report, unlimited_report


def test_there_is_a_pose_for_every_joint_and_gravity_asks_there_what_is_said():
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
