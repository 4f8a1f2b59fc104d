"""Texts of other programs, as quoted in error messages."""

from dynamics_node.errors import quoted
import pytest


@pytest.mark.parametrize(
    'text, shown',
    [
        ('elbow', "'elbow'"),
        ('', "''"),
        (None, "'None'"),
        ('a\n[FATAL] b\x1b[31m', r"'a\n[FATAL] b\x1b[31m'"),
        ('Gelenk größer', "'Gelenk größer'"),
        ('x' * 60, "'" + 'x' * 60 + "'"),
        ('x' * 61, "'" + 'x' * 57 + "...'"),
    ],
)
def test_a_text_is_short_in_quotes_and_on_one_line(text, shown):
    assert quoted(text) == shown
