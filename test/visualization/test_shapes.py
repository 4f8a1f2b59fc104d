"""Quaternions and frames, against MuJoCo's."""

from dynamics_node.visualization.shapes import frame_around, quaternions
import mujoco
import numpy as np
import pytest


def matrix(quaternion):
    """Return the rotation of a quaternion x, y, z, w, by MuJoCo."""
    found = np.zeros(9)
    x, y, z, w = quaternion
    mujoco.mju_quat2Mat(found, np.array([w, x, y, z]))
    return found.reshape(3, 3)


def rotations():
    rng = np.random.default_rng(3)
    some = [np.eye(3), np.diag([1.0, -1, -1]), np.diag([-1.0, 1, -1]), np.diag([-1.0, -1, 1])]
    for _ in range(50):
        Q = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        some.append(Q * np.linalg.det(Q))
    return np.array(some)


def test_quaternions_turn_as_the_matrices_do():
    found = quaternions(rotations())
    assert np.linalg.norm(found, axis=1) == pytest.approx(1.0, abs=1e-15)
    for quaternion, R in zip(found, rotations(), strict=True):
        assert matrix(quaternion) == pytest.approx(R, abs=1e-14)


def test_none_gives_none():
    assert quaternions(np.zeros((0, 3, 3))).shape == (0, 4)


@pytest.mark.parametrize(
    'axis', [*np.eye(3), *-np.eye(3), [0.6, 0.0, -0.8], [1e-9, 0, 1.0], [3**-0.5] * 3]
)
def test_a_frame_is_around_its_axis(axis):
    R = frame_around(np.array(axis) / np.linalg.norm(axis))
    assert R[:, 2] == pytest.approx(axis)
    np.testing.assert_allclose(R.T @ R, np.eye(3), atol=1e-15)
    assert np.linalg.det(R) == pytest.approx(1.0)


def test_rounding_of_the_axis_does_not_turn_the_frame():
    nearly = np.array([6e-17, -1.2e-16, 1.0])
    assert frame_around(nearly) == pytest.approx(frame_around(np.array([0, 0, 1.0])), abs=1e-15)
