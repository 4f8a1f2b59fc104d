"""Straight-line programs as LLVM code, for one state or for one state per lane."""

from collections.abc import Callable, Sequence
import struct

from .sine import sine_and_cosine
from .trace import Quantity, Symbol

_ARITHMETIC = {'add': 'fadd', 'subtract': 'fsub', 'multiply': 'fmul', 'divide': 'fdiv'}


class Code:
    """
    Lines of LLVM code on numbers of one width.

    Attributes
    ----------
    lines : list of str
    lanes : int
        Number of states that one value holds.
    number, integer, truth : str
        LLVM's names of the types.

    """

    def __init__(self, lanes: int = 1):
        self.lines: list[str] = []
        self.lanes = lanes
        self.number, self.integer, self.truth = (
            kind if lanes == 1 else f'<{lanes} x {kind}>' for kind in ('double', 'i64', 'i1')
        )
        self._count = 0

    def line(self, text: str) -> str:
        """Append an instruction with a result, and return the name of the result."""
        self._count += 1
        self.lines.append(f'  %v{self._count} = {text}')
        return f'%v{self._count}'

    def do(self, text: str) -> None:
        """Append an instruction without a result."""
        self.lines.append(f'  {text}')

    def constant(self, value: float) -> str:
        """Return a number in LLVM's notation: the 64 bits in hexadecimal digits."""
        digits = f'0x{struct.pack(">d", value).hex().upper()}'
        return digits if self.lanes == 1 else self._repeated(f'double {digits}')

    def integer_constant(self, value: int) -> str:
        """Return an integer in LLVM's notation."""
        return str(value) if self.lanes == 1 else self._repeated(f'i64 {value}')

    def _repeated(self, text: str) -> str:
        return '<' + ', '.join([text] * self.lanes) + '>'

    def fma(self, a: str, b: str, c: str) -> str:
        """Append a b + c, rounded once."""
        kind = 'f64' if self.lanes == 1 else f'v{self.lanes}f64'
        arguments = ', '.join(f'{self.number} {x}' for x in (a, b, c))
        return self.line(f'call {self.number} @llvm.fma.{kind}({arguments})')

    def address(self, pointer: str, index: int | str) -> str:
        """Append the address of the double at an index behind a pointer."""
        return self.line(f'getelementptr double, ptr {pointer}, i64 {index}')


def declarations(lanes: int) -> list[str]:
    """Return the declarations of external functions that code of some width calls."""
    kinds = {'f64': 'double'}
    if lanes > 1:
        kinds[f'v{lanes}f64'] = f'<{lanes} x double>'
    return [
        f'declare {kind} @llvm.fma.{name}({kind}, {kind}, {kind})' for name, kind in kinds.items()
    ]


def append_program(
    code: Code, quantity: Quantity, values: Callable[[str, int], str]
) -> Callable[[Symbol | float], str]:
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

    def name(value: Symbol | float) -> str:
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
            # 'contract' lets LLVM fuse a multiplication and an addition: one rounding less.
            left, right = map(name, arguments)
            names[index] = code.line(
                f'{_ARITHMETIC[operation]} contract {code.number} {left}, {right}'
            )
    return name


def state_function(quantity: Quantity) -> str:
    """
    Return the LLVM function of one state.

    It returns false if a number that must be positive is not; then the outputs are invalid.

    Parameters
    ----------
    quantity : Quantity

    Returns
    -------
    str

    """
    code = Code()

    def load(name: str, index: int) -> str:
        return code.line(f'load double, ptr {code.address("%" + name, index)}')

    name = append_program(code, quantity, load)
    for place, output in enumerate(quantity.outputs):
        for index, value in enumerate(output.flat):
            code.do(f'store double {name(value)}, ptr {code.address(f"%out{place}", index)}')
    is_valid = 'true'
    for value in quantity.positive:
        positive = code.line(f'fcmp ogt double {name(value)}, {code.constant(0.0)}')
        is_valid = code.line(f'and i1 {is_valid}, {positive}')
    code.do(f'ret i1 {is_valid}')
    return _function('i1', quantity.name, _pointers(quantity), code.lines)


