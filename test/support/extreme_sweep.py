"""Cached comparisons of the extreme robots, for their test and docs/accuracy.md."""

from functools import cache

from dynamics_node import RobotModel

from .extreme_robots import extreme_robots
from .result_cache import row


@cache
def compare_extreme(name):
    """Return the Row of one of `extreme_robots`."""
    text = extreme_robots()[name]
    return row(name, text, RobotModel.from_urdf(text))
