"""Slopes of the spline: polynomials, scipy's own, and points whose slopes are known."""

from dynamics_node import ArgumentError, RobotModel
from dynamics_node.dynamics import complete_trajectory
from dynamics_node.dynamics.trajectory import spline_slopes
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from support.mujoco_oracle import MujocoOracle
from support.pinocchio_oracle import PinocchioOracle
from support.robots import ARM7, random_urdf


def points(seed, count, columns=3):
    """Return times in uneven steps and values, and slopes to be given."""
    rng = np.random.default_rng(seed)
    time = rng.normal() + np.cumsum(rng.uniform(0.05, 1.0, count))
    return time, rng.normal(size=(count, columns)), rng.normal(size=(count, columns))


def ours(time, values, slopes, *given):
    """Return the slopes where some are given."""
    mask = np.zeros(len(time), dtype=bool)
    mask[list(given)] = True
    result = np.where(mask[:, None], slopes, np.nan)
    spline_slopes(time, values, mask, result)
    return result


def scipys(time, values, begin=None, end=None):
    """Return the slopes of scipy's spline; an end without a slope is not a knot."""
    ends = ['not-a-knot' if slope is None else (1, slope) for slope in (begin, end)]
    return CubicSpline(time, values, bc_type=tuple(ends))(time, 1)


@pytest.mark.parametrize('count', [2, 3, 4, 5, 6, 50])
def test_without_derivatives_it_is_the_not_a_knot_spline(count):
    time, values, slopes = points(count, count)
    np.testing.assert_allclose(
        ours(time, values, slopes), scipys(time, values), rtol=1e-9, atol=1e-9
    )


@pytest.mark.parametrize('count', [2, 3, 4, 5, 6, 50])
def test_slopes_at_both_ends_clamp_it(count):
    time, values, slopes = points(count, count)
    np.testing.assert_allclose(
        ours(time, values, slopes, 0, count - 1),
        scipys(time, values, slopes[0], slopes[-1]),
        rtol=1e-9,
        atol=1e-9,
    )


@pytest.mark.parametrize('count', [4, 5, 6, 50])
def test_a_slope_at_one_end_clamps_that_end(count):
    time, values, slopes = points(count, count)
    np.testing.assert_allclose(
        ours(time, values, slopes, 0), scipys(time, values, begin=slopes[0]), rtol=1e-9, atol=1e-9
    )
    np.testing.assert_allclose(
        ours(time, values, slopes, count - 1),
        scipys(time, values, end=slopes[-1]),
        rtol=1e-9,
        atol=1e-9,
    )


def test_a_slope_in_the_middle_separates_two_independent_splines():
    time, values, slopes = points(1, 20)
    actual = ours(time, values, slopes, 0, 7, 19)
    left = scipys(time[:8], values[:8], slopes[0], slopes[7])
    right = scipys(time[7:], values[7:], slopes[7], slopes[19])
    np.testing.assert_allclose(actual, np.concatenate((left, right[1:])), rtol=1e-9, atol=1e-9)


def test_given_slopes_are_kept_bit_for_bit():
    time, values, slopes = points(2, 9)
    given = (0, 3, 4, 8)
    np.testing.assert_array_equal(
        ours(time, values, slopes, *given)[list(given)], slopes[list(given)]
    )
    np.testing.assert_array_equal(ours(time, values, slopes, *range(9)), slopes)


@pytest.mark.parametrize(
    ('count', 'given', 'degree'),
    [
        (2, (), 1),
        (2, (0,), 2),
        (2, (1,), 2),
        (2, (0, 1), 3),
        (3, (), 2),
        (3, (0,), 3),
        (3, (2,), 3),
        (3, (1,), 2),
        (4, (), 3),
        (5, (1,), 2),
        (5, (2,), 3),
        (5, (0, 4), 3),
    ],
)
def test_polynomials_are_reproduced_up_to_the_degree_of_the_data(count, given, degree):
    time, _, _ = points(count, count)
    polynomial = np.polynomial.Polynomial(np.arange(1.0, degree + 2.0))
    values, slopes = polynomial(time)[:, None], polynomial.deriv()(time)[:, None]
    np.testing.assert_allclose(ours(time, values, slopes, *given), slopes, rtol=1e-10)
    # And not beyond: the next power is not reproduced, or the data fix more than was said.
    if (count, given) != (2, (0, 1)) and degree < 3:
        cube = time[:, None] ** (degree + 1)
        slope = (degree + 1) * time[:, None] ** degree
        assert np.abs(ours(time, cube, slope, *given) - slope).max() > 1e-3


