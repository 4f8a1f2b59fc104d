"""A table of the page: complete without a script, sorted and filtered with one."""

from dataclasses import dataclass
import math

from .escape import span, text
from ..formatting import number


@dataclass(frozen=True)
class Column:
    """
    One column.

    Attributes
    ----------
    title : str
    unit : str
        Below the title; '' for none.
    is_number : bool
        Numbers stand at the right.

    """

    title: str
    unit: str = ''
    is_number: bool = False


@dataclass(frozen=True)
class Cell:
    """
    One cell.

    Attributes
    ----------
    markup : str
        Its content, escaped already.
    value : float or None
        What it is sorted by; None: its words.
    tone : str
        Class of the style sheet: 'bad', 'doubt', 'fine', 'missing' or ''.

    """

    markup: str
    value: float | None = None
    tone: str = ''


def words(value, tone=''):
    """Return a cell with a text."""
    return Cell(text(value), tone=tone)


def name(value):
    """Return a cell with a name from the URDF."""
    return Cell(span(value))


def amount(value, digits=4, tone=''):
    """Return a cell with a number; '–' where there is none."""
    value = math.nan if value is None else value
    return Cell(
        text(number(value, digits)),
        float(value),
        'missing' if math.isnan(value) and not tone else tone,
    )


def table(label, columns, lines):
    """
    Return a table as markup.

    Parameters
    ----------
    label : str
        What it holds, for those who hear the page.
    columns : sequence of Column
    lines : iterable of sequence of Cell
        The first cell of each is the heading of its row.

    Returns
    -------
    str

    """
    head = ''.join(
        f'<th scope="col"{_numeric(column)}><span class="title">{text(column.title)}</span>'
        + (f' <span class="unit">{text(column.unit)}</span>' if column.unit else '')
        + '</th>'
        for column in columns
    )
    body = '\n'.join(f'<tr>{_line(columns, line)}</tr>' for line in lines)
    return (
        f'<div class="table"><table aria-label="{text(label)}"><thead><tr>{head}</tr></thead>'
        f'<tbody>\n{body}\n</tbody></table></div>'
    )


def _numeric(column):
    return ' class="number"' if column.is_number else ''


def _line(columns, line):
    first, *others = zip(columns, line, strict=True)
    return f'<th scope="row"{_sorted_by(first[1])}>{first[1].markup}</th>' + ''.join(
        _cell(column, cell) for column, cell in others
    )


def _cell(column, cell):
    classes = ' '.join(filter(None, ('number' if column.is_number else '', cell.tone)))
    attribute = f' class="{classes}"' if classes else ''
    return f'<td{attribute}{_sorted_by(cell)}>{cell.markup}</td>'


def _sorted_by(cell):
    if cell.value is None:
        return ''
    if math.isnan(cell.value):
        return ' data-value=""'
    # The words that a script reads as numbers.
    shown = repr(cell.value).replace('inf', 'Infinity')
    return f' data-value="{shown}"'
