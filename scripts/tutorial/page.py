"""The page taken apart: prose, Python, commands, and what is printed."""

from dataclasses import dataclass
from pathlib import Path
import re

PATH = Path(__file__).resolve().parents[2] / 'docs' / 'tutorial.md'
_BLOCK = re.compile(r'^(?:<!-- (.*?) -->\n)?```(python|console|text)\n(.*?)^```\n', re.M | re.S)


@dataclass
class Block:
    """
    A fenced block.

    `kind` is python (is run), console (a program that is started, and its first lines) or text
    (what is printed). `order` is the comment above it that no reader sees: the name of the
    program whose lines a text has, or `stop NAME`.

    """

    kind: str
    order: str
    text: str


def split(page):
    """
    Take a page apart.

    Parameters
    ----------
    page : str

    Returns
    -------
    list of str or Block
        In their order; `join` makes the page of it again.

    """
    parts, end = [], 0
    for match in _BLOCK.finditer(page):
        parts += [page[end : match.start()], Block(match[2], match[1] or '', match[3])]
        end = match.end()
    return [*parts, page[end:]]


def join(parts):
    """Make a page of its parts."""
    return ''.join(part if isinstance(part, str) else _fenced(part) for part in parts)


def _fenced(block):
    order = f'<!-- {block.order} -->\n' if block.order else ''
    return f'{order}```{block.kind}\n{block.text}```\n'