def test_steps_of_very_different_lengths_keep_their_digits():
    # A cubic is its own spline, wherever the points are.
    time = np.cumsum([0.0, 1e-3, 1.0, 1e-4, 1e-4, 2.0, 1e-3, 1e-3])
    values, slopes = time[:, None] ** 3, 3.0 * time[:, None] ** 2
    np.testing.assert_allclose(ours(time, values, slopes), slopes, rtol=1e-8, atol=1e-8)


def test_a_robot_without_joints_has_an_empty_estimate():
    assert ours(np.arange(4.0), np.zeros((4, 0)), np.zeros((4, 0))).shape == (4, 0)


RATES = np.array([1.0, 1.7, 0.4])
POSITIONS = 'cubic spline through the positions'
VELOCITIES = 'cubic spline through the velocities'


def sines(time):
    """Return positions, velocities and accelerations of three joints that swing."""
    angle = np.outer(time, RATES) + [0.3, 1.0, 2.0]
    return np.sin(angle), RATES * np.cos(angle), -(RATES**2) * np.sin(angle)


def without(values, *points):
    """Return a copy with some rows missing."""
    values = values.copy()
    values[list(points)] = np.nan
    return values


def only(values, *points):
    """Return a copy with all but some rows missing."""
    result = np.full_like(values, np.nan)
    result[list(points)] = values[list(points)]
    return result


def test_given_derivatives_are_kept_bit_for_bit_without_a_message():
    # With all derivatives given, times need not increase.
    time = np.array([0.0, 0.0, 0.0])
    motion = complete_trajectory(time, *sines(np.arange(3.0)))
    for actual, expected in zip(
        (motion.positions, motion.velocities, motion.accelerations),
        sines(np.arange(3.0)),
        strict=True,
    ):
        np.testing.assert_array_equal(actual, expected)
    assert motion.obtained == ''


def test_positions_alone_give_a_spline_with_free_ends():
    time = np.cumsum(np.random.default_rng(1).uniform(0.1, 1.0, 30))
    q, _, _ = sines(time)
    motion = complete_trajectory(time, q)
    spline = CubicSpline(time, q)
    np.testing.assert_allclose(motion.velocities, spline(time, 1), rtol=0, atol=1e-10)
    np.testing.assert_allclose(motion.accelerations, spline(time, 2), rtol=0, atol=1e-10)
    assert motion.obtained == (
        f'velocities were not given: the slopes of a {POSITIONS}; accelerations were not '
        f'given: the second derivatives of a {POSITIONS}'
    )


@pytest.mark.parametrize('ends', [(0,), (9,), (0, 9)])
def test_velocities_at_the_ends_are_the_ends_of_the_spline(ends):
    time = np.cumsum(np.random.default_rng(2).uniform(0.1, 1.0, 10))
    q, qd, _ = sines(time)
    motion = complete_trajectory(time, q, only(qd, *ends))
    begin, end = ((1, qd[i]) if i in ends else 'not-a-knot' for i in (0, 9))
    spline = CubicSpline(time, q, bc_type=(begin, end))
    np.testing.assert_allclose(motion.velocities, spline(time, 1), rtol=0, atol=1e-10)
    np.testing.assert_allclose(motion.accelerations, spline(time, 2), rtol=0, atol=1e-9)
    assert motion.obtained.startswith(f'velocities of {10 - len(ends)} of 10 points were not')


