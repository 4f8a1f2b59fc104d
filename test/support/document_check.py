"""Whether a committed docs/accuracy.md still fits what is measured now."""

import re

from .accuracy_document import MACHINE

# A figure may be this much larger than the document says, on another machine or with another
# version of a library; below ROUNDING all figures are the same.
ORDER_OF_MAGNITUDE = 10.0
ROUNDING = 1e-15

_FIGURE = re.compile(r'\d(?:\.\d+)?e[-+]\d+')


def misfits(stated, measured):
    """
    List where a stated document does not fit a measured one, one sentence each.

    Its words, robots and reasons must be the same, and no measured figure larger than the
    stated one by more than an order of magnitude. What it was measured with does not count.

    """
    old, new = (text.split(MACHINE)[0].splitlines() for text in (stated, measured))
    if len(old) != len(new):
        return [f'it has {len(old)} lines, expected {len(new)}']
    found = []
    for number, (line, expected) in enumerate(zip(old, new, strict=True), start=1):
        if _FIGURE.sub('#', line) != _FIGURE.sub('#', expected):
            found.append(f'line {number}: expected {expected!r}, got {line!r}')
            continue
        for said, is_now in zip(_FIGURE.findall(line), _FIGURE.findall(expected), strict=True):
            if float(is_now) > ORDER_OF_MAGNITUDE * max(float(said), ROUNDING):
                found.append(f'line {number}: says {said}, is {is_now} now: {line!r}')
    return found
