"""What hypothesis draws in place of every single place and value."""

from hypothesis import strategies as st

# Bytes, because of numbers hypothesis prefers the small ones, and would draw the same again.
_SEED = st.binary(min_size=8, max_size=8)
SIBLINGS = 4


def seeds(most):
    """Return a strategy of one to `most` seeds, one for each step of making an input."""
    return st.lists(_SEED, min_size=1, max_size=most)


def siblings(drawn):
    """
    Return several lists of seeds that differ in the last one.

    To draw once more takes hypothesis longer than it takes to look at an input.

    """
    return [[*drawn[:-1], drawn[-1] + bytes([i])] for i in range(SIBLINGS)]
