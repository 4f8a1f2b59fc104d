"""Seeds: drawn by hypothesis in place of every single place and value."""

from hypothesis import strategies as st

# Bytes: of numbers, hypothesis prefers small ones, and would repeat them.
_SEED = st.binary(min_size=8, max_size=8)
SIBLINGS = 4


def seeds(most):
    """Return a strategy of one to `most` seeds, one for each change."""
    return st.lists(_SEED, min_size=1, max_size=most)


def siblings(drawn):
    """
    Return several lists of seeds that differ in the last one.

    Hypothesis takes longer to draw a list than a target to process an input.

    """
    return [[*drawn[:-1], drawn[-1] + bytes([i])] for i in range(SIBLINGS)]
