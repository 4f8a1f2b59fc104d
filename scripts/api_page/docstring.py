"""NumPy docstrings as Markdown."""

import inspect
import re

# Sections with entries `name : type` or `type`, each followed by an indented text.
_ENTRIES = ('Parameters', 'Returns', 'Yields', 'Raises', 'Attributes', 'Warns', 'Other Parameters')
_SECTION = re.compile(r'^(\w[\w ]*)\n-{3,}$', re.MULTILINE)
_INLINE_CODE = re.compile(r'(`+[^`]+`+)')


def summary(text):
    """
    Return the first paragraph of a docstring on one line.

    Parameters
    ----------
    text : str or None

    Returns
    -------
    str
        Markdown; '' without a docstring.

    """
    return escaped(' '.join(inspect.cleandoc(text or '').split('\n\n')[0].split()))


def to_markdown(text):
    """
    Return a docstring as Markdown.

    Parameters
    ----------
    text : str or None
        A NumPy docstring: paragraphs, then sections with underlined titles.

    Returns
    -------
    str
        Sections become bold titles, their entries lists, and indented paragraphs code blocks.

    """
    first, *pairs = _SECTION.split(inspect.cleandoc(text or ''))
    parts = [_paragraphs(first)]
    for title, body in zip(pairs[::2], pairs[1::2], strict=True):
        entries = _entries(body) if title in _ENTRIES else _paragraphs(body)
        parts.append(f'**{title}**\n\n{entries}')
    return '\n\n'.join(part for part in parts if part)


def escaped(text):
    """
    Return a text without accidental tags and emphasis, with links to the documents it names.

    Parameters
    ----------
    text : str

    Returns
    -------
    str

    """
    parts = _INLINE_CODE.split(text)
    return ''.join(
        f'`{part.strip("`")}`' if number % 2 else _linked(re.sub(r'([<*])', r'\\\1', part))
        for number, part in enumerate(parts)
    )


def _linked(text):
    """Return a text with links to the documents that it names."""
    return re.sub(r'\bdocs/([\w/]+\.md)', r'[\1](\1)', text)


def _paragraphs(text):
    """Return paragraphs as Markdown; an indented one as a code block."""
    paragraphs = re.split(r'\n\s*\n', text.strip('\n'))
    return '\n\n'.join(_paragraph(text) for text in paragraphs if text.strip())


def _paragraph(text):
    if text.startswith(' '):
        return f'```text\n{inspect.cleandoc(text)}\n```'
    return _list(text)


def _list(paragraph):
    """Return a paragraph with the line breaks of a Markdown list, or on one line."""
    lines = [escaped(line) for line in paragraph.splitlines()]
    is_list = any(re.match(r'\s*(- |\\\* |\d+\. )', line) for line in lines)
    return '\n'.join(lines) if is_list else ' '.join(line.strip() for line in lines)


def _entries(body):
    """Return `name : type` entries with their texts as a Markdown list."""
    items = []
    for line in body.strip('\n').splitlines():
        if line[:1] not in ('', ' '):
            name, colon, kind = line.partition(' : ')
            items.append([f'`{name}`' + (f': {escaped(kind)}' if colon else '')])
        elif line.strip() and items:
            items[-1].append(escaped(line.strip()))
    return '\n'.join(
        f'- {head}' + (f' — {" ".join(words)}' if words else '') for head, *words in items
    )