def batch_function(quantity: Quantity, lanes: int) -> str:
    """
    Return the LLVM function of many states.

    `lanes` states at a time. The last block overlaps the one before if B is no multiple of
    `lanes`.

    Parameters
    ----------
    quantity : Quantity
        Without numbers that must be positive.
    lanes : int
        2, 4 or 8.

    Returns
    -------
    str

    """
    code = Code(lanes)
    n = quantity.joint_count
    # The robot's numbers are the same for all states. Gravity alone is read once, before the loop;
    # inertia has too many numbers to keep in registers, and compiling would take ten times as
    # long.
    places = _places(quantity)
    kept = {place: _number(code, place) for place in places} if len(places) <= 3 else {}
    code.do('%last = sub i64 %count, ' + str(lanes))
    code.do('br label %loop')
    code.lines.append('loop:')
    code.do('%begin = phi i64 [0, %entry], [%next, %loop]')
    code.do('%beyond = icmp ugt i64 %begin, %last')
    code.do('%state = select i1 %beyond, i64 %last, i64 %begin')
    rows = {name: _row(code, f'%{name}', n) for name in quantity.inputs}

    def load(name: str, index: int) -> str:
        if name == 'numbers':
            return kept[index] if kept else _number(code, index)
        return _gather(code, rows[name], n, index)

    name = append_program(code, quantity, load)
    for place, output in enumerate(quantity.outputs):
        row = _row(code, f'%out{place}', output.size)
        _scatter(code, row, [name(value) for value in output.flat])
    code.do(f'%next = add i64 %begin, {lanes}')
    code.do('%more = icmp ult i64 %next, %count')
    code.do('br i1 %more, label %loop, label %done')
    code.lines.append('done:')
    code.do('ret void')
    return _function(
        'void', f'{quantity.name}_batch', [*_pointers(quantity), 'i64 %count'], code.lines
    )


def _places(quantity: Quantity) -> list[int]:
    # Indices of the robot's numbers that the program reads.
    operations = quantity.program.operations
    needed = (operations[index] for index in quantity.program.needed(quantity.results()))
    return sorted(
        operation.arguments[1]
        for operation in needed
        if operation.name == 'input' and operation.arguments[0] == 'numbers'
    )


def _number(code: Code, place: int) -> str:
    return _splat(code, code.line(f'load double, ptr {code.address("%numbers", place)}'))


def _pointers(quantity: Quantity) -> list[str]:
    names = [*quantity.inputs, 'numbers', *(f'out{i}' for i in range(len(quantity.outputs)))]
    return [f'ptr %{name}' for name in names]


def _function(kind: str, name: str, arguments: Sequence[str], lines: Sequence[str]) -> str:
    return '\n'.join([f'define {kind} @{name}({", ".join(arguments)}) {{', 'entry:', *lines, '}'])


def _row(code: Code, pointer: str, width: int) -> str:
    # The address of this block's first state.
    offset = code.line(f'mul i64 %state, {width}')
    return code.address(pointer, offset)


def _splat(code: Code, scalar: str) -> str:
    # The same number in every lane.
    first = code.line(f'insertelement {code.number} poison, double {scalar}, i32 0')
    return code.line(
        f'shufflevector {code.number} {first}, {code.number} poison, '
        f'<{code.lanes} x i32> zeroinitializer'
    )


def _gather(code: Code, row: str, width: int, index: int) -> str:
    # Number `index` of the state in each lane.
    value = 'poison'
    for lane in range(code.lanes):
        scalar = code.line(f'load double, ptr {code.address(row, lane * width + index)}')
        value = code.line(f'insertelement {code.number} {value}, double {scalar}, i32 {lane}')
    return value


def _scatter(code: Code, row: str, values: Sequence[str]) -> None:
    # Store the numbers of each state side by side: squares of lanes x lanes numbers are
    # transposed and stored by rows. The last square overlaps the one before.
    width, lanes = len(values), code.lanes
    if width < lanes:
        for index, value in enumerate(values):
            for lane in range(lanes):
                scalar = code.line(f'extractelement {code.number} {value}, i32 {lane}')
                address = code.address(row, lane * width + index)
                code.do(f'store double {scalar}, ptr {address}, align 8')
        return
    for first in [*range(0, width - lanes, lanes), width - lanes]:
        square = _transposed(code, values[first : first + lanes])
        for lane, numbers in enumerate(square):
            address = code.address(row, lane * width + first)
            code.do(f'store {code.number} {numbers}, ptr {address}, align 8')


def _transposed(code: Code, square: Sequence[str]) -> list[str]:
    # Exchange blocks of 1, 2, 4... numbers across the diagonal.
    lanes, square = code.lanes, list(square)
    step = 1
    while step < lanes:
        for i in range(lanes):
            if not i & step:
                upper, lower = square[i], square[i + step]
                square[i] = _shuffle(
                    code,
                    upper,
                    lower,
                    [k if not k & step else lanes + k - step for k in range(lanes)],
                )
                square[i + step] = _shuffle(
                    code,
                    upper,
                    lower,
                    [k + step if not k & step else lanes + k for k in range(lanes)],
                )
        step *= 2
    return square


def _shuffle(code: Code, a: str, b: str, mask: Sequence[int]) -> str:
    places = ', '.join(f'i32 {k}' for k in mask)
    return code.line(
        f'shufflevector {code.number} {a}, {code.number} {b}, <{code.lanes} x i32> <{places}>'
    )
