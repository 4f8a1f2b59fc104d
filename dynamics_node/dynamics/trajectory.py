"""Trajectories of points; missing velocities and accelerations by a spline."""

from dataclasses import dataclass
import itertools
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import ArgumentError


@dataclass(frozen=True)
class Trajectory:
    """
    N points of a motion of n joints, complete.

    Attributes
    ----------
    time : numpy.ndarray, shape (N,)
        s.
    positions, velocities, accelerations : numpy.ndarray, shape (N, n)
        rad or m, per s, per s².
    obtained : str
        Message on the source of missing derivatives; empty if all were given.

    """

    time: NDArray[np.float64]
    positions: NDArray[np.float64]
    velocities: NDArray[np.float64]
    accelerations: NDArray[np.float64]
    obtained: str


def complete_trajectory(
    time: ArrayLike,
    positions: ArrayLike,
    velocities: ArrayLike | None = None,
    accelerations: ArrayLike | None = None,
) -> Trajectory:
    """
    Complete a trajectory by its missing velocities and accelerations.

    Given values are kept. A point without velocities (or accelerations) is a row of NaN.

    - Missing velocities are the slopes of the cubic spline through the positions with the given
      velocities. An end without a velocity is free: the two outermost pieces are one cubic there.
    - Missing accelerations are the second derivatives of that spline, if no velocity is given
      between the first and the last point. Otherwise they are the slopes of the cubic spline
      through the velocities with the given accelerations: two derivatives of rounded positions
      would be mostly rounding.
    - One point: missing values are zero, the robot is at rest. Two points: a line, or with
      velocities a parabola or cubic. Three points: a parabola, or with velocities at the ends a
      cubic spline.

    Positions are not wrapped at a full turn: a step from 3.1 to -3.1 rad is a turn backwards.

    Parameters
    ----------
    time : array_like, shape (N,)
        s; strictly increasing if velocities or accelerations are missing.
    positions : array_like, shape (N, n)
        rad or m.
    velocities, accelerations : array_like, shape (N, n), optional
        rad/s or m/s, rad/s² or m/s².

    Returns
    -------
    Trajectory

    Raises
    ------
    ArgumentError
        If there is no point, shapes do not fit, a number is not finite (points and joints are
        counted from 0), or times do not increase where a spline is needed or are so close that
        derivatives overflow.

    References
    ----------
    docs/mathematics.md, equations (30) and (31).

    """
    t, q = _points(time, positions)
    qd, has_velocity = _derivatives('velocities', velocities, q.shape)
    qdd, has_acceleration = _derivatives('accelerations', accelerations, q.shape)
    obtained = ''
    if not (has_velocity.all() and has_acceleration.all()):
        if len(t) > 1:
            _require_increasing(t)
        with np.errstate(all='ignore'):  # overflow is reported below
            obtained = _fill(t, q, qd, has_velocity, qdd, has_acceleration)
        _require_finite(qd, qdd)
    for array in (t, q, qd, qdd):
        array.flags.writeable = False
    return Trajectory(t, q, qd, qdd, obtained)


