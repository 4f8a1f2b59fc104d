"""One state at a time, called from Python: every quantity, every library, three arms."""

from dataclasses import dataclass

from .agreement import check, DifferentResultError
from .quantities import QUANTITIES
from .rivals import ours
from .timing import collector_off, interleaved


@dataclass(frozen=True)
class Row:
    """
    The times of one library for one quantity of one robot.

    Attributes
    ----------
    robot, quantity, library : str
    parts : tuple of str
        What the call returns.
    how : str
        The library's functions.
    seconds : list of float
        Per call, one number per round.
    ours : list of float
        This library's, same rounds, same process.
    error : float
        Largest difference from this library's result, as a part of the largest element.

    """

    robot: str
    quantity: str
    library: str
    parts: tuple
    how: str
    seconds: list
    ours: list
    error: float


def measure(robots, loaded, rounds, say=print):
    """
    Check and time every library on every robot.

    Parameters
    ----------
    robots : list of Robot
    loaded : dict of str to module
        As `rivals.load` returns them.
    rounds : int
    say : callable
        Told about the progress.

    Returns
    -------
    rows : list of Row
        This library's own rows come first for each robot and quantity.
    refused : list of str
        A sentence for each library and quantity that was not timed because it differs or fails.

    """
    rows: list[Row] = []
    refused: list[str] = []
    for robot in robots:
        calls = {'ours': ours.calls(robot)}
        for name, rival in loaded.items():
            try:
                calls[name] = rival.calls(robot)
            except (ValueError, RuntimeError) as error:
                refused.append(f'{rival.NAME} does not take {robot.name}: {error}')
        with collector_off():
            for quantity in QUANTITIES:
                say(f'single calls: {robot.name}, {QUANTITIES[quantity]}')
                rows += _measure_quantity(robot, quantity, calls, loaded, rounds, refused)
    return rows, refused


def _measure_quantity(robot, quantity, calls, loaded, rounds, refused):
    names = {name: rival.NAME for name, rival in loaded.items()} | {'ours': ours.NAME}
    candidates, errors = {}, {}
    for name, offered in calls.items():
        call = offered.get(quantity)
        if call is None:
            continue
        try:
            errors[name] = check(robot, quantity, call)
        except DifferentResultError as error:
            refused.append(f'{names[name]}, {robot.name}, {QUANTITIES[quantity]}: {error}')
            continue
        candidates[name] = (call.run, call.arguments(quantity, robot.states))
    samples = interleaved(candidates, rounds)
    return [Row(robot.name, quantity, names[name], calls[name][quantity].parts,
                calls[name][quantity].how, seconds, samples['ours'], errors[name])
            for name, seconds in samples.items()]
