"""Numbers and names as findings say them."""

import math


def listed(shown, count):
    """Return texts in a row, and how many of `count` are not among them."""
    if count > len(shown):
        return f'{", ".join(shown)} and {count - len(shown)} more'
    if len(shown) > 1:
        return f'{", ".join(shown[:-1])} and {shown[-1]}'
    return ''.join(shown)


def names(values, most=5):
    """Return names in quotes, the first of many."""
    values = list(values)
    return listed([f"'{value}'" for value in values[:most]], len(values))


def number(value):
    """Return a number with three digits."""
    if value == 0.0:
        return '0'
    if 1e-3 <= abs(value) < 1e5:
        digits = max(0, 2 - math.floor(math.log10(abs(value))))
        text = f'{value:.{digits}f}'
        return text.rstrip('0').rstrip('.') if '.' in text else text
    return f'{value:.3g}'


def kilograms(mass):
    """Return a mass with the unit people use for it."""
    if 0.0 < abs(mass) < 0.1:
        return f'{number(mass * 1000.0)} g'
    return f'{number(mass)} kg'


def percent(share):
    """Return a share in percent."""
    if share < 1e-4:
        return 'less than 0.01 %'
    return f'{number(100.0 * share)} %' if share < 10.0 else f'{number(share)} times'


def factor(value):
    """Return a ratio as people say it."""
    return f'{number(value)} times'