def _points(
    times: ArrayLike, values: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    time, positions = _numbers('time', times), _numbers('positions', values)
    if time.ndim != 1 or len(time) == 0:
        raise ArgumentError(f'time: expected shape (N,) with at least one point, got {time.shape}')
    if positions.ndim != 2 or len(positions) != len(time):
        raise ArgumentError(
            f'positions: expected shape ({len(time)}, n), one row per time, got {positions.shape}'
        )
    if not np.isfinite(time).all():
        i = int(np.argmin(np.isfinite(time)))
        raise ArgumentError(f'time: point {i}: expected a finite number, got {time[i]}')
    _refuse('positions', positions, ~np.isfinite(positions), 'a finite number')
    return time, positions


def _derivatives(
    name: str, given: ArrayLike | None, shape: tuple[int, ...]
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    # The values, shape (N, n), and the points that have them, shape (N,).
    if given is None:
        return np.full(shape, np.nan), np.zeros(shape[0], dtype=bool)
    values = _numbers(name, given)
    if values.shape != shape:
        raise ArgumentError(
            f'{name}: expected the shape of positions, {shape}, got {values.shape}'
        )
    has_values: NDArray[np.bool_] = ~np.isnan(values).all(axis=1)
    _refuse(
        name,
        values,
        has_values[:, None] & ~np.isfinite(values),
        'a finite number, or NaN for all joints of a point where they are missing',
    )
    return values, has_values


def _numbers(name: str, values: ArrayLike) -> NDArray[np.float64]:
    try:
        return np.array(values, dtype=float, order='C')
    except (TypeError, ValueError) as error:
        raise ArgumentError(
            f'{name}: expected numbers, the same number for each point: {error}'
        ) from error


def _refuse(
    name: str, values: NDArray[np.float64], wrong: NDArray[np.bool_], expected: str
) -> None:
    if wrong.any():
        point, joint = np.argwhere(wrong)[0]
        raise ArgumentError(
            f'{name}: point {point}, joint {joint}: expected {expected}, '
            f'got {values[point, joint]}'
        )


def _require_increasing(time: NDArray[np.float64]) -> None:
    late = np.flatnonzero(~(np.diff(time) > 0.0))
    if len(late):
        i = int(late[0]) + 1
        raise ArgumentError(
            f'time: point {i}: expected more than {float(time[i - 1])} s, the '
            f'time of the point before, got {float(time[i])} s; or give the '
            'velocities and accelerations of all points'
        )


def _require_finite(velocities: NDArray[np.float64], accelerations: NDArray[np.float64]) -> None:
    finite = (np.isfinite(velocities) & np.isfinite(accelerations)).all(axis=1)
    if not finite.all():
        raise ArgumentError(
            f'time: point {int(np.argmin(finite))}: expected steps long enough '
            'for finite velocities and accelerations, got an overflow'
        )


def _fill(
    time: NDArray[np.float64],
    positions: NDArray[np.float64],
    velocities: NDArray[np.float64],
    has_velocity: NDArray[np.bool_],
    accelerations: NDArray[np.float64],
    has_acceleration: NDArray[np.bool_],
) -> str:
    # Fill in missing values, and return a message on their source.
    count = len(time)
    if count == 1:
        velocities[~has_velocity] = 0.0
        accelerations[~has_acceleration] = 0.0
        return _message(
            'velocities',
            has_velocity,
            'zero, the only point is at rest',
            'accelerations',
            has_acceleration,
            'zero, the only point is at rest',
        )
    spline_slopes(time, positions, has_velocity, velocities)
    if has_velocity[1:-1].any():
        spline_slopes(time, velocities, has_acceleration, accelerations)
        source = 'the slopes of a cubic spline through the velocities'
    else:
        curvature = _second_derivatives(time, positions, velocities)
        accelerations[~has_acceleration] = curvature[~has_acceleration]
        source = 'the second derivatives of a cubic spline through the positions'
    return _message(
        'velocities',
        has_velocity,
        'the slopes of a cubic spline through the positions',
        'accelerations',
        has_acceleration,
        source,
    )


def _second_derivatives(
    time: NDArray[np.float64], values: NDArray[np.float64], slopes: NDArray[np.float64]
) -> NDArray[np.float64]:
    # (31) of the piece to the right of each point, at the last point of the piece to its left.
    h = np.diff(time)[:, None]
    secant = np.diff(values, axis=0) / h
    begin = (6.0 * secant - 4.0 * slopes[:-1] - 2.0 * slopes[1:]) / h
    end = (2.0 * slopes[-2] + 4.0 * slopes[-1] - 6.0 * secant[-1]) / h[-1]
    return np.concatenate((begin, end[None]))


def _message(*parts: Any) -> str:
    # From name, points with given values, and source of the others, in turn.
    sentences = []
    for name, given, source in zip(parts[::3], parts[1::3], parts[2::3], strict=True):
        missing = int(np.count_nonzero(~given))
        if missing:
            where = '' if missing == len(given) else f' of {missing} of {len(given)} points'
            sentences.append(f'{name}{where} were not given: {source}')
    return '; '.join(sentences)


def spline_slopes(
    time: NDArray[np.float64],
    values: NDArray[np.float64],
    given: NDArray[np.bool_],
    slopes: NDArray[np.float64],
) -> None:
    """
    Compute the missing slopes of the cubic spline through some values.

    The spline is twice differentiable at every point without a given slope. At an end without a
    slope the two outermost pieces are one cubic; with too few points for that the piece is a
    parabola, or a line.

    Parameters
    ----------
    time : numpy.ndarray, shape (N,)
        Strictly increasing, s; N >= 2.
    values : numpy.ndarray, shape (N, n)
        n functions of time.
    given : numpy.ndarray of bool, shape (N,)
        The points with known slopes.
    slopes : numpy.ndarray, shape (N, n)
        Overwritten where they are not given; unit of the values per s. NaN on overflow.

    References
    ----------
    docs/mathematics.md, equation (30).

    """
    # A point with a known slope divides the spline into two independent ones.
    last = len(time) - 1
    ends = np.union1d(np.flatnonzero(given), [0, last])
    for begin, end in itertools.pairwise(ends):
        if end - begin > 1 or not (given[begin] and given[end]):
            _solve_slopes(
                time[begin : end + 1],
                values[begin : end + 1],
                given[[begin, end]],
                slopes[begin : end + 1],
            )


def _solve_slopes(
    time: NDArray[np.float64],
    values: NDArray[np.float64],
    given: NDArray[np.bool_],
    slopes: NDArray[np.float64],
) -> None:
    if len(time) == 2:
        # scipy would take the secant for the slope of a free end.
        secant = (values[1] - values[0]) / (time[1] - time[0])
        if not given[0]:
            slopes[0] = 2.0 * secant - slopes[1] if given[1] else secant
        if not given[1]:
            slopes[1] = 2.0 * secant - slopes[0]
        return
    # Imported here: it takes as long as the rest of the library.
    from scipy.interpolate import CubicSpline

    kinds = tuple(
        (1, slopes[end]) if is_given else 'not-a-knot'
        for end, is_given in zip((0, -1), given, strict=True)
    )
    inner = slice(1 if given[0] else 0, -1 if given[1] else None)
    try:
        slopes[inner] = CubicSpline(time, values, bc_type=kinds)(time, 1)[inner]
    except ValueError:  # overflow
        slopes[inner] = np.nan
