"""Numbers as people read them: four digits, a real minus sign, powers of ten as such."""

import math

_RAISED = str.maketrans('-0123456789', '⁻⁰¹²³⁴⁵⁶⁷⁸⁹')
MISSING = '–'
_HARD = '\u00a0'  # a space at which no line ends


def number(value, digits=4):
    """
    Return a number as text.

    Parameters
    ----------
    value : float or None
    digits : int
        Significant ones.

    Returns
    -------
    str
        '–' for None and NaN, '∞' for infinity; never markup.

    """
    if value is None or math.isnan(value):
        return MISSING
    sign = '−' if value < 0.0 else ''
    size = abs(value)
    if math.isinf(size):
        return f'{sign}∞'
    if size and not 1e-3 <= float(f'{size:.{digits - 1}e}') < 1e5:
        mantissa, _, exponent = f'{size:.{digits - 1}e}'.partition('e')
        # 1·10⁻⁶ and not 1.000·10⁻⁶: zeros at the end say nothing here.
        mantissa = mantissa.rstrip('0').rstrip('.')
        power = f'10{str(int(exponent)).translate(_RAISED)}'
        return f'{sign}{power}' if mantissa == '1' else f'{sign}{mantissa}·{power}'
    rounded = float(f'{size:.{digits - 1}e}')
    places = max(0, digits - 1 - (math.floor(math.log10(rounded)) if rounded else 0))
    shown = f'{rounded:.{places}f}'
    return sign + (shown.rstrip('0').rstrip('.') if '.' in shown else shown)


def quantity(value, unit, digits=4):
    """Return a number with its unit on one line: '44.76 N m'."""
    return f'{number(value, digits)} {unit}'.replace(' ', _HARD)


def percent(share):
    """Return a share as text, '57 %'; '–' for NaN."""
    if share is None or math.isnan(share):
        return MISSING
    if math.isinf(share):
        return f'∞{_HARD}%'
    if 0.0 < share < 0.1:
        return f'{number(100.0 * share, 2)}{_HARD}%'
    # 99.6 % of a limit is not all of it, and 100.4 % is more.
    if round(100.0 * share) == 100 and share != 1.0:
        return f'{100.0 * share:.{1 if abs(share - 1.0) >= 5e-4 else 0}f}{_HARD}%'
    return f'{100.0 * share:.0f}{_HARD}%'


def position(value, is_prismatic):
    """Return a joint position with its unit: '-92.5°' from rad, or '0.12 m'."""
    if is_prismatic:
        return quantity(value, 'm')
    if not math.isfinite(value):
        return f'{number(value)}°'
    degrees = round(math.degrees(value), 1)
    return f'{number(degrees, 5)}°' if abs(degrees) >= 1e-3 else '0°'


def vector(values, digits=4):
    """Return three numbers, '0.1, 0, −0.32'; '–' for None."""
    return MISSING if values is None else ', '.join(number(value, digits) for value in values)


def count(amount, singular, plural=None):
    """Return '1 joint' or '3 joints'."""
    return f'{amount} {singular if amount == 1 else plural or singular + "s"}'