def test_accelerations_from_velocities_ignore_positions():
    # Rounded as in a file: the second derivatives of positions would be off by 40 rad/s².
    time = np.linspace(0.0, 1.0, 1001)
    q, qd, qdd = sines(time)
    motion = complete_trajectory(time, q.round(5), qd.round(5))
    assert np.abs(motion.accelerations - qdd).max() < 0.05
    assert np.abs(complete_trajectory(time, q.round(5)).accelerations - qdd).max() > 10.0
    np.testing.assert_allclose(
        motion.accelerations, CubicSpline(time, qd.round(5))(time, 1), rtol=0, atol=1e-9
    )
    assert motion.obtained == f'accelerations were not given: the slopes of a {VELOCITIES}'


def test_missing_derivatives_between_points_are_filled():
    time = np.linspace(0.0, 2.0, 41)
    q, qd, qdd = sines(time)
    motion = complete_trajectory(time, q, without(qd, 3, 4, 20), without(qdd, 0, 7, 40))
    kept = np.delete(np.arange(41), (3, 4, 20))
    np.testing.assert_array_equal(motion.velocities[kept], qd[kept])
    np.testing.assert_allclose(motion.velocities, qd, rtol=0, atol=1e-5)
    kept = np.delete(np.arange(41), (0, 7, 40))
    np.testing.assert_array_equal(motion.accelerations[kept], qdd[kept])
    # At the ends, beside a point that has one, the velocity is a parabola: h²/6 of its third
    # derivative is missing there.
    np.testing.assert_allclose(motion.accelerations[7], qdd[7], rtol=0, atol=1e-5)
    np.testing.assert_allclose(
        motion.accelerations, qdd, rtol=0, atol=0.05**2 / 6.0 * RATES.max() ** 4
    )
    assert motion.obtained == (
        f'velocities of 3 of 41 points were not given: the slopes of a {POSITIONS}; '
        f'accelerations of 3 of 41 points were not given: the slopes of a {VELOCITIES}'
    )


