"""How the time of D, C and G grows with the number of joints."""

from dataclasses import dataclass

import numpy as np

from .agreement import check, DifferentResultError
from .generated_robots import binary_tree, chain
from .libraries import dynamics_node
from .robots import make_robot
from .timing import interleaved, spread_of

SIZES = (2, 4, 8, 16, 32, 64, 128, 256)
SHAPES = {'chain': chain, 'binary tree': binary_tree}
# The exponent is fitted to the largest sizes; at the small end the way into a call dominates.
FITTED = 3


@dataclass(frozen=True)
class GrowthRow:
    """
    The times of one library for robots of one shape and size.

    Attributes
    ----------
    shape : str
    joints : int
    library : str
    seconds : list of float
        Per D, C and G, one number per round.
    ours : list of float
        This library's, same rounds.

    """

    shape: str
    joints: int
    library: str
    seconds: list
    ours: list


def measure(loaded, rounds, sizes=SIZES, say=print):
    """
    Time D, C and G of chains and trees.

    Parameters
    ----------
    loaded : dict of str to module
        Of these, Pinocchio takes part.
    rounds : int
    sizes : sequence of int
        Numbers of joints.
    say : callable

    Returns
    -------
    rows : list of GrowthRow
    refused : list of str

    """
    libraries = {'dynamics_node': dynamics_node}
    if 'pinocchio' in loaded:
        libraries['Pinocchio'] = loaded['pinocchio']
    candidates: dict = {}
    refused: list[str] = []
    for shape, text_of in SHAPES.items():
        for joints in sizes:
            say(f'growth: {shape} of {joints} joints')
            robot = make_robot(f'{shape} of {joints}', text_of(joints), count=8)
            for name, library in libraries.items():
                call = library.calls(robot)['dynamics']
                try:
                    check(robot, 'dynamics', call)
                except DifferentResultError as error:
                    refused.append(f'{name}, {robot.name}: {error}')
                    continue
                candidates[shape, joints, name] = (
                    call.run,
                    call.arguments('dynamics', robot.states),
                )
    say(f'growth: {rounds} rounds')
    # All sizes in each round: what slows one round down then bends no curve.
    samples = interleaved(candidates, rounds)
    return [
        GrowthRow(shape, joints, name, seconds, samples[shape, joints, 'dynamics_node'])
        for (shape, joints, name), seconds in samples.items()
    ], refused


def exponent(rows, shape, library):
    """
    Return the slope of log(time) over log(joints) at the large end, fitted round by round.

    Parameters
    ----------
    rows : list of GrowthRow
    shape, library : str

    Returns
    -------
    Spread or None
        None if there are not two sizes.

    """
    chosen = sorted(
        (row for row in rows if (row.shape, row.library) == (shape, library)),
        key=lambda row: row.joints,
    )[-FITTED:]
    if len(chosen) < 2:
        return None
    # A call that is slow only at the largest size takes part in fewer rounds.
    rounds = min(len(row.seconds) for row in chosen)
    slopes = np.polyfit(
        np.log([row.joints for row in chosen]), np.log([row.seconds[:rounds] for row in chosen]), 1
    )[0]
    return spread_of(slopes)
