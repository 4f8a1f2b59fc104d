"""One robot under the lens."""

from dynamics_node import RobotModel
from dynamics_node.report.study import Study
from dynamics_node.urdf import read_urdf
import numpy as np
import pytest
from support.arms import arm, changed
from support.robots import random_urdf


@pytest.fixture(scope='module')
def study():
    return Study.begin(read_urdf(arm()), (0.0, 0.0, -9.81), 300, 1)


def test_torques_are_those_of_the_library(study):
    expected = RobotModel.from_urdf(arm()).gravity_torque(study.positions)
    np.testing.assert_allclose(study.torques, expected, atol=1e-12)


def test_starts_are_the_samples_where_a_torque_is_largest_and_smallest(study):
    starts, sign = study.starts(1)
    torques = study.model.gravity_torque(starts)[:, 1]
    order = np.sort(study.torques[:, 1])
    np.testing.assert_allclose(np.sort(torques[sign < 0])[:8], order[:8])
    np.testing.assert_allclose(np.sort(torques[sign > 0])[-8:], order[-8:])
    # And others from all over, so that not all are below the same top.
    assert (sign < 0).sum() > 60 and (sign > 0).sum() > 60


def test_joints_that_do_not_matter_stand_at_neutral(study):
    # Joint 1 turns about the vertical and joint 5 about the arm itself.
    position, torque = study.worst[1]
    assert position[0] == position[4] == 0.0
    assert study.model.gravity_torque(position)[1] == pytest.approx(torque, rel=1e-11)
    assert study.worst[0][1] == 0.0 and not study.worst[0][0].any()


def test_another_inertial_is_that_of_another_urdf(study):
    inertial = read_urdf(changed(arm(), 'link3', mass=5.0)).links[3].inertial
    model = study.with_inertials({'link3': inertial})
    expected = RobotModel.from_urdf(changed(arm(), 'link3', mass=5.0))
    np.testing.assert_allclose(
        model.gravity_torque(study.positions), expected.gravity_torque(study.positions), atol=1e-12
    )
    assert study.worst_with(model, 1)[1] != pytest.approx(study.worst[1][1], rel=1e-3)
    np.testing.assert_allclose(
        study.with_inertials({}).gravity_torque(study.positions), study.torques, atol=1e-12
    )


def test_the_joints_that_carry_a_link(study):
    assert study.joints_under('gripper') == [4, 3, 2, 1, 0]
    assert study.joints_under('base') == []


def test_batches_cover_the_samples_once(study):
    for numbers in (1, 7_000, 10**9):
        rows = np.concatenate([np.arange(300)[part] for part in study.batches(numbers)])
        np.testing.assert_array_equal(rows, np.arange(300))
    assert [part.stop for part in study.batches(1, 40)] == [40]


def test_no_compiler_is_started(monkeypatch):
    from dynamics_node.codegen import worker

    def refuse(*_):
        raise AssertionError('a compiler was started')

    monkeypatch.setattr(worker, 'start', refuse)
    study = Study.begin(read_urdf(random_urdf(77, joints=5)), (0.0, 0.0, -9.81), 50_000, 1)
    for _ in range(5):
        study.model.gravity_torque(study.positions)
        study.model.with_payload(study.model.tip_link, 1.0).mass_matrix(study.positions)