def orders(which):
    """Return how the largest error in the middle shrinks when the step is halved, as a power."""
    errors = []
    for count in (41, 81, 161):
        time = np.linspace(0.0, 4.0, count)
        q, qd, qdd = sines(time)
        motion = complete_trajectory(time, *((q, qd) if which == 'of velocities' else (q,)))
        actual, expected = (
            (motion.velocities, qd) if which == 'velocities' else (motion.accelerations, qdd)
        )
        middle = slice(count // 4, -(count // 4))
        errors.append(np.abs(actual - expected)[middle].max())
    return np.log2(np.array(errors[:-1]) / errors[1:])


@pytest.mark.parametrize(
    ('which', 'order'), [('velocities', 4), ('accelerations', 2), ('of velocities', 4)]
)
def test_errors_shrink_with_the_order_of_the_spline(which, order):
    np.testing.assert_allclose(orders(which), order, atol=0.15)


def test_one_point_is_at_rest():
    motion = complete_trajectory([2.0], [[0.1, 0.2]])
    assert motion.velocities.tolist() == motion.accelerations.tolist() == [[0.0, 0.0]]
    assert motion.obtained.count('zero, the only point is at rest') == 2
    moving = complete_trajectory([2.0], [[0.1, 0.2]], [[3.0, 4.0]])
    assert moving.velocities.tolist() == [[3.0, 4.0]]
    assert moving.obtained.startswith('accelerations were not given: zero')


def test_two_points_are_a_line_a_parabola_or_a_cubic():
    time, q = [1.0, 3.0], [[0.0], [4.0]]
    line = complete_trajectory(time, q)
    assert line.velocities.tolist() == [[2.0], [2.0]]
    assert line.accelerations.tolist() == [[0.0], [0.0]]
    parabola = complete_trajectory(time, q, [[0.0], [np.nan]])  # t²
    np.testing.assert_allclose(parabola.velocities, [[0.0], [4.0]])
    np.testing.assert_allclose(parabola.accelerations, [[2.0], [2.0]])
    rest_to_rest = complete_trajectory(time, q, [[0.0], [0.0]])  # 3 t² - t³
    np.testing.assert_allclose(rest_to_rest.accelerations, [[6.0], [-6.0]])


def test_three_points_are_a_parabola_and_clamped_ends_a_spline():
    time = np.array([0.0, 1.0, 3.0])
    parabola = complete_trajectory(time, (time**2)[:, None])
    np.testing.assert_allclose(parabola.velocities[:, 0], 2.0 * time, atol=1e-12)
    np.testing.assert_allclose(parabola.accelerations, 2.0)
    clamped = complete_trajectory(time, [[0.0], [1.0], [0.0]], [[0.0], [np.nan], [0.0]])
    spline = CubicSpline(time, [0.0, 1.0, 0.0], bc_type='clamped')
    np.testing.assert_allclose(clamped.velocities[:, 0], spline(time, 1), atol=1e-12)
    np.testing.assert_allclose(clamped.accelerations[:, 0], spline(time, 2), atol=1e-12)


def test_arrays_of_the_caller_are_not_kept():
    time, q, qd = np.arange(4.0), np.ones((4, 1)), np.full((4, 1), np.nan)
    motion = complete_trajectory(time, q, qd)
    assert np.isnan(qd).all() and q.flags.writeable and time.flags.writeable
    assert not any(
        array.flags.writeable
        for array in (motion.time, motion.positions, motion.velocities, motion.accelerations)
    )


@given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 12), joints=st.integers(0, 3))
def test_any_pattern_of_gaps_reproduces_a_parabola(seed, count, joints):
    # A parabola is its own spline for any missing values: but its data must fix it, so three
    # points, or some velocity.
    rng = np.random.default_rng(seed)
    time = rng.normal() + np.cumsum(rng.uniform(0.1, 1.0, count))
    a, b, c = rng.normal(size=(3, joints))
    q, qd, qdd = (
        a + np.outer(time, b) + np.outer(time**2, c),
        b + np.outer(time, 2.0 * c),
        np.outer(np.ones(count), 2.0 * c),
    )
    velocities = np.where(rng.random((count, 1)) < 0.5, np.nan, qd)
    accelerations = np.where(rng.random((count, 1)) < 0.5, np.nan, qdd)
    motion = complete_trajectory(time, q, velocities, accelerations)
    if count >= 3 or (count == 2 and not np.isnan(velocities).all()):
        np.testing.assert_allclose(motion.velocities, qd, rtol=1e-7, atol=1e-7)
        np.testing.assert_allclose(motion.accelerations, qdd, rtol=1e-6, atol=1e-6)
    assert np.isfinite(motion.velocities).all() and np.isfinite(motion.accelerations).all()
    for name, values in (('velocities', velocities), ('accelerations', accelerations)):
        missing = np.isnan(values).all(axis=1).any()
        assert (name in motion.obtained.replace(VELOCITIES, '')) == missing


# Efforts ------------------------------------------------------------------------------------


@pytest.mark.parametrize('make', [PinocchioOracle, MujocoOracle])
@pytest.mark.parametrize(
    'text',
    [ARM7.read_text(), random_urdf(4), random_urdf(5)],
    ids=['arm7', 'tree', 'tree with mimic'],
)
def test_efforts_are_those_of_the_judges_along_the_motion(text, make):
    model, oracle = RobotModel.from_urdf(text), make(text)
    n = len(model.joint_names)
    time = np.linspace(0.0, 3.0, 25)
    q = 0.4 * np.sin(np.outer(time, np.linspace(0.5, 1.5, n)))
    spline = CubicSpline(time, q)  # the judges' own derivatives
    expected = np.array(
        [
            oracle.inverse_dynamics(model.joint_names, q[i], spline(t, 1), spline(t, 2))
            for i, t in enumerate(time)
        ]
    )
    actual = model.trajectory_effort(time, q)
    assert np.abs(actual - expected).max() <= 1e-9 * np.abs(expected).max()
    # And not just gravity: the motion counts.
    assert np.abs(actual - model.gravity_torque(q)).max() > 1e-3 * np.abs(expected).max()


