"""A robot with names that attack a page: markup, scripts, templates, syntax of plotly."""

from itertools import cycle
import re
from xml.sax.saxutils import quoteattr

from .robots import ARM7

NAMES = (
    '</script><script>document.title="pwned"</script>',
    '<img src=x onerror="document.title=\'pwned\'">',
    '<b>bold</b>',
    '%{x} %{hovertext} &lt;i&gt;',
    '<a href="javascript:document.title=1">click</a>',
    "' onmouseover='document.title=1' \" onclick=\"document.title=1",
    '<!--',
    ']]> --> */',
    '${document.title=1}`\\u003c',
    '$x^2$ {css}',
    '2026-01-01',
    '&amp; &#60;script&#62;',
    'a' * 90,
)


def hostile_urdf():
    """
    Return the arm of this repository with hostile names.

    Returns
    -------
    text : str
        URDF.
    names : dict of str to str
        New name by old name, of links, joints and the robot ('robot').

    """
    text = ARM7.read_text()
    old = dict.fromkeys(re.findall(r'<(?:link|joint) name="([^"]+)"', text))
    names = {
        name: f'{attack}{number}' for number, (name, attack) in enumerate(zip(old, cycle(NAMES)))
    }
    for name, attack in names.items():
        text = text.replace(f'"{name}"', quoteattr(attack))
    names['robot'] = '</title><script>document.title="pwned"</script>'
    text = re.sub(
        r'<robot name="[^"]*"', lambda _: f'<robot name={quoteattr(names["robot"])}', text, count=1
    )
    return text, names
