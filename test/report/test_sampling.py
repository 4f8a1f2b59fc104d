"""Positions to look at."""

import math

from dynamics_node.report.workspace_analysis import (
    sample_positions,
    sampling_ranges,
    WorkspaceAnalysis,
)
from dynamics_node.urdf import read_urdf
import numpy as np
from support.arms import arm, changed


def ranges(text):
    """Return ranges and notes of a robot."""
    return sampling_ranges(
        WorkspaceAnalysis.from_description(read_urdf(text), (0, 0, -9.81), 1, 1).model
    )


def test_limits_are_the_range():
    found, notes = ranges(arm(limits=(-1.5, 2.0)))
    np.testing.assert_array_equal(found, [[-1.5, 2.0]] * 5)
    assert notes == ('',) * 5


def test_what_has_no_limit_turns_once_or_stands():
    text = changed(arm(), 'joint1', kind='continuous')
    text = changed(text, 'joint5', kind='prismatic', limit={'lower': None, 'upper': None})
    text = changed(text, 'joint2', limit={'upper': '1e31'})
    found, notes = ranges(text)
    np.testing.assert_allclose(found[0], [-math.pi, math.pi])
    np.testing.assert_allclose(found[1], [-2.5, -2.5 + math.tau])
    np.testing.assert_array_equal(found[4], [0.0, 0.0])
    assert notes[0] and notes[1] and notes[4] and not notes[2]


def test_positions_are_uniform_within_the_range_and_come_again_with_the_seed():
    given = np.array([[-1.0, 3.0], [0.0, 0.0]])
    q = sample_positions(given, 20_000, 3)
    assert (q[:, 0] >= -1.0).all() and (q[:, 0] < 3.0).all() and not q[:, 1].any()
    counts = np.histogram(q[:, 0], 10)[0]
    assert abs(counts - 2000).max() < 250
    np.testing.assert_array_equal(q, sample_positions(given, 20_000, 3))
    assert (q[:, 0] != sample_positions(given, 20_000, 4)[:, 0]).all()
