"""The exception tree, and untrusted texts in messages."""

import dynamics_node
from dynamics_node import errors
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


def test_every_exception_is_in_one_tree():
    classes = [
        value
        for value in vars(errors).values()
        if isinstance(value, type) and issubclass(value, Exception)
    ]
    assert len(classes) == 8
    assert all(issubclass(each, dynamics_node.DynamicsError) for each in classes)
    assert issubclass(errors.ParameterError, ValueError)
