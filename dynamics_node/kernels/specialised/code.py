"""Straight-line programs as LLVM code, one state or several lanes of states at a time."""

import struct

from .sine import sine_and_cosine
from .symbols import Symbol

_ARITHMETIC = {'add': 'fadd', 'subtract': 'fsub', 'multiply': 'fmul', 'divide': 'fdiv'}


class Code:
    """
    Lines of LLVM code on numbers of one width.

    Attributes
    ----------
    lines : list of str
    lanes : int
        How many states one value holds.
    number, integer, truth : str
        LLVM's names of the types.

    """

    def __init__(self, lanes=1):
        """Begin with nothing."""
        self.lines = []
        self.lanes = lanes
        self.number, self.integer, self.truth = (
            kind if lanes == 1 else f'<{lanes} x {kind}>' for kind in ('double', 'i64', 'i1')
        )
        self._count = 0

    def line(self, text):
        """Append a line that makes a value and return the value's name."""
        self._count += 1
        self.lines.append(f'  %v{self._count} = {text}')
        return f'%v{self._count}'

    def do(self, text):
        """Append a line that makes no value."""
        self.lines.append(f'  {text}')

    def constant(self, value):
        """Return a number as LLVM writes it: the 64 bits in hexadecimal digits."""
        digits = f'0x{struct.pack(">d", value).hex().upper()}'
        return digits if self.lanes == 1 else self._repeated(f'double {digits}')

    def integer_constant(self, value):
        """Return an integer as LLVM writes it."""
        return str(value) if self.lanes == 1 else self._repeated(f'i64 {value}')

    def _repeated(self, text):
        return '<' + ', '.join([text] * self.lanes) + '>'

    def fma(self, a, b, c):
        """Append a b + c, rounded once."""
        kind = 'f64' if self.lanes == 1 else f'v{self.lanes}f64'
        arguments = ', '.join(f'{self.number} {x}' for x in (a, b, c))
        return self.line(f'call {self.number} @llvm.fma.{kind}({arguments})')

    def address(self, pointer, index):
        """Append the address of a double behind a pointer."""
        return self.line(f'getelementptr double, ptr {pointer}, i64 {index}')


def declarations(lanes):
    """Return what LLVM must know before code of some width."""
    kinds = {'f64': 'double'}
    if lanes > 1:
        kinds[f'v{lanes}f64'] = f'<{lanes} x double>'
    return [
        f'declare {kind} @llvm.fma.{name}({kind}, {kind}, {kind})' for name, kind in kinds.items()
    ]


def append_program(code, quantity, values):
    """
    Append a quantity's program.

    Parameters
    ----------
    code : Code
    quantity : Quantity
    values : callable (name, index) -> str
        Appends the load of an input and returns its name.

    Returns
    -------
    callable (Symbol or float) -> str
        The name of a result.

    """
    program = quantity.program
    names: dict[int, str] = {}
    angles: dict[int, tuple[str, str]] = {}

    def name(value):
        return names[value.index] if isinstance(value, Symbol) else code.constant(value)

    for index in program.needed(quantity.results()):
        operation, arguments = program.operations[index]
        if operation == 'input':
            names[index] = values(*arguments)
        elif operation in ('sin', 'cos'):
            angle = arguments[0]
            if angle.index not in angles:
                angles[angle.index] = sine_and_cosine(code, name(angle))
            names[index] = angles[angle.index][operation == 'cos']
        elif operation == 'negate':
            names[index] = code.line(f'fneg {code.number} {name(arguments[0])}')
        else:
            # 'contract': a multiplication and an addition may be fused, which rounds once less.
            left, right = map(name, arguments)
            names[index] = code.line(
                f'{_ARITHMETIC[operation]} contract {code.number} {left}, {right}'
            )
    return name
