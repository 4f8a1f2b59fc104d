"""Errors of wrong arguments: expected and given values."""

from dynamics_node import ArgumentError
from dynamics_node.dynamics.arguments import check_link, gravity_vector, per_joint
import numpy as np
import pytest


def test_an_unknown_link_is_refused_with_a_suggestion():
    check_link({'a': None}, 'a')
    with pytest.raises(
        ArgumentError, match=(r"^link: 'c' is not a link of the robot; expected one of a, b$")
    ):
        check_link({'a': None, 'b': None}, 'c')
    many = dict.fromkeys(f'link{i}' for i in range(1000))
    with pytest.raises(ArgumentError, match=r'link49, \.\.\.$') as caught:
        check_link(many, 'x' * 100_000)
    assert len(str(caught.value)) < 1000
    with pytest.raises(
        ArgumentError, match=(r"^frame: 'hnd' is not a link of the robot, is 'hand' meant\?$")
    ):
        check_link({'hand': None, 'forearm': None}, 'hnd', 'frame')


def test_gravity_is_three_finite_numbers():
    vector = gravity_vector([0, 0, -9.81])
    assert vector.tolist() == [0.0, 0.0, -9.81] and not vector.flags.writeable
    for wrong in ([0, 0], [0, 0, np.nan], 'down', [[0, 0, 1]]):
        with pytest.raises(ArgumentError, match='gravity: expected three finite numbers'):
            gravity_vector(wrong)


def test_one_number_per_joint_or_one_for_all():
    assert per_joint('gain', ('j', 'k'), 2).tolist() == [2.0, 2.0]
    assert per_joint('gain', ('j', 'k'), (1, 2)).tolist() == [1.0, 2.0]
    assert per_joint('gain', (), 2).shape == (0,)
    for wrong in ((1, 2, 3), -1.0, (1.0, np.nan), 'much', ((1, 2), (3,))):
        with pytest.raises(ArgumentError, match='gain: expected'):
            per_joint('gain', ('j', 'k'), wrong)
