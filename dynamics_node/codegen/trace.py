"""
Tracing scalars: arithmetic on them is recorded as a straight-line program.

The formulas of `kernels.recursive`, run on these instead of floats, leave one program per quantity
of a robot: constants are folded, zeros are dropped, repeated operations occur once. No sum is
reordered, so the results differ from those of the general kernel by rounding at most.

"""

from collections.abc import Sequence
import math
from typing import Any, cast, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..kernels import recursive
from ..kernels.packing import PackedModel

# Largest number of operations of a program. Straight-line code grows with the square of the
# number of joints; longer code takes long to compile, and reading it from memory is slower than
# the loops of the general kernel.
MAX_OPERATIONS = 15_000


class ProgramTooLongError(Exception):
    """A program has reached the largest number of operations."""


class Operation(NamedTuple):
    """
    One line of a program.

    Attributes
    ----------
    name : str
        'input', 'add', 'subtract', 'multiply', 'divide', 'negate', 'sin' or 'cos'.
    arguments : tuple
        Symbols and floats; for an input (name, index).

    """

    name: str
    arguments: tuple[Any, ...]


class Program:
    """
    A straight-line program, extended by arithmetic on its symbols.

    Attributes
    ----------
    limit : int
        Largest number of operations.
    operations : list of Operation
        In an order in which they can be run.

    """

    def __init__(self, limit: int):
        self.limit = limit
        self.operations: list[Operation] = []
        self._known: dict[Any, Symbol] = {}

    def input(self, name: str, index: int) -> 'Symbol':
        """
        Return the symbol of an input.

        Parameters
        ----------
        name : str
            Of an array.
        index : int
            In that array.

        Returns
        -------
        Symbol

        """
        return self.record('input', name, index)

    def record(self, name: str, *arguments: Any) -> 'Symbol':
        """
        Return the symbol of an operation; the same one if it was recorded before.

        Parameters
        ----------
        name : str
        *arguments
            See `Operation`.

        Returns
        -------
        Symbol

        Raises
        ------
        ProgramTooLongError
            If the program has reached its limit.

        """
        key: tuple[Any, ...] = (name, *map(_identity, arguments))
        if name in ('add', 'multiply'):
            key = (name, *sorted(key[1:], key=repr))
        if key not in self._known:
            self._known[key] = Symbol(self, len(self.operations))
            self.operations.append(Operation(name, arguments))
            if len(self.operations) > self.limit:
                raise ProgramTooLongError
        return self._known[key]

    def needed(self, results: 'Sequence[Symbol | float]') -> list[int]:
        """
        Return the operations that some results need, in an order in which they can be run.

        Each result is completed before the next one is begun, so few intermediate results are
        alive at a time, and most of them stay in registers.

        Parameters
        ----------
        results : sequence
            Symbols and floats.

        Returns
        -------
        list of int
            Indices into `operations`.

        """
        order: list[int] = []
        visited: set[int] = set()
        waiting: list[Symbol | float] = list(reversed(results))
        while waiting:
            item = waiting.pop()
            if isinstance(item, int):
                order.append(item)
            elif isinstance(item, Symbol) and item.index not in visited:
                visited.add(item.index)
                # First its arguments, then the operation itself: its bare index comes up again.
                waiting.append(item.index)
                waiting += [
                    argument
                    for argument in reversed(self.operations[item.index].arguments)
                    if isinstance(argument, Symbol)
                ]
        return order


