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

# Duration of a sample, a loop of calls, s: long beside the time of reading the clock.
SAMPLE_SECONDS = 0.008
# A call longer than this, s, is measured in SLOW_ROUNDS rounds only.
SLOW_CALL_SECONDS = 0.02
SLOW_ROUNDS = 5


@dataclass(frozen=True)
class Spread:
    """
    Median and quartiles of the values of several rounds.

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


def ratio_of(seconds, reference):
    """
    Return the spread of the ratios of two times, round by round.

    Parameters
    ----------
    seconds, reference : sequence of float
        Seconds per call; entry r of both is from round r. A slow call has fewer entries.

    Returns
    -------
    Spread

    """
    rounds = min(len(seconds), len(reference))
    return spread_of(np.asarray(seconds[:rounds]) / np.asarray(reference[:rounds]))


def interleaved(candidates, rounds, slow_rounds=SLOW_ROUNDS):
    """
    Time candidates in turns, each round in another order.

    A disturbance of the machine then affects neighbors alike, and no candidate always follows the
    same other one in the caches. The garbage collector is off.

    Parameters
    ----------
    candidates : dict of hashable to (callable, sequence of tuple)
        Name → function and the arguments of its calls, used in turn.
    rounds : int
        At least 1.
    slow_rounds : int
        Rounds of candidates with calls longer than SLOW_CALL_SECONDS.

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
        Used in turn: caching the last state gains nothing.
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
    """Collect garbage, then disable the collector as `timeit` does; blocks may be nested."""
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
    """Pin all threads of this process to one core, if the system supports it."""
    if not hasattr(os, 'sched_setaffinity'):
        yield
        return
    before = os.sched_getaffinity(0)
    _pin_threads({min(before)})
    try:
        yield
    finally:
        _pin_threads(before)


def _pin_threads(cores):
    # New threads inherit the cores of their creator.
    for task in Path('/proc/self/task').iterdir():
        try:
            os.sched_setaffinity(int(task.name), cores)
        except ProcessLookupError:  # the thread has just ended
            continue


def _calibrate(function, arguments):
    # The first call may compile or allocate.
    function(*arguments[0])
    once = time_of(function, arguments, 1)
    if once > SLOW_CALL_SECONDS:
        return 1, True
    count = max(1, math.ceil(0.1 * SAMPLE_SECONDS / once))
    per_call = time_of(function, arguments, count)
    return max(1, math.ceil(SAMPLE_SECONDS / per_call)), False
