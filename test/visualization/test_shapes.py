"""Frames around joint axes."""

from dynamics_node.visualization.shapes import frame_around
import numpy as np
import pytest


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
