"""Cached comparisons of all public robots, for tests and docs/accuracy.md."""

from functools import cache
from typing import NamedTuple

from dynamics_node import RobotDescriptionError, RobotModel
import numpy as np

from .cross_library import Routes, worst_of
from .robots import public_robot, public_robots

# Promised bound of all errors relative to Pinocchio and 80-bit arithmetic.
BOUND = 1e-11

# MuJoCo sums about the center of mass of the robot, and its C is the polar form of its bias here:
# both lose digits, as its error relative to 80-bit arithmetic shows.
MUJOCO_BOUND = 1e-9

STATES = 5


class Row(NamedTuple):
    """
    The largest errors of one robot over its random states.

    `errors`, `plain` and `condition`: see `cross_library.Comparison`. `replaced`: links whose
    inertia MuJoCo refuses.

    """

    name: str
    joints: int
    mimics: int
    errors: dict
    plain: dict
    condition: float
    replaced: tuple


class LeftOut(NamedTuple):
    """A URDF that is not compared, with the reason."""

    name: str
    reason: str


@cache
def compare(name):
    """Return the Row of a public robot, or LeftOut."""
    try:
        model = RobotModel.from_urdf(public_robot(name))
    except RobotDescriptionError as error:
        more = len(error.problems) - 1
        return LeftOut(name, error.problems[0] + (f' (and {more} more)' if more else ''))
    if not model.joint_names:
        return LeftOut(name, 'it has no movable joint: D, C and G have no rows')
    return row(name, public_robot(name).read_text(), model)


def row(name, text, model, states=STATES):
    """Compare one robot at random states, seeded by its number of joints."""
    routes = Routes(text, model)
    rng = np.random.default_rng(len(model.joint_names))
    results = [routes.compare(rng) for _ in range(states)]
    return Row(
        name,
        len(model.joint_names),
        len(model.tree.moving_joint_names) - len(model.joint_names),
        {pair: worst_of(result.errors[pair] for result in results) for pair in results[0].errors},
        worst_of(result.plain for result in results),
        max(result.condition for result in results),
        routes.judges['mujoco'].replaced,
    )


def sweep():
    """Return the rows of all compared public robots, and those left out."""
    results = [compare(name) for name in public_robots()]
    return (
        [result for result in results if isinstance(result, Row)],
        [result for result in results if isinstance(result, LeftOut)],
    )
