"""The check of docs/accuracy.md against current measurements."""

import re

from .accuracy_document import MACHINE

# Largest ratio of a measured figure to the stated one: other machines and versions of libraries
# differ. Figures below ROUNDING count as equal.
ORDER_OF_MAGNITUDE = 10.0
ROUNDING = 1e-15

_FIGURE = re.compile(r'\d(?:\.\d+)?e[-+]\d+')


def misfits(stated, measured):
    """
    Return one sentence per difference between a stated and a measured document.

    Words, robots and reasons have to be equal, and no measured figure may exceed the stated one
    by more than an order of magnitude. The section about the machine is ignored.

    """
    old, new = (text.split(MACHINE)[0].splitlines() for text in (stated, measured))
    if len(old) != len(new):
        return [f'it has {len(old)} lines, expected {len(new)}']
    differences = []
    for number, (line, expected) in enumerate(zip(old, new, strict=True), start=1):
        if _FIGURE.sub('#', line) != _FIGURE.sub('#', expected):
            differences.append(f'line {number}: expected {expected!r}, got {line!r}')
            continue
        for stated_figure, figure in zip(
            _FIGURE.findall(line), _FIGURE.findall(expected), strict=True
        ):
            if float(figure) > ORDER_OF_MAGNITUDE * max(float(stated_figure), ROUNDING):
                differences.append(
                    f'line {number}: states {stated_figure}, measured {figure}: {line!r}'
                )
    return differences
