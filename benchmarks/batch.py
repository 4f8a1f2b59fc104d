"""Many states in one call: D, C and G of a 7-joint arm."""

from dataclasses import dataclass
import os
from time import perf_counter, process_time

import numpy as np

from .timing import interleaved, one_core

# Share of the states that a loop is timed with: it takes the same time for each.
LOOP_PART = 0.02
# Into existing arrays, and with the allocation of 84 MB of arrays.
DYNAMICS_NODE, FRESH = 'dynamics_node', 'dynamics_node, fresh arrays'
CHECKED = 64
TOLERANCE = 1e-8


@dataclass(frozen=True)
class BatchRow:
    """
    The times of one library for all states.

    Attributes
    ----------
    library : str
    how : str
    cores : str
        'one' or 'all'.
    seconds : list of float
        For all states, one number per round.
    reference : dict of str to list of float
        Times of this library on 'one' core and on 'all', same rounds.
    cores_used : list of float
        CPU time of the process divided by elapsed time.

    """

    library: str
    how: str
    cores: str
    seconds: list
    reference: dict
    cores_used: list


def measure(robot, count, loaded, rounds, say=print):
    """
    Time D, C and G of many states.

    Parameters
    ----------
    robot : Robot
    count : int
        Number of states, N.
    loaded : dict of str to module
        Pinocchio and frax are used.
    rounds : int
    say : callable

    Returns
    -------
    rows : list of BatchRow
    refused : list of str
        A sentence for each library that was not timed because its results differ.

    """
    rng = np.random.default_rng(5)
    Q = rng.uniform(-1.0, 1.0, (count, robot.n))
    QD = rng.normal(0.0, 1.0, (count, robot.n))
    all_cores = os.cpu_count() or 1
    robot.model.specialize()
    dynamics = robot.model.dynamics
    answer = dynamics(Q, QD)
    functions: dict = {}
    for cores, threads in (('one', 1), ('all', all_cores)):
        functions[DYNAMICS_NODE, f'dynamics(Q, QD, out=answer, threads={threads})', cores] = (
            lambda threads=threads: dynamics(Q, QD, out=answer, threads=threads),
            1.0,
        )
        functions[FRESH, f'dynamics(Q, QD, threads={threads})', cores] = (
            lambda threads=threads: dynamics(Q, QD, threads=threads),
            1.0,
        )
    refused: list[str] = []
    if 'pinocchio' in loaded:
        part = max(1, round(LOOP_PART * count))
        loop = pinocchio_loop(
            loaded['pinocchio'].calls(robot)['dynamics'].run, Q[:part], QD[:part]
        )
        how = 'a Python loop over single calls that keeps the results'
        _admit(
            functions,
            refused,
            ('Pinocchio', how, 'one'),
            loop,
            count / part,
            robot,
            Q,
            QD,
            ('D', 'C', 'G'),
        )
    if 'frax' in loaded:
        many = loaded['frax'].batch(robot)
        for cores in ('one', 'all'):
            _admit(
                functions,
                refused,
                ('frax', 'jax.jit of jax.vmap: D, C q̇ and G', cores),
                lambda: many(Q, QD),
                1.0,
                robot,
                Q,
                QD,
                ('D', 'C qd', 'G'),
            )
    say(f'batch: {count} states, {len(functions)} ways')
    return _timed(functions, rounds), refused


def pinocchio_loop(call, Q, QD):
    """
    Return a function that computes D, C and G of some states one by one.

    Parameters
    ----------
    call : callable
        Pinocchio's D, C and G of one state.
    Q, QD : numpy.ndarray, shape (m, n)

    Returns
    -------
    callable
        Without arguments; returns fresh arrays (m, n, n), (m, n, n), (m, n).

    """

    def loop():
        m, n = Q.shape
        D, C, G = np.empty((m, n, n)), np.empty((m, n, n)), np.empty((m, n))
        for k in range(m):
            D[k], C[k], G[k] = call(Q[k], QD[k])
        return D, C, G

    return loop


def _admit(functions, refused, key, function, scale, robot, Q, QD, parts):
    # The results of the first states have to agree, as in `agreement`.
    D, C, G = robot.model.dynamics(Q[:CHECKED], QD[:CHECKED])
    expected = {'D': D, 'C': C, 'G': G, 'C qd': np.einsum('bij,bj->bi', C, QD[:CHECKED])}
    for part, value in zip(parts, function(), strict=True):
        head = np.asarray(value)[:CHECKED]
        reference = expected[part][: len(head)]
        error = np.abs(head - reference).max() / np.abs(reference).max()
        if not error <= TOLERANCE:
            refused.append(
                f'{key[0]}, batch, {part}: expected a difference of at most '
                f'{TOLERANCE:g} of the largest element, got {error:.2g}'
            )
            return
    functions[key] = (function, scale)


def _timed(functions, rounds):
    meters = {key: _Meter(function, key[2]) for key, (function, _) in functions.items()}
    samples = interleaved(
        {key: (meter, [()]) for key, meter in meters.items()}, rounds, slow_rounds=rounds
    )
    scaled = {
        key: [scale * value for value in samples[key]] for key, (_, scale) in functions.items()
    }
    reference = {key[2]: scaled[key] for key in functions if key[0] == DYNAMICS_NODE}
    return [
        BatchRow(
            library,
            how,
            cores,
            scaled[library, how, cores],
            reference,
            meters[library, how, cores].cores_used,
        )
        for library, how, cores in functions
    ]


class _Meter:
    # Runs a function on one core or on all, and records the number of busy cores.
    def __init__(self, function, cores):
        self.function, self.cores, self.cores_used = function, cores, []

    def __call__(self):
        if self.cores == 'one':
            with one_core():
                self._run()
        else:
            self._run()

    def _run(self):
        begin, cpu = perf_counter(), process_time()
        self.function()
        self.cores_used.append((process_time() - cpu) / (perf_counter() - begin))
