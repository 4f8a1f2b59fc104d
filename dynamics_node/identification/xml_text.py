"""Elements of an XML text with the places of their bytes, and edits that leave all others."""

from collections.abc import Sequence
from dataclasses import dataclass, field
import re
from xml.parsers import expat

# One attribute of a tag: its name, and its value in double or single quotes.
_ATTRIBUTE = re.compile(rb'\s+([^\s=/>]+)\s*=\s*(?:"([^"]*)"|\'([^\']*)\')')
_TAG_NAME = re.compile(rb'<[^\s/>]+')
_WORD = re.compile(rb'[^ \t\r\n]+')
# Indentation of a child where the text has no example.
_INDENTATION = b'  '


@dataclass(eq=False)
class Element:
    """
    One element of a text.

    Attributes
    ----------
    tag : str
        With its prefix, if it has one.
    values : dict of str to str
        Its attributes, decoded.
    start : int
        Place of the '<' of its start tag, bytes.
    head_end : int
        Place behind the '>' of its start tag.
    tail : int
        Place of the '<' of its end tag; `head_end` if it closes itself.
    is_self_closing : bool
    places : dict of str to (int, int)
        Places of the values of its attributes, between the quotes.
    attributes_end : int
        Place behind the last attribute, or behind the tag's name.
    parent : Element or None
    children : list of Element

    """

    tag: str
    values: dict[str, str]
    start: int
    head_end: int
    tail: int
    is_self_closing: bool
    places: dict[str, tuple[int, int]]
    attributes_end: int
    parent: 'Element | None' = None
    children: list['Element'] = field(default_factory=list)

    def find(self, tag: str) -> 'Element | None':
        """Return the first child with a tag."""
        return next((child for child in self.children if child.tag == tag), None)


def parse_places(text: bytes) -> Element:
    """
    Return the root element of a text, with all elements below it.

    Parameters
    ----------
    text : bytes
        UTF-8 text that `urdf.examine_urdf` accepts: within its limits, without document type.

    Returns
    -------
    Element

    """
    root: list[Element] = []
    path: list[Element] = []
    parser = expat.ParserCreate(encoding='utf-8')

    def start(tag: str, attributes: dict[str, str]) -> None:
        element = _element(text, parser.CurrentByteIndex, tag, attributes)
        if path:
            element.parent = path[-1]
            path[-1].children.append(element)
        else:
            root.append(element)
        path.append(element)

    def end(_: str) -> None:
        element = path.pop()
        if not element.is_self_closing:
            element.tail = parser.CurrentByteIndex

    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.Parse(text, True)
    return root[0]


def _element(text: bytes, start: int, tag: str, values: dict[str, str]) -> Element:
    match = _TAG_NAME.match(text, start)
    assert match is not None
    places = {}
    place = match.end()
    while match := _ATTRIBUTE.match(text, place):
        places[match[1].decode()] = match.span(2 if match[2] is not None else 3)
        place = match.end()
    head_end = text.index(b'>', place) + 1
    is_self_closing = text[head_end - 2 : head_end] == b'/>'
    return Element(tag, values, start, head_end, head_end, is_self_closing, places, place)


