"""Physical consistency of pseudo-inertia matrices: violations and their messages."""

from dynamics_node import ArgumentError, InertiaError
from dynamics_node.inertia import (
    check_physical,
    consistency_report,
    pseudo_inertia,
    transform_pseudo_inertia,
)
from dynamics_node.inertia.pseudo_inertia import rotation_from_rpy
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest


@given(
    st.lists(
        st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(-1, 1), st.floats(1e-3, 5)),
        min_size=1,
        max_size=6,
    )
)
def test_point_masses_are_always_physical(points):
    matrix = sum(m * np.outer([x, y, z, 1], [x, y, z, 1]) for x, y, z, m in points)
    assert consistency_report(matrix).violations == ()


def test_negative_mass_is_named():
    report = consistency_report(pseudo_inertia(-1.0, [0, 0, 0], np.eye(3)))
    assert any('mass is -1 kg, must be >= 0' in text for text in report.violations)


def test_the_triangle_inequality_is_named_with_its_numbers():
    report = consistency_report(pseudo_inertia(1.0, [0, 0, 0], np.diag([3.0, 1.0, 1.0])))
    assert 'violate the triangle inequality: 3 > 1 + 1 kg m^2' in report.violations[0]
    assert 'smallest eigenvalue of J is -0.5, must be >= 0' in report.violations[1]
    assert report.smallest_eigenvalue == pytest.approx(-0.5)


def test_a_tensor_that_is_not_positive_is_named():
    report = consistency_report(pseudo_inertia(1.0, [0, 0, 0], np.diag([-0.1, 1.0, 1.0])))
    assert 'smallest principal moment of inertia is -0.1 kg m^2' in report.violations[0]


def test_asymmetry_and_nan_are_named():
    matrix = pseudo_inertia(1.0, [0, 0, 0], np.eye(3))
    matrix[0, 1] += 0.25
    assert (
        'not symmetric: J and its transpose differ by 0.25'
        in (consistency_report(matrix).violations[0])
    )
    matrix[0, 0] = np.nan
    report = consistency_report(matrix)
    assert report.violations == ('J has entries that are not finite',)
    assert np.isnan(report.smallest_eigenvalue)


@given(st.integers(0, 2**32 - 1))
def test_the_result_does_not_depend_on_the_frame(seed):
    rng = np.random.default_rng(seed)
    transform = np.eye(4)
    transform[:3, :3] = rotation_from_rpy(rng.uniform(-3, 3, 3))
    transform[:3, 3] = rng.normal(size=3)
    good = pseudo_inertia(1.0, rng.normal(size=3), np.diag([2.0, 2.0, 1.0]))
    bad = pseudo_inertia(1.0, rng.normal(size=3), np.diag([3.0, 1.0, 1.0]))
    assert consistency_report(transform_pseudo_inertia(good, transform)).is_physical
    assert not consistency_report(transform_pseudo_inertia(bad, transform)).is_physical


def test_checking_raises_with_every_violation():
    with pytest.raises(InertiaError, match='triangle') as caught:
        check_physical(pseudo_inertia(-1.0, [0, 0, 0], np.diag([3.0, 1.0, 1.0])))
    assert len(caught.value.violations) == 3
    check_physical(np.eye(4))


def test_a_wrong_shape_is_an_error():
    with pytest.raises(ArgumentError, match=r'expected shape \(4, 4\), got \(3, 3\)'):
        consistency_report(np.eye(3))
