"""Numbers and names as text: on the page, in findings and in the terminal."""

import math

from dynamics_node.report.formatting import (
    count,
    enumeration,
    fixed,
    fixed_vector,
    kilograms,
    number,
    percent,
    plain_number,
    plain_percent,
    position,
    quantity,
    quoted_names,
    short,
    short_vector,
    vector,
)
from hypothesis import given
from hypothesis import strategies as st
import pytest

_RAISED = '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'


@pytest.mark.parametrize(
    'value, shown',
    [
        (0.0, '0'),
        (-0.0, '0'),
        (1.0, '1'),
        (44.763, '44.76'),
        (-44.763, '−44.76'),
        (1235.5, '1236'),
        (99990.0, '99990'),
        (123456.0, '1.235·10⁵'),
        (0.001, '0.001'),
        (0.00012, '1.2·10⁻⁴'),
        (1e-6, '10⁻⁶'),
        (-1e-6, '−10⁻⁶'),
        (9.9999, '10'),
        (0.00099999, '0.001'),
        (math.inf, '∞'),
        (-math.inf, '−∞'),
        (math.nan, '–'),
        (None, '–'),
    ],
)
def test_a_number_is_written_as_people_do(value, shown):
    assert number(value) == shown


def read(shown):
    """Return the number that a reader sees."""
    plain = shown.replace('−', '-')
    raised = ''.join(sign for sign in plain if sign in _RAISED)
    if not raised:
        return float(plain)
    mantissa = plain.removesuffix(f'10{raised}').rstrip('·')
    mantissa = f'{mantissa}1' if mantissa in ('', '-') else mantissa
    return float(f'{mantissa}e{raised.translate(str.maketrans(_RAISED, "-0123456789"))}')


@given(st.floats(min_value=-1e300, max_value=1e300), st.integers(2, 6))
def test_what_is_read_is_what_it_was_to_the_last_digit(value, digits):
    assert read(number(value, digits)) == pytest.approx(
        value, rel=0.5001 * 10.0 ** (1 - digits), abs=1e-305
    )


@pytest.mark.parametrize(
    'share, shown',
    [
        (0.0, '0 %'),
        (0.4973, '50 %'),
        (0.0231, '2.3 %'),
        (1.0, '100 %'),
        (0.996, '99.6 %'),
        (1.004, '100.4 %'),
        (0.99999, '100 %'),
        (3.32, '332 %'),
        (math.nan, '–'),
        (math.inf, '∞ %'),
    ],
)
def test_a_share_near_the_limit_says_on_which_side_it_is(share, shown):
    assert percent(share).replace('\u00a0', ' ') == shown


def test_positions_have_their_unit():
    assert position(math.pi / 2, False) == '90°'
    assert position(-1.0, False) == '−57.3°'
    assert position(0.04, True) == '0.04\u00a0m'
    assert position(1e-9, False) == '0°'
    assert position(math.inf, False) == '∞°'


def test_words_with_numbers():
    assert quantity(12.0, 'N m') == '12\u00a0N\u00a0m'
    assert vector((0.0, -1.0, 0.25)) == '0, −1, 0.25'
    assert vector(None) == '–'
    assert count(1, 'joint') == '1 joint' and count(3, 'joint') == '3 joints'
    assert count(2, 'body', 'bodies') == '2 bodies'


@pytest.mark.parametrize(
    'value, text',
    [
        (0.0, '0'),
        (7.0, '7'),
        (0.12345, '0.123'),
        (123.456, '123'),
        (99999.0, '99999'),
        (1e-5, '1e-05'),
        (-2.5, '-2.5'),
        (1e6, '1e+06'),
        (300.0, '300'),
    ],
)
def test_numbers_have_three_digits(value, text):
    assert plain_number(value) == text


def test_masses_and_shares_have_their_units():
    assert [kilograms(mass) for mass in (0.007, 0.1, 2.0, 0.0)] == [
        '7 g',
        '0.1 kg',
        '2 kg',
        '0 kg',
    ]
    assert [plain_percent(share) for share in (0.5, 2.0, 30.0, 1e-6)] == [
        '50 %',
        '200 %',
        '30 times',
        'less than 0.01 %',
    ]


def test_many_names_are_counted():
    assert quoted_names(['a']) == "'a'" and quoted_names('ab') == "'a' and 'b'"
    assert quoted_names('abcdefg') == "'a', 'b', 'c', 'd', 'e' and 2 more"
    assert enumeration([], 0) == ''


def test_three_digits():
    assert [short(value) for value in (0.0, 12.345, 0.00123, 1e-7, 1e6, -3.0)] == [
        '0',
        '12.3',
        '0.00123',
        '1.0e-07',
        '1.0e+06',
        '-3',
    ]
    assert [short(value) for value in (math.nan, None, math.inf, -math.inf)] == [
        '-',
        '-',
        '∞',
        '-∞',
    ]


def test_rows_and_rounded_zeros():
    assert fixed(-1e-9) == '0.000' and fixed_vector((0.1, -0.25, -1e-12)) == '0.100 -0.250 0.000'
    assert fixed_vector(None) == '-' and short_vector((1.0, 2.5e-5)) == '1 2.5e-05'
