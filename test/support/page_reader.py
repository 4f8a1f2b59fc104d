"""A page as a browser without scripts has it: elements, tables, texts."""

from functools import cache
from html.parser import HTMLParser

from dynamics_node.report.html import page


class Reader(HTMLParser):
    """Elements, attributes, tables and texts of a page, as a browser without scripts has them."""

    def __init__(self, markup):
        super().__init__()
        self.elements, self.tables, self.text = [], {}, []
        self.scripts, self.styles, self.title = [], [], ''
        self._open, self._rows = [], None
        self.feed(markup)
        self.close()

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        self.elements.append((tag, attributes))
        if tag not in ('meta', 'wbr', 'input', 'br', 'img', 'link'):
            self._open.append(tag)
        if tag == 'table':
            self._rows = self.tables.setdefault(attributes['aria-label'], [])
        elif tag == 'tr':
            self._rows.append([])
        elif tag in ('td', 'th'):
            self._rows[-1].append('')
        elif tag == 'script':
            self.scripts.append('')
        elif tag == 'style':
            self.styles.append('')

    def handle_endtag(self, tag):
        assert self._open.pop() == tag, f'</{tag}> closes something else'

    def handle_data(self, data):
        if 'script' in self._open:
            self.scripts[-1] += data
        elif 'style' in self._open:
            self.styles[-1] += data
        elif 'title' in self._open:
            self.title += data
        else:
            self.text.append(data)
            if 'td' in self._open or 'th' in self._open:
                self._rows[-1][-1] += data

    @property
    def words(self):
        """All text that is seen, in one line."""
        return ' '.join(' '.join(self.text).replace('\u00a0', ' ').split())


@cache
def reading(report):
    """Return what is on the page of a report, by the function that makes the report."""
    return Reader(page(report()))


def plain(cell):
    """Return a text with plain spaces."""
    return cell.replace('\u00a0', ' ')
