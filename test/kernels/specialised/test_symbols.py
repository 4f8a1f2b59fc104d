"""Symbols write down what has to be computed, and nothing else."""

import math

from dynamics_node.kernels.specialised.symbols import Program, ProgramTooLongError, Symbol
import numpy as np
import pytest
from support.interpreter import run


@pytest.fixture
def program():
    return Program(1000)


@pytest.fixture
def x(program):
    return program.input('x', 0)


@pytest.fixture
def y(program):
    return program.input('x', 1)


def test_zeros_and_ones_leave_no_operation(program, x):
    before = len(program.operations)
    assert x * 0.0 == 0.0
    assert x * 1.0 is x
    assert 1.0 * x is x
    assert x + 0.0 is x
    assert 0.0 + x is x
    assert x - 0.0 is x
    assert x - x == 0.0
    assert len(program.operations) == before


def test_what_occurs_twice_is_done_once(program, x, y):
    first = x * y + 2.0
    count = len(program.operations)
    assert y * x + 2.0 is first
    assert len(program.operations) == count


def test_zero_and_minus_zero_are_two_numbers(program, x):
    assert 0.0 - x is -x
    assert program.record('add', x, 0.0) is not program.record('add', x, -0.0)


def test_signs_go_into_sums_and_out_of_products(program, x, y):
    negative = -x
    assert -negative is x
    assert x + -y is x - y
    assert x - -y is x + y
    assert -x * -y is x * y
    assert -1.0 * x is -x


def test_operations_are_those_of_floats(program, x, y):
    a, b = 0.7, -1.9
    results = [x + y, x - y, x * y, x / y, -x, np.sin(x), np.cos(y), 1.0 / x, 3.0 - x, 2.5 * y]
    assert run(program, results, x=[a, b]) == [
        a + b,
        a - b,
        a * b,
        a / b,
        -a,
        math.sin(a),
        math.cos(b),
        1.0 / a,
        3.0 - a,
        2.5 * b,
    ]


def test_numpys_numbers_hand_over(x):
    for result in (np.float64(2.0) * x, np.float64(2.0) + x, np.float64(2.0) - x):
        assert isinstance(result, Symbol)


def test_only_what_is_needed_comes_and_in_order(program, x, y):
    wanted = (x + y) * x
    np.sin(y)
    order = program.needed([wanted, 3.0])
    assert len(order) == 4
    for place, index in enumerate(order):
        for argument in program.operations[index].arguments:
            if isinstance(argument, Symbol):
                assert argument.index in order[:place]


def test_a_program_that_is_too_long_stops():
    program = Program(10)
    x = program.input('x', 0)
    for _ in range(9):
        x = np.sin(x)
    with pytest.raises(ProgramTooLongError):
        np.sin(x)
