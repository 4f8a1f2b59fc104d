"""Times of several candidates in interleaved rounds, and ratios of the same round."""

from contextlib import contextmanager
from dataclasses import dataclass
import gc
from itertools import cycle, islice
import math
import os
from pathlib import Path
from time import perf_counter

import numpy as np

# A sample is a loop of calls that takes about this long, so the clock's own cost vanishes.
SAMPLE_SECONDS = 0.008
# One call longer than this is measured in the first rounds only.
SLOW_CALL_SECONDS = 0.02
SLOW_ROUNDS = 5


@dataclass(frozen=True)
class Spread:
    """
    The median of values from several rounds and the middle half of them.

    Attributes
    ----------
    median, low, high : float
        Median, lower and upper quartile.

    """

    median: float
    low: float
    high: float


def spread_of(values):
    """
    Return the median and the quartiles of values.

    Parameters
    ----------
    values : array_like, shape (rounds,)

    Returns
    -------
    Spread

    """
    low, median, high = np.percentile(np.asarray(values, dtype=float), (25, 50, 75))
    return Spread(float(median), float(low), float(high))


def ratio_of(theirs, ours):
    """
    Return the spread of their time / our time, round by round.

    Parameters
    ----------
    theirs, ours : sequence of float
        Seconds per call; entry r of both is from round r. A slow candidate may have fewer.

    Returns
    -------
    Spread

    """
    rounds = min(len(theirs), len(ours))
    return spread_of(np.asarray(theirs[:rounds]) / np.asarray(ours[:rounds]))


def interleaved(candidates, rounds, slow_rounds=SLOW_ROUNDS):
    """
    Time candidates in turns, each round in another order.

    What disturbs the machine for a moment then hits neighbors alike, and no candidate always
    finds the caches as the same other one left them. The garbage collector is off meanwhile.

    Parameters
    ----------
    candidates : dict of hashable to (callable, sequence of tuple)
        Name → function and the arguments that its calls go through in turn.
    rounds : int
        At least 1.
    slow_rounds : int
        Rounds that candidates take part in whose single call is longer than SLOW_CALL_SECONDS.

    Returns
    -------
    dict of hashable to list of float
        Name → seconds per call, one number per round.

    """
    names = list(candidates)
    samples: dict = {name: [] for name in names}
    with collector_off():
        calls = {name: _calibrate(*candidates[name]) for name in names}
        for turn in range(rounds):
            for k in range(len(names)):
                name = names[(turn + k) % len(names)]
                count, is_slow = calls[name]
                if is_slow and turn >= slow_rounds:
                    continue
                function, arguments = candidates[name]
                samples[name].append(time_of(function, arguments, count))
    return samples


def time_of(function, arguments, count):
    """
    Return the seconds per call of `count` calls.

    Parameters
    ----------
    function : callable
    arguments : sequence of tuple
        Taken in turn, so that a library that remembers its last state gains nothing.
    count : int

    Returns
    -------
    float

    """
    ready = list(islice(cycle(arguments), count))
    begin = perf_counter()
    for argument in ready:
        function(*argument)
    return (perf_counter() - begin) / count


@contextmanager
def collector_off():
    """Collect garbage, unless an outer block has, then keep the collector off as `timeit` does."""
    was_enabled = gc.isenabled()
    if was_enabled:
        gc.collect()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


@contextmanager
def one_core():
    """Hold every thread of this process on one core, where the system can do that."""
    if not hasattr(os, 'sched_setaffinity'):
        yield
        return
    before = os.sched_getaffinity(0)
    _hold_threads({min(before)})
    try:
        yield
    finally:
        _hold_threads(before)


def _hold_threads(cores):
    # Threads that start later inherit the cores of the one that starts them.
    for task in Path('/proc/self/task').iterdir():
        try:
            os.sched_setaffinity(int(task.name), cores)
        except ProcessLookupError:  # that thread has just ended
            continue


def _calibrate(function, arguments):
    # The first call may compile or allocate: it does not count.
    function(*arguments[0])
    once = time_of(function, arguments, 1)
    if once > SLOW_CALL_SECONDS:
        return 1, True
    count = max(1, math.ceil(0.1 * SAMPLE_SECONDS / once))
    per_call = time_of(function, arguments, count)
    return max(1, math.ceil(SAMPLE_SECONDS / per_call)), False
