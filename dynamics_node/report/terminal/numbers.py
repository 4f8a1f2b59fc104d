"""Numbers in the tables of the terminal."""

import math


def fixed(value, digits=3):
    """Return a number with so many decimals, without the sign of a rounded zero."""
    return f'{round(value, digits) + 0.0:.{digits}f}'


def short(value):
    """Return a number with three digits; '-' for none."""
    if value is None or math.isnan(value):
        return '-'
    if math.isinf(value):
        return '∞' if value > 0.0 else '-∞'
    if value == 0.0:
        return '0'
    return f'{value:.3g}' if 1e-3 <= abs(value) < 1e5 else f'{value:.1e}'


def vector(values, digits=3):
    """Return numbers in a row."""
    return '-' if values is None else ' '.join(fixed(value, digits) for value in values)


def shorts(values):
    """Return numbers in a row, with three digits each."""
    return '-' if values is None else ' '.join(short(value) for value in values)