class Symbol:
    """
    The result of one operation of a program.

    Attributes
    ----------
    program : Program
    index : int
        Of the operation.

    """

    __slots__ = ('index', 'program')

    def __init__(self, program: Program, index: int):
        self.program = program
        self.index = index

    @property
    def _negated(self) -> 'Symbol | None':
        # The symbol of which this is the negative, if any.
        operation = self.program.operations[self.index]
        return operation.arguments[0] if operation.name == 'negate' else None

    def __add__(self, other: 'Symbol | float') -> 'Symbol | float':
        if not isinstance(other, Symbol):
            return self if other == 0 else self.program.record('add', self, float(other))
        if other._negated is not None:
            return self - other._negated
        return self.program.record('add', self, other)

    __radd__ = __add__

    def __sub__(self, other: 'Symbol | float') -> 'Symbol | float':
        if not isinstance(other, Symbol):
            return self if other == 0 else self.program.record('subtract', self, float(other))
        if other is self:
            return 0.0
        if other._negated is not None:
            return self + other._negated
        return self.program.record('subtract', self, other)

    def __rsub__(self, other: float) -> 'Symbol':
        return -self if other == 0 else self.program.record('subtract', float(other), self)

    def __mul__(self, other: 'Symbol | float') -> 'Symbol | float':
        if isinstance(other, Symbol):
            if self._negated is not None:
                return -(self._negated * other)
            if other._negated is not None:
                return -(self * other._negated)
            return self.program.record('multiply', self, other)
        if other == 0:
            return 0.0
        if other == 1:
            return self
        return -self if other == -1 else self.program.record('multiply', self, float(other))

    __rmul__ = __mul__

    def __truediv__(self, other: 'Symbol | float') -> 'Symbol':
        return self.program.record('divide', self, other)

    def __rtruediv__(self, other: float) -> 'Symbol | float':
        return 0.0 if other == 0 else self.program.record('divide', float(other), self)

    def __neg__(self) -> 'Symbol':
        if self._negated is not None:
            return self._negated
        return self.program.record('negate', self)

    def sin(self) -> 'Symbol':
        """Record the sine; `numpy.sin` calls this."""
        return self.program.record('sin', self)

    def cos(self) -> 'Symbol':
        """Record the cosine; `numpy.cos` calls this."""
        return self.program.record('cos', self)


def _identity(argument: Any) -> Any:
    # Symbols by index; 0.0 and -0.0 compare equal but are two constants.
    if isinstance(argument, Symbol):
        return 'symbol', argument.index
    return (argument, math.copysign(1.0, argument)) if isinstance(argument, float) else argument


class Quantity(NamedTuple):
    """
    A function of the joint state as a straight-line program.

    Attributes
    ----------
    name : str
    joint_count : int
        n.
    inputs : tuple of str
        Names of its arguments, arrays of n numbers each.
    program : Program
        Its inputs are these and 'numbers': those of `PackedModel`, row after row.
    outputs : tuple of numpy.ndarray
        Symbols and floats.
    positive : tuple
        Symbols and floats that must be positive, otherwise the outputs are invalid.

    """

    name: str
    joint_count: int
    inputs: tuple[str, ...]
    program: Program
    outputs: tuple[Any, ...]
    positive: tuple[Any, ...] = ()

    @property
    def operation_count(self) -> int:
        """Number of operations that the outputs need."""
        return len(self.program.needed(self.results()))

    def results(self) -> list[Any]:
        """Return all results, from the tips to the base, the order of the formulas."""
        results = [
            (max(place), value)
            for output in self.outputs
            for place, value in np.ndenumerate(output)
        ]
        results.sort(key=lambda item: -item[0])
        return [*self.positive, *(value for _, value in results)]


def input_places(packed: PackedModel) -> list[tuple[int, int]]:
    """
    Return which of a robot's numbers are inputs of its programs.

    Parameters
    ----------
    packed : PackedModel

    Returns
    -------
    list of tuple of int
        Row and column in its numbers: gravity, and in the payload variant all inertia.

    """
    places = [(packed.body_count, column) for column in range(3)]
    if packed.payload_variant:
        columns = [*range(recursive.INERTIA, recursive.MULTIPLIER), recursive.ROTOR]
        places += [(row, column) for row in range(packed.body_count) for column in columns]
    return places


class _Robot:
    # The arguments of the formulas of `recursive`, with symbols in place of inputs.

    def __init__(self, packed: PackedModel):
        self.program = Program(MAX_OPERATIONS)
        self.structure = packed.structure
        self.n = recursive.joint_count(packed.structure)
        self.numbers = packed.numbers.astype(object)
        for row, column in input_places(packed):
            self.numbers[row, column] = self.program.input(
                'numbers', row * recursive.WIDTH + column
            )
        self.workspace = cast(
            recursive.Workspace,
            tuple(array.astype(object) for array in recursive.make_workspace(packed.body_count)),
        )

    def inputs(self, name: str) -> NDArray[Any]:
        return np.array([self.program.input(name, i) for i in range(self.n)], dtype=object)

    def zeros(self, *shape: int) -> NDArray[Any]:
        return np.full(shape, 0.0, dtype=object)


