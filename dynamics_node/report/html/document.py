"""The model report as a page: one file that needs nothing else, made to be shown to others."""

import base64
import hashlib
from importlib import resources
from pathlib import Path

from .escape import script_data, span, text
from .figures import page_data
from .findings import findings_section
from .joints import joints_table
from .links import bodies_table, links_table
from .payload import conditioning_section, payload_section
from .summary import summary
from ..formatting import count, number, vector

_SCRIPTS = ('kinematics.js', 'tables.js', 'plots.js', 'arm.js', 'start.js')
# Without figures nothing is drawn, and plotly would be 5 MB for nothing.
_SCRIPTS_OF_TABLES = ('tables.js', 'start.js')


def write_html(report, path):
    """
    Write the report as one self-contained page.

    It asks the network for nothing, and its own policy forbids it to: plotly's JavaScript is in
    it. Nothing in a robot description becomes markup or a script. The tables are there without
    JavaScript.

    Parameters
    ----------
    report : Report
    path : str or os.PathLike
        Is replaced if it exists.

    Raises
    ------
    OSError
        If the file cannot be written.
    ImportError
        If plotly is not installed; only for a report with something to draw.

    """
    Path(path).write_text(page(report), encoding='utf-8')


def page(report):
    """
    Return the page of a report.

    Parameters
    ----------
    report : Report

    Returns
    -------
    str

    """
    data = page_data(report)
    scripts = ['\n'.join(_file(name) for name in (_SCRIPTS if data else _SCRIPTS_OF_TABLES))]
    blob = ''
    if data:
        blob = f'<script type="application/json" id="data">{script_data(data)}</script>\n'
        scripts.insert(0, _plotly())
    sections = '\n'.join(_sections(report, is_drawn=bool(data)))
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{_policy(scripts)}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<title>{text(report.robot)}: model report</title>\n'
        f'<style>\n{_file("style.css")}</style>\n</head>\n<body>\n'
        f'{summary(report)}\n{_navigation(report, bool(data))}\n'
        f'<main>\n{sections}\n</main>\n{_foot(report, bool(data))}\n{blob}'
        + '\n'.join(f'<script>{script}</script>' for script in scripts)
        + '\n</body>\n</html>\n'
    )


def _file(name):
    return (resources.files(__package__) / 'assets' / name).read_text(encoding='utf-8')


def _plotly():
    from plotly.offline import get_plotlyjs

    return get_plotlyjs()


def _policy(scripts):
    """
    Return what the browser lets the page do: run these scripts, and ask nobody for anything.

    Even if some text of a robot became markup by a mistake of ours, it could not run.

    """
    allowed = ' '.join(
        f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'"
        for script in scripts
    )
    # plotly writes styles, and draws a picture of a plot for those who want to save one.
    return (
        f"default-src 'none'; script-src {allowed}; style-src 'unsafe-inline'; "
        "img-src data: blob:; base-uri 'none'; form-action 'none'"
    )


def _navigation(report, is_drawn):
    places = [('findings', 'Findings')]
    if is_drawn:
        places += [('arm-section', 'The robot'), ('gravity', 'Gravity')]
    if report.joints:
        places.append(('joints', 'Joints'))
    if report.payload is not None:
        places.append(('payload', 'Payload'))
    if report.bodies:
        places.append(('bodies', 'Bodies'))
    if report.links:
        places.append(('links', 'Links'))
    links = ''.join(f'<a href="#{place}">{word}</a>' for place, word in places)
    return f'<nav><div>{links}</div></nav>'


def _sections(report, is_drawn):
    yield findings_section(report)
    if is_drawn:
        yield _file('arm.html')
        yield _file('gravity.html')
    if report.joints:
        yield _section(
            'joints',
            'Joints',
            'What each joint can do, and the most that gravity asks of it. '
            'Payload left: the point mass that may hang at the payload point in that pose until '
            'this joint is at its limit.',
            joints_table(report.joints, report.joint_names),
        )
    if report.payload is not None and report.conditioning is not None:
        yield (f'<div class="pair">{payload_section(report)}{conditioning_section(report)}</div>')
    if report.bodies:
        plot = '<div class="scroll"><div class="plot" id="plot-mass"></div></div>'
        yield _section(
            'bodies',
            'Bodies',
            'What each joint moves as one piece: its link with everything '
            'that fixed joints attach to it.',
            (plot if is_drawn else '') + bodies_table(report.bodies),
        )
    if report.links:
        yield _section(
            'links',
            'Links',
            'As they stand in the URDF. Principal moments are about the centre of mass.',
            links_table(report.links),
        )


def _section(identifier, title, lead, content):
    return (
        f'<section id="{identifier}"><h2>{title}</h2><p class="quiet">{lead}</p>'
        f'{content}</section>'
    )


def _foot(report, is_drawn):
    how = ''
    if report.payload is not None:
        how = (
            f'Worst torques: {count(report.samples, "pose")} drawn evenly within the limits '
            f'(seed {report.seed}), then climbed to the top. '
        )
    root = f'Base frame: {span(report.root)}. ' if report.root else ''
    return (
        f'<footer>{how}Gravity {text(vector(report.gravity))} m/s² '
        f'({text(number(sum(value**2 for value in report.gravity) ** 0.5))}). {root}'
        'Made by dynamics_node; this page asks the network for nothing.'
        + (' Plots: plotly.js, © Plotly, Inc., MIT licence.' if is_drawn else '')
        + '</footer>'
    )