def test_efforts_of_known_derivatives_are_inverse_dynamics():
    model = RobotModel.from_urdf(ARM7)
    q, qd, qdd = np.random.default_rng(3).normal(0.0, 0.3, (3, 50, 8))
    np.testing.assert_array_equal(
        model.trajectory_effort(np.arange(50.0), q, qd, qdd), model.inverse_dynamics(q, qd, qdd)
    )


def test_a_swinging_pendulum_needs_the_closed_form_torque():
    model = RobotModel.from_urdf(ARM7.with_name('pendulum.urdf'))
    M, length, radius, g = 3.0, 0.7, 0.05, 9.81
    time = np.linspace(0.0, 2.0, 201)
    q, qdd = np.sin(3.0 * time), -9.0 * np.sin(3.0 * time)
    expected = (M * length**2 / 3.0 + M * radius**2 / 4.0) * qdd + M * g * length / 2.0 * np.cos(q)
    actual = model.trajectory_effort(time, q[:, None], 3.0 * np.cos(3.0 * time)[:, None])[:, 0]
    assert np.abs(actual - expected).max() < 1e-4  # of 14 N m: the spline's error at the ends


# What is refused ----------------------------------------------------------------------------

NAN, INF = float('nan'), float('inf')


@pytest.mark.parametrize(
    ('arguments', 'text'),
    [
        (
            ([], np.zeros((0, 2))),
            r'time: expected shape \(N,\) with at least one point, got \(0,\)',
        ),
        ((0.0, [[1.0]]), r'time: expected shape \(N,\) with at least one point, got \(\)'),
        (([0, 1], [[1.0]]), r'positions: expected shape \(2, n\), one row per time, got \(1, 1\)'),
        (
            ([0, 1], [1.0, 2.0]),
            r'positions: expected shape \(2, n\), one row per time, got \(2,\)',
        ),
        (
            ([0, 1], [[1.0], [1.0, 2.0]]),
            'positions: expected numbers, the same number for each point',
        ),
        (([0, 1], [['a'], ['b']]), 'positions: expected numbers'),
        (([0, NAN], [[1.0], [2.0]]), 'time: point 1: expected a finite number, got nan'),
        (
            ([0, 1], [[1.0, 2.0], [2.0, INF]]),
            'positions: point 1, joint 1: expected a finite number, got inf',
        ),
        (([0, 1, 2], [[1.0], [2.0], [NAN]]), 'positions: point 2, joint 0: .* got nan'),
        (
            ([0, 1], [[1.0], [2.0]], [[1.0]]),
            r'velocities: expected the shape of positions, \(2, 1\), got \(1, 1\)',
        ),
        (
            ([0, 1], [[1.0, 2.0]] * 2, [[1.0, 2.0], [NAN, 1.0]]),
            'velocities: point 1, joint 0: expected a finite number, or NaN for all joints of a '
            'point where they are missing, got nan',
        ),
        (
            ([0, 1], [[1.0]] * 2, None, [[INF], [1.0]]),
            'accelerations: point 0, joint 0: .* got inf',
        ),
        (
            ([0, 1, 1, 2], [[1.0]] * 4),
            r'time: point 2: expected more than 1.0 s, the time of the point before, got 1.0 s; '
            'or give the velocities and accelerations of all points',
        ),
        (([0, 1, 0.5], [[1.0]] * 3, [[1.0]] * 3), 'time: point 2: expected more than 1.0 s'),
        (
            ([0, 1e-320, 1], [[1.0], [2.0], [3.0]]),
            'time: point 0: expected steps long enough for finite velocities and accelerations',
        ),
    ],
)
def test_wrong_input_is_refused_with_expected_and_given_values(arguments, text):
    with pytest.raises(ArgumentError, match=text):
        complete_trajectory(*arguments)


def test_a_trajectory_of_other_joints_is_refused():
    with pytest.raises(ArgumentError, match=r'positions: expected shape \(N, 8\)'):
        RobotModel.from_urdf(ARM7).trajectory_effort([0.0, 1.0], np.zeros((2, 7)))
