"""Which points and joints are over their limits."""

from dynamics_node import ArgumentError
from dynamics_node.dynamics import over_limit
import numpy as np
import pytest

NAN = float('nan')


def test_points_and_joints_over_their_limits_are_named():
    efforts = [[1.0, -5.0, 0.0], [2.0, 4.0, 9.0], [-3.0, 1.0, 0.0]]
    over = over_limit(efforts, [2.5, 4.5, NAN])
    assert over.points.tolist() == [0, 2]
    assert over.joints.tolist() == [0, 1]
    assert over.peak_effort.tolist() == [3.0, 5.0, 9.0]


def test_an_effort_at_its_limit_is_within_it_and_the_next_number_is_not():
    assert over_limit([[2.0], [-2.0]], [2.0]).points.tolist() == []
    assert over_limit([[2.0], [np.nextafter(-2.0, -3.0)]], [2.0]).points.tolist() == [1]


def test_joints_without_a_limit_are_never_over_it():
    over = over_limit([[1e300, 1.0]], [NAN, 2.0])
    assert over.points.tolist() == over.joints.tolist() == []


def test_what_is_not_a_number_is_not_within_a_limit():
    assert over_limit([[NAN]], [1.0]).points.tolist() == [0]


@pytest.mark.parametrize(
    ('efforts', 'limits', 'text'),
    [
        ([1.0], [1.0], r'efforts: expected shape \(N, n\) with at least one point, got \(1,\)'),
        (np.zeros((0, 1)), [1.0], r'at least one point, got \(0, 1\)'),
        ([[1.0]], [1.0, 2.0], r'effort limits: expected shape \(1,\), one per joint, got \(2,\)'),
        (
            [[1.0, 1.0]],
            [1.0, -2.0],
            'effort limits: joint 1: expected at least 0, or NaN for none, got -2.0',
        ),
    ],
)
def test_wrong_input_is_answered_with_what_was_expected_and_what_came(efforts, limits, text):
    with pytest.raises(ArgumentError, match=text):
        over_limit(efforts, limits)
