"""
Sine and cosine as straight-line LLVM code, of one angle per lane.

The reduction to [-pi/4, pi/4] subtracts pi/2 in three parts (Cody and Waite) by fused
multiplications and additions, and keeps the rounding error; the polynomials are those of fdlibm.
For angles up to `LARGEST_ANGLE` both are within one unit in the last place.

"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .llvm_ir import Code

# Largest position that the machine code covers, rad or m: larger ones go to the general kernel.
LARGEST_ANGLE = 1e5

# pi/2 as the sum of three doubles.
_PI_HALF = (1.5707963267948966, 6.123233995736766e-17, -1.4973849048591833e-33)
_TWO_OVER_PI = 0.6366197723675814
# 1.5 * 2**52: adding and subtracting it rounds to an integer and leaves that in the last bits.
_ROUNDER = 6755399441055744.0
# Coefficients of r³, r⁵... in the sine.
_SIN = (
    -1.66666666666666324348e-01,
    8.33333333332248946124e-03,
    -1.98412698298579493134e-04,
    2.75573137070700676789e-06,
    -2.50507602534068634195e-08,
    1.58969099521155010221e-10,
)
# Coefficients of r⁴, r⁶... in the cosine.
_COS = (
    4.16666666666666019037e-02,
    -1.38888888888741095749e-03,
    2.48015872894767294178e-05,
    -2.75573143513906633035e-07,
    2.08757232129817482790e-09,
    -1.13596475577881948265e-11,
)


def sine_and_cosine(code: Code, x: str) -> tuple[str, str]:
    """
    Append the sine and the cosine of a value.

    Parameters
    ----------
    code : Code
    x : str
        Name of the value, rad.

    Returns
    -------
    tuple of str
        Names of sine and cosine.

    """
    marked = code.fma(x, code.constant(_TWO_OVER_PI), code.constant(_ROUNDER))
    quadrant = code.line(f'bitcast {code.number} {marked} to {code.integer}')
    turns = code.line(f'fsub {code.number} {marked}, {code.constant(_ROUNDER)}')
    r, low = _reduced(code, x, turns)
    z = code.line(f'fmul {code.number} {r}, {r}')
    half = code.line(f'fmul {code.number} {z}, {code.constant(0.5)}')
    sine = _sine(code, r, low, z, half)
    cosine = _cosine(code, r, low, z, half)

    # Odd quadrants swap the two; the second bit of the quadrant (of the next one for the
    # cosine) is the sign.
    odd = code.line(f'and {code.integer} {quadrant}, {code.integer_constant(1)}')
    swapped = code.line(f'icmp ne {code.integer} {odd}, {code.integer_constant(0)}')
    after = code.line(f'add {code.integer} {quadrant}, {code.integer_constant(1)}')
    return (
        _signed(code, _select(code, swapped, cosine, sine), quadrant),
        _signed(code, _select(code, swapped, sine, cosine), after),
    )


def _reduced(code: Code, x: str, turns: str) -> tuple[str, str]:
    # x - turns pi/2 as r + low: r right to the last place, low its rounding error.
    first, second, third = map(code.constant, _PI_HALF)
    back = code.line(f'fneg {code.number} {turns}')
    rough = code.fma(back, first, x)  # exact: all but few leading bits cancel
    step = code.line(f'fmul {code.number} {turns}, {second}')
    less = code.line(f'fneg {code.number} {step}')
    lost_in_step = code.fma(turns, second, less)
    # r = rough - step and its rounding error (Knuth), for either order of size.
    r = code.line(f'fsub {code.number} {rough}, {step}')
    taken = code.line(f'fsub {code.number} {r}, {rough}')
    left = code.line(f'fsub {code.number} {r}, {taken}')
    left = code.line(f'fsub {code.number} {rough}, {left}')
    right = code.line(f'fadd {code.number} {step}, {taken}')
    lost = code.line(f'fsub {code.number} {left}, {right}')
    lost = code.line(f'fsub {code.number} {lost}, {lost_in_step}')
    return r, code.fma(back, third, lost)


def _sine(code: Code, r: str, low: str, z: str, half: str) -> str:
    # sin(r + low) = r + (r³ P(r²) + low (1 - r²/2))
    cube = code.line(f'fmul {code.number} {z}, {r}')
    lost = code.line(f'fneg {code.number} {half}')
    small = code.fma(cube, _polynomial(code, _SIN, z), code.fma(lost, low, low))
    return code.line(f'fadd {code.number} {r}, {small}')


def _cosine(code: Code, r: str, low: str, z: str, half: str) -> str:
    # cos(r + low) = 1 - z/2 + (z² P(z) - r low), z = r², with the rounding error of 1 - z/2.
    one = code.constant(1.0)
    first = code.line(f'fsub {code.number} {one}, {half}')
    lost = code.line(f'fsub {code.number} {one}, {first}')
    lost = code.line(f'fsub {code.number} {lost}, {half}')
    square = code.line(f'fmul {code.number} {z}, {z}')
    back = code.line(f'fneg {code.number} {r}')
    small = code.fma(square, _polynomial(code, _COS, z), code.fma(back, low, lost))
    return code.line(f'fadd {code.number} {first}, {small}')


def _polynomial(code: Code, coefficients: tuple[float, ...], z: str) -> str:
    value = code.constant(coefficients[-1])
    for coefficient in coefficients[-2::-1]:
        value = code.fma(value, z, code.constant(coefficient))
    return value


def _select(code: Code, condition: str, yes: str, no: str) -> str:
    return code.line(f'select {code.truth} {condition}, {code.number} {yes}, {code.number} {no}')


def _signed(code: Code, value: str, quadrant: str) -> str:
    # Flip the sign where the second last bit of the quadrant is set.
    bit = code.line(f'and {code.integer} {quadrant}, {code.integer_constant(2)}')
    sign = code.line(f'shl {code.integer} {bit}, {code.integer_constant(62)}')
    bits = code.line(f'bitcast {code.number} {value} to {code.integer}')
    flipped = code.line(f'xor {code.integer} {bits}, {sign}')
    return code.line(f'bitcast {code.integer} {flipped} to {code.number}')
