"""The page in parts: prose, Python, commands, and their output."""

from dataclasses import dataclass
from pathlib import Path
import re

PATH = Path(__file__).resolve().parents[2] / 'docs' / 'tutorial.md'
_BLOCK = re.compile(r'^(?:<!-- (.*?) -->\n)?```(python|console|text)\n(.*?)^```\n', re.M | re.S)


@dataclass
class Block:
    """
    A fenced block.

    `kind` is python (code to run), console (a program to start, and its first lines) or text
    (output). `order` is the invisible comment above it: the name of the program with these lines,
    or `stop NAME`.

    """

    kind: str
    order: str
    text: str


def split(page):
    """
    Split a page into its parts.

    Parameters
    ----------
    page : str

    Returns
    -------
    list of str or Block
        In their order; `join` is the inverse.

    """
    parts, end = [], 0
    for match in _BLOCK.finditer(page):
        parts += [page[end : match.start()], Block(match[2], match[1] or '', match[3])]
        end = match.end()
    return [*parts, page[end:]]


def join(parts):
    """Join the parts of a page."""
    return ''.join(part if isinstance(part, str) else _fenced(part) for part in parts)


def _fenced(block):
    order = f'<!-- {block.order} -->\n' if block.order else ''
    return f'{order}```{block.kind}\n{block.text}```\n'
