"""Time of D, C and G by the number of joints."""

from dataclasses import dataclass

import numpy as np

from .agreement import check, DifferentResultError
from .generated_robots import binary_tree, chain
from .libraries import dynamics_node
from .robots import make_robot
from .timing import interleaved, spread_of

SIZES = (2, 4, 8, 16, 32, 64, 128, 256)
SHAPES = {'chain': chain, 'binary tree': binary_tree}
# Number of the largest sizes for the fit of the exponent: overhead dominates at small ones.
FITTED = 3


@dataclass(frozen=True)
class ScalingRow:
    """
    The times of one library for robots of one shape and size.

    Attributes
    ----------
    shape : str
    joints : int
    library : str
    seconds : list of float
        Per D, C and G, one number per round.
    reference : list of float
        Times of this library, same rounds.

    """

    shape: str
    joints: int
    library: str
    seconds: list
    reference: list


def measure(loaded, rounds, sizes=SIZES, say=print):
    """
    Time D, C and G of chains and trees.

    Parameters
    ----------
    loaded : dict of str to module
        Pinocchio is used.
    rounds : int
    sizes : sequence of int
        Numbers of joints.
    say : callable

    Returns
    -------
    rows : list of ScalingRow
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
    # All sizes in each round: a slow round then affects all of them alike.
    samples = interleaved(candidates, rounds)
    return [
        ScalingRow(shape, joints, name, seconds, samples[shape, joints, 'dynamics_node'])
        for (shape, joints, name), seconds in samples.items()
    ], refused


def exponent(rows, shape, library):
    """
    Return the slope of log(time) over log(joints) at the largest sizes, fitted per round.

    Parameters
    ----------
    rows : list of ScalingRow
    shape, library : str

    Returns
    -------
    Spread or None
        None for fewer than two sizes.

    """
    chosen = sorted(
        (row for row in rows if (row.shape, row.library) == (shape, library)),
        key=lambda row: row.joints,
    )[-FITTED:]
    if len(chosen) < 2:
        return None
    # A call that is slow only at the largest size has fewer rounds.
    rounds = min(len(row.seconds) for row in chosen)
    slopes = np.polyfit(
        np.log([row.joints for row in chosen]), np.log([row.seconds[:rounds] for row in chosen]), 1
    )[0]
    return spread_of(slopes)
