"""
Numbers and names as text.

The page has typographic numbers (`number` and what is built on it), sentences have plain ASCII
ones (`plain_number`), and the columns of the terminal have short ones (`short`).

"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
import math

MISSING = '–'
_SUPERSCRIPT = str.maketrans('-0123456789', '⁻⁰¹²³⁴⁵⁶⁷⁸⁹')
_NO_BREAK = '\u00a0'  # no line break between a number and its unit


def number(value: float | None, digits: int = 4) -> str:
    """
    Return a number as text for the page: '44.76', '−0.5', '1.2·10⁻⁴'.

    Parameters
    ----------
    value : float or None
    digits : int
        Number of significant digits.

    Returns
    -------
    str
        '–' for None and NaN, '∞' for infinity; free of markup.

    """
    if value is None or math.isnan(value):
        return MISSING
    sign = '−' if value < 0.0 else ''
    size = abs(value)
    if math.isinf(size):
        return f'{sign}∞'
    if size and not 1e-3 <= float(f'{size:.{digits - 1}e}') < 1e5:
        mantissa, _, exponent = f'{size:.{digits - 1}e}'.partition('e')
        mantissa = mantissa.rstrip('0').rstrip('.')  # 1.2·10⁻⁶, not 1.200·10⁻⁶
        power = f'10{str(int(exponent)).translate(_SUPERSCRIPT)}'
        return f'{sign}{power}' if mantissa == '1' else f'{sign}{mantissa}·{power}'
    rounded = float(f'{size:.{digits - 1}e}')
    places = max(0, digits - 1 - (math.floor(math.log10(rounded)) if rounded else 0))
    return sign + _without_trailing_zeros(f'{rounded:.{places}f}')


def quantity(value: float | None, unit: str, digits: int = 4) -> str:
    """Return a number with its unit on one line: '44.76 N m'."""
    return f'{number(value, digits)} {unit}'.replace(' ', _NO_BREAK)


def percent(share: float | None) -> str:
    """Return a share as text, '57 %'; '–' for None and NaN."""
    if share is None or math.isnan(share):
        return MISSING
    if math.isinf(share):
        return f'∞{_NO_BREAK}%'
    if 0.0 < share < 0.1:
        return f'{number(100.0 * share, 2)}{_NO_BREAK}%'
    # Shares just below and just above a limit must not both read 100 %.
    if round(100.0 * share) == 100 and share != 1.0:
        return f'{100.0 * share:.{1 if abs(share - 1.0) >= 5e-4 else 0}f}{_NO_BREAK}%'
    return f'{100.0 * share:.0f}{_NO_BREAK}%'


def position(value: float, is_prismatic: bool) -> str:
    """Return a joint position with its unit: '−92.5°' from rad, or '0.12 m'."""
    if is_prismatic:
        return quantity(value, 'm')
    if not math.isfinite(value):
        return f'{number(value)}°'
    degrees = round(math.degrees(value), 1)
    return f'{number(degrees, 5)}°' if abs(degrees) >= 1e-3 else '0°'


def vector(values: Iterable[float] | None, digits: int = 4) -> str:
    """Return numbers in a row, '0.1, 0, −0.32'; '–' for None."""
    return MISSING if values is None else ', '.join(number(value, digits) for value in values)


def count(amount: int, singular: str, plural: str | None = None) -> str:
    """Return '1 joint' or '3 joints'."""
    return f'{amount} {singular if amount == 1 else plural or singular + "s"}'


def sentence(text: str) -> str:
    """Return a text with a capital first letter."""
    return text[:1].upper() + text[1:]


def plain_number(value: float) -> str:
    """Return a number with three digits for a sentence: '0.123', '1e-05'."""
    if value == 0.0:
        return '0'
    if 1e-3 <= abs(value) < 1e5:
        digits = max(0, 2 - math.floor(math.log10(abs(value))))
        return _without_trailing_zeros(f'{value:.{digits}f}')
    return f'{value:.3g}'


def kilograms(mass: float) -> str:
    """Return a mass in kg, or in g below 0.1 kg."""
    if 0.0 < abs(mass) < 0.1:
        return f'{plain_number(mass * 1000.0)} g'
    return f'{plain_number(mass)} kg'


def plain_percent(share: float) -> str:
    """Return a share for a sentence: '50 %', '30 times'."""
    if share < 1e-4:
        return 'less than 0.01 %'
    if share < 10.0:
        return f'{plain_number(100.0 * share)} %'
    return f'{plain_number(share)} times'


def quoted_names(values: Iterable[str], most: int = 5) -> str:
    """Return names in quotes, the first ones if there are more than `most`."""
    values = list(values)
    return enumeration([f"'{value}'" for value in values[:most]], len(values))


def enumeration(texts: Sequence[str], total: int) -> str:
    """Return texts in a row: 'a, b and c', or 'a, b and 5 more' of `total` ones."""
    if total > len(texts):
        return f'{", ".join(texts)} and {total - len(texts)} more'
    if len(texts) > 1:
        return f'{", ".join(texts[:-1])} and {texts[-1]}'
    return ''.join(texts)


def short(value: float | None) -> str:
    """Return a number with three digits for a column of the terminal; '-' for None and NaN."""
    if value is None or math.isnan(value):
        return '-'
    if math.isinf(value):
        return '∞' if value > 0.0 else '-∞'
    if value == 0.0:
        return '0'
    return f'{value:.3g}' if 1e-3 <= abs(value) < 1e5 else f'{value:.1e}'


def fixed(value: float, digits: int = 3) -> str:
    """Return a number with a fixed number of decimals, without the sign of a rounded zero."""
    return f'{round(value, digits) + 0.0:.{digits}f}'


def fixed_vector(values: Iterable[float] | None, digits: int = 3) -> str:
    """Return numbers with fixed decimals in a row; '-' for None."""
    return '-' if values is None else ' '.join(fixed(value, digits) for value in values)


def short_vector(values: Iterable[float] | None) -> str:
    """Return numbers with three digits in a row; '-' for None."""
    return '-' if values is None else ' '.join(short(value) for value in values)


def _without_trailing_zeros(text: str) -> str:
    return text.rstrip('0').rstrip('.') if '.' in text else text
