"""Text of numbers: three digits, a fitting unit, the spread in brackets."""

_UNITS = ((1.0, 's'), (1e-3, 'ms'), (1e-6, 'µs'), (1e-9, 'ns'))


def digits(value):
    """
    Return a number with three significant digits and no exponent.

    Parameters
    ----------
    value : float

    Returns
    -------
    str

    """
    text = f'{value:.3g}'
    return f'{float(text):.0f}' if 'e+' in text else text


def time_text(seconds):
    """
    Return a time in the largest unit in which it is at least 1.

    Parameters
    ----------
    seconds : float

    Returns
    -------
    str

    """
    for size, unit in _UNITS:
        if seconds >= size:
            return f'{digits(seconds / size)} {unit}'
    return f'{digits(seconds / _UNITS[-1][0])} {_UNITS[-1][1]}'


def ratio_text(spread):
    """
    Return a median with its quartiles: `2.1 (1.9 to 2.2)`.

    Parameters
    ----------
    spread : Spread

    Returns
    -------
    str

    """
    return f'{digits(spread.median)} ({digits(spread.low)} to {digits(spread.high)})'
