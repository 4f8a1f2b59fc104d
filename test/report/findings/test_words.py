"""Numbers and names as findings say them."""

from dynamics_node.report.formatting import (
    enumeration,
    kilograms,
    plain_number,
    plain_percent,
    quoted_names,
)
import pytest


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
