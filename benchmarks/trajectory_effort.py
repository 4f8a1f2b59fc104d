"""
The efforts of 10 000 points of a trajectory of the 7-joint arm, and its largest payload.

    python -m benchmarks.trajectory_effort

Ours with `RobotModel`, on all cores. For comparison, on one core, the usual Python code without
it: scipy's cubic spline and a loop over Pinocchio's rnea that keeps the results; its first call
gave the same efforts. The ratio is to our efforts from positions alone, round by round.

"""

import numpy as np

from .formatting import digits, time_text
from .robots import arm7
from .timing import interleaved, ratio_of, spread_of

POINTS = 10_000
ROUNDS = 15
TOLERANCE = 1e-8


def motion(robot, count=POINTS):
    """
    Return a trajectory: times, positions and their derivatives.

    Parameters
    ----------
    robot : Robot
    count : int
        Number of points, N.

    Returns
    -------
    time : numpy.ndarray, shape (N,)
        s.
    q, qd, qdd : numpy.ndarray, shape (N, n)
        rad, rad/s, rad/s².

    """
    time = np.linspace(0.0, 10.0, count)
    rate = np.linspace(0.7, 1.9, robot.n)
    angle = np.outer(time, rate)
    return time, 0.6 * np.sin(angle), 0.6 * rate * np.cos(angle), -0.6 * rate**2 * np.sin(angle)


def by_pinocchio(robot, time, q):
    """
    Return a function that computes the efforts with scipy and Pinocchio.

    Parameters
    ----------
    robot : Robot
    time : numpy.ndarray, shape (N,)
    q : numpy.ndarray, shape (N, n)

    Returns
    -------
    callable
        Without arguments; returns a fresh array (N, n).

    """
    import pinocchio
    from scipy.interpolate import CubicSpline

    from .libraries.pinocchio import model_of

    model = model_of(robot)
    data, rnea = model.createData(), pinocchio.rnea

    def efforts():
        spline = CubicSpline(time, q)
        qd, qdd = spline(time, 1), spline(time, 2)
        result = np.empty_like(q)
        for i in range(len(q)):
            result[i] = rnea(model, data, q[i], qd[i], qdd[i])
        return result

    return efforts


def measure(count=POINTS, rounds=ROUNDS):
    """
    Measure efforts and payload.

    Parameters
    ----------
    count : int
        Number of points.
    rounds : int

    Returns
    -------
    list of dict
        Column title → text.

    Raises
    ------
    RuntimeError
        If Pinocchio's efforts differ.

    """
    robot = arm7()
    robot.model.specialize()
    time, q, qd, qdd = motion(robot, count)
    effort = robot.model.trajectory_effort
    reference = 'efforts, from positions alone'
    ways = {
        reference: lambda: effort(time, q),
        'efforts, accelerations missing': lambda: effort(time, q, qd),
        'efforts, nothing missing': lambda: effort(time, q, qd, qdd),
        'largest payload': lambda: robot.model.max_payload(q, 'tool_center', qd=qd, qdd=qdd),
        'scipy and Pinocchio: efforts, from positions alone': by_pinocchio(robot, time, q),
    }
    expected, other = effort(time, q), list(ways.values())[-1]()
    error = np.abs(other - expected).max() / np.abs(expected).max()
    if not error <= TOLERANCE:
        raise RuntimeError(
            f'efforts of Pinocchio: expected a difference of at most {TOLERANCE:g} '
            f'of the largest, got {error:.2g}'
        )
    samples = interleaved(
        {name: (way, [()]) for name, way in ways.items()}, rounds, slow_rounds=rounds
    )
    return [_row(name, count, seconds, samples[reference]) for name, seconds in samples.items()]


def _row(name, count, seconds, reference):
    ratio = ratio_of(seconds, reference)
    return {
        'what': name,
        f'{count} points': time_text(spread_of(seconds).median),
        'ratio': digits(ratio.median),
        'quartiles': f'{digits(ratio.low)} to {digits(ratio.high)}',
    }


if __name__ == '__main__':
    from .external_sections import Section
    from .tables import section_table

    print(section_table(Section('', '', measure())))
