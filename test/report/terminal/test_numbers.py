"""Numbers in the tables."""

import math

from dynamics_node.report.formatting import fixed, fixed_vector, short, short_vector


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
