"""
Sections that other files measure: trajectories, the node.

Such a file is `benchmarks/NAME.py`. Its docstring becomes the text of the section, and its
`measure()` returns a list of rows, each a dict of column title → text or number. If it raises,
for example because ROS is missing, the report says so.

"""

from dataclasses import dataclass, field
from importlib import import_module, util
import inspect

# Key → title, file.
PLACES = {'trajectory': ('Trajectories', 'trajectory_effort'),
          'node': ('The node', 'node_latency')}


@dataclass
class Section:
    """
    A section of the report.

    Attributes
    ----------
    title : str
    text : str
        What was measured and how, or why it was not.
    rows : list of dict
        Column title → text or number; the same columns in each row.

    """

    title: str
    text: str
    rows: list = field(default_factory=list)


def measure(say=print):
    """
    Let the files measure that are there.

    Parameters
    ----------
    say : callable

    Returns
    -------
    dict of str to Section

    """
    sections = {}
    for key, (title, name) in PLACES.items():
        if util.find_spec(f'{__package__}.{name}') is None:
            sections[key] = Section(title, f'Not measured: there is no benchmarks/{name}.py.')
            continue
        say(f'section: {title}')
        try:
            module = import_module(f'.{name}', __package__)
            sections[key] = Section(title, inspect.getdoc(module) or '', list(module.measure()))
        except Exception as error:  # one section must not cost the minutes of all others
            sections[key] = Section(title, f'Not measured: {type(error).__name__}: {error}')
    return sections
