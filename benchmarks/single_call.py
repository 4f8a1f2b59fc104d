"""Single states from Python: all quantities, libraries and arms."""

from dataclasses import dataclass

from .agreement import check, DifferentResultError
from .libraries import dynamics_node
from .quantities import QUANTITIES
from .timing import collector_off, interleaved

# Passes over all robots and quantities: a slow minute of the machine then affects all of them.
PASSES = 3
# Rounds of a pass for slow calls.
SLOW_ROUNDS = 2


@dataclass(frozen=True)
class Row:
    """
    The times of one library for one quantity of one robot.

    Attributes
    ----------
    robot, quantity, library : str
    parts : tuple of str
        Returned parts.
    how : str
        Called functions of the library.
    seconds : list of float
        Per call, one number per round.
    reference : list of float
        Times of this library in the same rounds of the same process.
    error : float
        Largest difference from this library's result, relative to the largest element.

    """

    robot: str
    quantity: str
    library: str
    parts: tuple
    how: str
    seconds: list
    reference: list
    error: float


def measure(robots, loaded, rounds, say=print):
    """
    Check and time every library on every robot.

    Parameters
    ----------
    robots : list of Robot
    loaded : dict of str to module
        From `libraries.load`.
    rounds : int
    say : callable
        Prints the progress.

    Returns
    -------
    rows : list of Row
        This library's own rows come first for each robot and quantity.
    refused : list of str
        A sentence for each call that was not timed because its results differ or it fails.

    """
    refused: list[str] = []
    groups = []
    for robot in robots:
        say(f'single calls: preparing {robot.name}')
        calls_by_name = _calls_by_name(robot, loaded, refused)
        groups += [_Group(robot, quantity, calls_by_name, refused) for quantity in QUANTITIES]
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


def _calls_by_name(robot, loaded, refused):
    calls = {dynamics_node.NAME: dynamics_node.calls(robot)}
    for library in loaded.values():
        try:
            calls[library.NAME] = library.calls(robot)
        except (ValueError, RuntimeError) as error:
            refused.append(f'{library.NAME} does not take {robot.name}: {error}')
    return calls


class _Group:
    # The interleaved libraries for one quantity of one robot.
    def __init__(self, robot, quantity, calls_by_name, refused):
        self.candidates, self.rows = {}, {}
        for name, calls in calls_by_name.items():
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
            # A slow library has fewer rounds.
            self.rows[name].reference.extend(samples[dynamics_node.NAME][: len(seconds)])
