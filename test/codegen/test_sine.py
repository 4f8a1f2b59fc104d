"""Sine and cosine on all lanes: right to the last place."""

import ctypes

from dynamics_node.codegen import llvm_target
from dynamics_node.codegen.llvm_ir import Code, declarations
from dynamics_node.codegen.sine import LARGEST_ANGLE, sine_and_cosine
import numpy as np
import pytest

LANES = sorted({1, 2, llvm_target.lanes()})


def compiled(lanes):
    code = Code(lanes)
    x = code.line(f'load {code.number}, ptr %x, align 8')
    for value, pointer in zip(sine_and_cosine(code, x), ('%sin', '%cos'), strict=True):
        code.do(f'store {code.number} {value}, ptr {pointer}, align 8')
    text = '\n'.join(
        [
            *declarations(lanes),
            'define void @f(ptr %x, ptr %sin, ptr %cos) {',
            *code.lines,
            '  ret void',
            '}',
        ]
    )
    addresses = llvm_target.load([llvm_target.compile_code(text)], ['f'])
    function = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 3)(addresses['f'])

    def sine_cosine(x):
        sine, cosine = np.empty_like(x), np.empty_like(x)
        for i in range(0, x.size, lanes):
            function(*(array[i:].ctypes.data for array in (x, sine, cosine)))
        return sine, cosine

    return sine_cosine


@pytest.fixture(scope='module', params=LANES)
def sine_cosine(request):
    return compiled(request.param)


def places_off(actual, x, function):
    # The truth in 80-bit arithmetic; a place is the distance to the next double.
    truth = function(x.astype(np.longdouble))
    return np.abs(actual - truth) / np.spacing(np.abs(truth).astype(float))


@pytest.mark.parametrize('size', [0.5, 4.0, 100.0, LARGEST_ANGLE])
def test_within_one_place_of_the_truth(sine_cosine, size):
    x = np.random.default_rng(1).uniform(-size, size, 40_000)
    sine, cosine = sine_cosine(x)
    assert places_off(sine, x, np.sin).max() <= 1.0
    assert places_off(cosine, x, np.cos).max() <= 1.0


def test_within_one_place_next_to_multiples_of_a_right_angle(sine_cosine):
    exact = np.arange(-4000, 4000) * (np.pi / 2)
    x = np.concatenate([exact, np.nextafter(exact, np.inf), np.nextafter(exact, -np.inf)])
    sine, cosine = sine_cosine(x)
    assert places_off(sine, x, np.sin).max() <= 1.0
    assert places_off(cosine, x, np.cos).max() <= 1.0


def test_zero_and_tiny_angles_are_exact(sine_cosine):
    x = np.array([0.0, 1e-300, -1e-20, 5e-324, 0.0, 0.0, 0.0, 0.0])
    sine, cosine = sine_cosine(x)
    np.testing.assert_array_equal(sine, x)
    np.testing.assert_array_equal(cosine, np.ones(8))