class TextEdits:
    """
    Changes of a text, collected and then applied together.

    Attributes
    ----------
    text : bytes
        The text before the changes.

    """

    def __init__(self, text: bytes) -> None:
        self.text = text
        self._edits: list[tuple[int, int, bytes]] = []

    def is_plain(self, element: Element, name: str) -> bool:
        """Return whether an attribute is there and written without references (&#49;)."""
        place = element.places.get(name)
        return place is not None and b'&' not in self.text[slice(*place)]

    def set_value(self, element: Element, name: str, value: str) -> None:
        """
        Replace the value of an attribute, or add the attribute behind the others.

        Parameters
        ----------
        element : Element
        name : str
        value : str
            Numbers: nothing in it is escaped.

        """
        if place := element.places.get(name):
            self._edits.append((*place, value.encode()))
        else:
            end = element.attributes_end
            self._edits.append((end, end, f' {name}="{value}"'.encode()))

    def replace_words(self, element: Element, name: str, words: Sequence[str | None]) -> None:
        """
        Replace some words of an attribute; the blanks between them stay.

        Parameters
        ----------
        element : Element
        name : str
            A plain attribute with as many words as are given.
        words : sequence of str or None
            None keeps the word.

        """
        start, end = element.places[name]
        for match, word in zip(_WORD.finditer(self.text, start, end), words, strict=True):
            if word is not None:
                self._edits.append((*match.span(), word.encode()))

    def insert_first(self, parent: Element, lines: Sequence[str]) -> None:
        """
        Insert a new first child, with the indentation around it.

        Parameters
        ----------
        parent : Element
        lines : sequence of str
            The lines of the child; two blanks at the beginning of a line are one level. In one
            line where the parent does not begin its line.

        """
        if parent.head_end == parent.tail:
            self._fill(parent, lines)
            return
        line_end = self.text.find(b'\n', parent.head_end)
        ends_its_line = line_end >= 0 and not self.text[parent.head_end : line_end].strip()
        child = self._laid_out(parent, lines) if ends_its_line else _in_one_line(lines)
        self._edits.append((parent.head_end, parent.head_end, child))

    def insert_last(self, parent: Element, lines: Sequence[str]) -> None:
        """Insert a new last child; see `insert_first`."""
        if parent.head_end == parent.tail:
            self._fill(parent, lines)
            return
        content = self.text[parent.head_end : parent.tail]
        blanks = content[len(content.rstrip()) :]
        if b'\n' in blanks:
            place, child = parent.tail - len(blanks), self._laid_out(parent, lines)
        else:
            place, child = parent.tail, _in_one_line(lines)
        self._edits.append((place, place, child))

    def apply(self) -> bytes:
        """Return the text with all changes."""
        parts, done = [], 0
        for start, end, new in sorted(self._edits, key=lambda edit: edit[0]):
            parts += [self.text[done:start], new]
            done = end
        return b''.join([*parts, self.text[done:]])

    def _fill(self, parent: Element, lines: Sequence[str]) -> None:
        # <a b="c" /> and <a b="c"></a> become <a b="c">child</a>.
        child = self._laid_out(parent, lines)
        indentation = self._indentation(parent)
        if indentation is not None:
            child += self._line_break(parent) + indentation
        if parent.is_self_closing:
            child = b'>' + child + f'</{parent.tag}>'.encode()
            self._edits.append((parent.attributes_end, parent.head_end, child))
        else:
            self._edits.append((parent.head_end, parent.head_end, child))

    def _laid_out(self, parent: Element, lines: Sequence[str]) -> bytes:
        outer = self._indentation(parent)
        if outer is None:
            return _in_one_line(lines)
        unit, line_break = self._unit(parent), self._line_break(parent)
        result = b''
        for line in lines:
            content = line.lstrip(' ')
            depth = 1 + (len(line) - len(content)) // 2
            result += line_break + outer + unit * depth + content.encode()
        return result

    def _indentation(self, element: Element) -> bytes | None:
        # White space between the line's beginning and the element; None if there is more.
        before = self.text[self.text.rfind(b'\n', 0, element.start) + 1 : element.start]
        return None if before.strip() else before

    def _unit(self, parent: Element) -> bytes:
        # One level of indentation: from the next example around the parent.
        above = parent.parent
        pairs = [(parent, child) for child in parent.children[:1]]
        if above is not None:
            pairs += [(other, child) for other in above.children for child in other.children[:1]]
            pairs.append((above, parent))
        for outer, inner in pairs:
            before, behind = self._indentation(outer), self._indentation(inner)
            if before is None or behind is None or behind == before:
                continue
            if behind.startswith(before):
                return behind[len(before) :]
        return _INDENTATION

    def _line_break(self, element: Element) -> bytes:
        line = self.text.rfind(b'\n', 0, element.start)
        return b'\r\n' if self.text[line - 1 : line] == b'\r' else b'\n'


def _in_one_line(lines: Sequence[str]) -> bytes:
    return ''.join(line.strip() for line in lines).encode()
