"""
Numbers that write down what is done to them.

The formulas of `closed_form`, run on these instead of floats, leave a straight-line program for
one robot: what is known beforehand is computed, what is zero is gone, what occurs twice is done
once. No sum is reordered, so the results differ from the interpreted ones by rounding at most.

"""

import math
from typing import Any, NamedTuple


class ProgramTooLongError(Exception):
    """A program has grown beyond its limit."""


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
    A straight-line program that grows while symbols are calculated with.

    Attributes
    ----------
    operations : list of Operation
        In the order in which they can be run.

    """

    def __init__(self, limit):
        """
        Begin with nothing.

        Parameters
        ----------
        limit : int
            Most operations.

        """
        self.limit = limit
        self.operations = []
        self._known = {}

    def input(self, name, index):
        """
        Return the symbol of one number that is known only when the program runs.

        Parameters
        ----------
        name : str
            Of the array.
        index : int
            In that array.

        Returns
        -------
        Symbol

        """
        return self.record('input', name, index)

    def record(self, name, *arguments):
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
        key = (name, *map(_identity, arguments))
        if name in ('add', 'multiply'):
            key = (name, *sorted(key[1:], key=repr))
        if key not in self._known:
            self._known[key] = Symbol(self, len(self.operations))
            self.operations.append(Operation(name, arguments))
            if len(self.operations) > self.limit:
                raise ProgramTooLongError
        return self._known[key]

    def needed(self, results):
        """
        Return which operations some results need, in an order in which they can be run.

        Each result is finished before the next one is begun, so few numbers have to be kept at
        a time, and the processor finds most of them in its registers.

        Parameters
        ----------
        results : sequence
            Symbols and floats.

        Returns
        -------
        list of int
            Indices into `operations`.

        """
        order, found, waiting = [], set(), list(reversed(results))
        while waiting:
            item = waiting.pop()
            if isinstance(item, int):
                order.append(item)
            elif isinstance(item, Symbol) and item.index not in found:
                found.add(item.index)
                # First what it is made of, then itself: its bare index comes up again.
                waiting.append(item.index)
                waiting += [
                    argument
                    for argument in reversed(self.operations[item.index].arguments)
                    if isinstance(argument, Symbol)
                ]
        return order


class Symbol:
    """
    A number that a program knows only when it runs.

    Attributes
    ----------
    program : Program
    index : int
        Of the operation that makes it.

    """

    __slots__ = ('index', 'program')

    def __init__(self, program, index):
        """Belong to one operation of a program."""
        self.program = program
        self.index = index

    @property
    def _negated(self):
        # What this is the negative of, or None.
        operation = self.program.operations[self.index]
        return operation.arguments[0] if operation.name == 'negate' else None

    def __add__(self, other):
        if not isinstance(other, Symbol):
            return self if other == 0 else self.program.record('add', self, float(other))
        if other._negated is not None:
            return self - other._negated
        return self.program.record('add', self, other)

    __radd__ = __add__

    def __sub__(self, other):
        if not isinstance(other, Symbol):
            return self if other == 0 else self.program.record('subtract', self, float(other))
        if other is self:
            return 0.0
        if other._negated is not None:
            return self + other._negated
        return self.program.record('subtract', self, other)

    def __rsub__(self, other):
        return -self if other == 0 else self.program.record('subtract', float(other), self)

    def __mul__(self, other):
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

    def __truediv__(self, other):
        return self.program.record('divide', self, other)

    def __rtruediv__(self, other):
        return 0.0 if other == 0 else self.program.record('divide', float(other), self)

    def __neg__(self):
        if self._negated is not None:
            return self._negated
        return self.program.record('negate', self)

    def sin(self):
        """Record the sine; `numpy.sin` calls this."""
        return self.program.record('sin', self)

    def cos(self):
        """Record the cosine; `numpy.cos` calls this."""
        return self.program.record('cos', self)


def _identity(argument):
    # Symbols by number; 0.0 and -0.0, which are equal, are two.
    if isinstance(argument, Symbol):
        return 'symbol', argument.index
    return (argument, math.copysign(1.0, argument)) if isinstance(argument, float) else argument
