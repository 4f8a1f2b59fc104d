"""
Sections measured by other files: trajectories, the node.

    python -m benchmarks.external_sections node

The docstring of such a file, `benchmarks/NAME.py`, is the text of the section. Its `measure()`
returns a list of rows, each a dict of column title → text or number. An exception, for example
because ROS is missing, is reported in the section.

"""

import argparse
from dataclasses import dataclass, field
from importlib import import_module, util
import inspect
import re
import sys

from . import tables
from .host import describe
from .libraries import version_of
from .robots import ROOT

# Key → title, file.
SECTIONS = {
    'trajectory': ('Trajectories', 'trajectory_effort'),
    'node': ('The node', 'node_latency'),
}


@dataclass
class Section:
    """
    A section of the report.

    Attributes
    ----------
    title : str
    text : str
        Method of the measurement, or reason of its absence.
    rows : list of dict
        Column title → text or number; the same columns in each row.

    """

    title: str
    text: str
    rows: list = field(default_factory=list)


def measure(say=print):
    """
    Measure all sections.

    Parameters
    ----------
    say : callable

    Returns
    -------
    dict of str to Section

    """
    sections = {}
    for key, (title, name) in SECTIONS.items():
        if util.find_spec(f'{__package__}.{name}') is None:
            sections[key] = Section(title, f'Not measured: there is no benchmarks/{name}.py.')
            continue
        say(f'section: {title}')
        try:
            sections[key] = measure_one(key)
        except Exception as error:  # the results of the other sections stay
            sections[key] = Section(title, f'Not measured: {type(error).__name__}: {error}')
    return sections


def measure_one(key):
    """Measure the section of a key of SECTIONS; return a Section."""
    title, name = SECTIONS[key]
    module = import_module(f'.{name}', __package__)
    return Section(title, inspect.getdoc(module) or '', list(module.measure()))


def replace(report, section, facts):
    """
    Replace a section of a report by one that was measured alone.

    Parameters
    ----------
    report : str
        Markdown with a heading of the section's title.
    section : Section
    facts : dict of str to str
        The machine and versions of the measurement.

    Returns
    -------
    str

    """
    alone = (
        'Measured by itself, after the rest of this page, on: '
        + '; '.join(f'{name} {value}' for name, value in facts.items())
        + '.'
    )
    text = '\n\n'.join([f'## {section.title}', section.text, alone, tables.section_table(section)])
    pattern = rf'^## {re.escape(section.title)}\n.*?(?=^## |\Z)'
    if not re.search(pattern, report, re.MULTILINE | re.DOTALL):
        raise ValueError(f'expected a section "{section.title}" in the report, got none')
    return re.sub(
        pattern, lambda _: f'{text}\n\n', report, count=1, flags=re.MULTILINE | re.DOTALL
    )


def main(arguments=None):
    """Measure one section and rewrite it in docs/benchmarks.md."""
    parser = argparse.ArgumentParser(prog='python -m benchmarks.external_sections')
    parser.add_argument('section', choices=SECTIONS)
    key = parser.parse_args(arguments).section
    facts = describe() | {'rclpy': version_of('ros-rclpy') or version_of('rclpy') or 'unknown'}
    section = measure_one(key)
    path = ROOT / 'docs' / 'benchmarks.md'
    path.write_text(replace(path.read_text(encoding='utf-8'), section, facts), encoding='utf-8')
    print(tables.section_table(section))
    return 0


if __name__ == '__main__':
    sys.exit(main())
