"""One state at a time, called from Python: every quantity, every library, three arms."""

from dataclasses import dataclass

from .agreement import check, DifferentResultError
from .libraries import dynamics_node
from .quantities import QUANTITIES
from .timing import collector_off, interleaved

# Every quantity gets its turn in each of so many passes over all of them, so that a slow minute
# of the machine does not hit one robot alone.
PASSES = 3
# Rounds of a pass that take part with calls that are slow.
SLOW_ROUNDS = 2


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
        This library's in the same rounds of the same process.
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
    refused: list[str] = []
    groups = []
    for robot in robots:
        say(f'single calls: preparing {robot.name}')
        offered = _offered(robot, loaded, refused)
        groups += [_Group(robot, quantity, offered, refused) for quantity in QUANTITIES]
    for number, part in enumerate(_parts(rounds), start=1):
        say(f'single calls: {part} rounds, pass {number}')
        with collector_off():
            for group in groups:
                group.measure(part)
    return [row for group in groups for row in group.rows.values()], refused


def _parts(rounds):
    # The rounds of each pass: 21 are 7 + 7 + 7.
    parts = [rounds // PASSES + (k < rounds % PASSES) for k in range(PASSES)]
    return [part for part in parts if part]


def _offered(robot, loaded, refused):
    calls = {dynamics_node.NAME: dynamics_node.calls(robot)}
    for rival in loaded.values():
        try:
            calls[rival.NAME] = rival.calls(robot)
        except (ValueError, RuntimeError) as error:
            refused.append(f'{rival.NAME} does not take {robot.name}: {error}')
    return calls


class _Group:
    # All libraries for one quantity of one robot: what is interleaved.
    def __init__(self, robot, quantity, offered, refused):
        self.candidates, self.rows = {}, {}
        for name, calls in offered.items():
            call = calls.get(quantity)
            if call is None:
                continue
            try:
                error = check(robot, quantity, call)
            except DifferentResultError as reason:
                refused.append(f'{name}, {robot.name}, {QUANTITIES[quantity]}: {reason}')
                continue
            self.candidates[name] = (call.run, call.arguments(quantity, robot.states))
            self.rows[name] = Row(robot.name, quantity, name, call.parts, call.how, [], [], error)

    def measure(self, rounds):
        samples = interleaved(self.candidates, rounds, SLOW_ROUNDS)
        for name, seconds in samples.items():
            self.rows[name].seconds.extend(seconds)
            # A slow library takes part in the first rounds: ours of the same ones.
            self.rows[name].ours.extend(samples[dynamics_node.NAME][: len(seconds)])