def dynamics(packed: PackedModel) -> Quantity:
    """Record D, C and G."""
    robot = _Robot(packed)
    D, C, G = robot.zeros(robot.n, robot.n), robot.zeros(robot.n, robot.n), robot.zeros(robot.n)
    recursive.dynamics_of_state(
        robot.structure,
        robot.numbers,
        robot.inputs('q'),
        robot.inputs('qd'),
        robot.workspace,
        D,
        C,
        G,
    )
    return Quantity('dynamics', robot.n, ('q', 'qd'), robot.program, (D, C, G))


def mass_matrix(packed: PackedModel) -> Quantity:
    """Record D."""
    robot = _Robot(packed)
    D = robot.zeros(robot.n, robot.n)
    recursive.mass_matrix_of_state(
        robot.structure, robot.numbers, robot.inputs('q'), robot.workspace, D
    )
    return Quantity('mass_matrix', robot.n, ('q',), robot.program, (D,))


def coriolis_matrix(packed: PackedModel) -> Quantity:
    """Record C."""
    quantity = dynamics(packed)
    return quantity._replace(name='coriolis_matrix', outputs=quantity.outputs[1:2])


def gravity_torque(packed: PackedModel) -> Quantity:
    """Record G."""
    robot = _Robot(packed)
    G = robot.zeros(robot.n)
    recursive.gravity_of_state(
        robot.structure, robot.numbers, robot.inputs('q'), robot.workspace, G
    )
    return Quantity('gravity_torque', robot.n, ('q',), robot.program, (G,))


def inverse_dynamics(packed: PackedModel) -> Quantity:
    """Record the efforts of a motion."""
    robot = _Robot(packed)
    tau = robot.zeros(robot.n)
    recursive.inverse_dynamics_of_state(
        robot.structure,
        robot.numbers,
        robot.inputs('q'),
        robot.inputs('qd'),
        robot.inputs('qdd'),
        robot.workspace,
        tau,
    )
    return Quantity('inverse_dynamics', robot.n, ('q', 'qd', 'qdd'), robot.program, (tau,))


def forward_dynamics(packed: PackedModel) -> Quantity:
    """Record the accelerations caused by efforts, D q̈ = τ - (C q̇ + G)."""
    robot = _Robot(packed)
    q, qd, tau = robot.inputs('q'), robot.inputs('qd'), robot.inputs('tau')
    D, qdd = robot.zeros(robot.n, robot.n), robot.zeros(robot.n)
    pivots, pivot_margins = robot.zeros(robot.n), robot.zeros(robot.n)
    try:
        recursive.forward_dynamics_of_state(
            robot.structure,
            robot.numbers,
            q,
            qd,
            tau,
            robot.zeros(robot.n),
            robot.workspace,
            D,
            pivots,
            pivot_margins,
            qdd,
        )
    except ZeroDivisionError:
        # A pivot is zero in every state: `positive` marks the result as invalid.
        qdd, pivot_margins = robot.zeros(robot.n), robot.zeros(1)
    return Quantity(
        'forward_dynamics',
        robot.n,
        ('q', 'qd', 'tau'),
        robot.program,
        (qdd,),
        tuple(pivot_margins),
    )


ALL = (gravity_torque, dynamics, inverse_dynamics, mass_matrix, forward_dynamics, coriolis_matrix)

# Name of the quantity → names of its arguments, number of outputs.
SIGNATURES = {
    'gravity_torque': (('q',), 1),
    'dynamics': (('q', 'qd'), 3),
    'inverse_dynamics': (('q', 'qd', 'qdd'), 1),
    'mass_matrix': (('q',), 1),
    'forward_dynamics': (('q', 'qd', 'tau'), 1),
    'coriolis_matrix': (('q', 'qd'), 1),
}
