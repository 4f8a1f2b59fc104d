"""The model report as one self-contained page, rendered with Jinja2."""

from __future__ import annotations

import base64
from functools import cache
import hashlib
from importlib import resources
import math
import os
from pathlib import Path
from typing import Any, NamedTuple

from jinja2 import Environment, PackageLoader, StrictUndefined
from jinja2.utils import htmlsafe_json_dumps
from markupsafe import escape, Markup

from .figures import page_data
from .plots import tone
from .tables import bodies_table, joints_table, links_table, pose
from .. import formatting
from ..formatting import count, number, percent, quantity
from ..report import JointEntry, PayloadEntry, Report

_SCRIPTS = ('kinematics.js', 'tables.js', 'plots.js', 'arm.js', 'start.js')
# A page without figures does not need plotly's 5 MB.
_TABLE_SCRIPTS = ('tables.js', 'start.js')


def write_html(report: Report, path: str | os.PathLike[str]) -> None:
    """
    Write the report as one self-contained page.

    The page contains plotly's JavaScript, requests nothing from the network, and its content
    security policy forbids requests. Texts of a robot description never become markup or scripts.
    The tables are readable without JavaScript.

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
        If plotly is not installed; only for a report with figures.

    """
    Path(path).write_text(page(report), encoding='utf-8')


def page(report: Report) -> str:
    """
    Return the page of a report.

    Parameters
    ----------
    report : Report

    Returns
    -------
    str
        HTML.

    """
    data = page_data(report)
    scripts = ['\n'.join(_asset(name) for name in (_SCRIPTS if data else _TABLE_SCRIPTS))]
    if data:
        scripts.insert(0, _plotly())
    verdict, severity = _verdict(report)
    return (
        environment()
        .get_template('page.html')
        .render(
            report=report,
            data=data,
            # The assets are files of this package: markup that must not be escaped.
            scripts=[Markup(script) for script in scripts],
            style=Markup(_asset('style.css')),
            policy=_policy(scripts),
            verdict=verdict,
            severity=severity,
            headline=headline(report),
            tiles=_tiles(report),
            joints_table=joints_table(report.joints, report.joint_names),
            bodies_table=bodies_table(report.bodies),
            links_table=links_table(report.links),
            gravity=math.hypot(*report.gravity),
            mimics=sum(joint.mimics is not None for joint in report.joints),
        )
    )


@cache
def environment() -> Environment:
    """Return the template environment: autoescape, and the number formats as filters."""
    env = Environment(
        loader=PackageLoader(__package__),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    formats = ('number', 'quantity', 'percent', 'position', 'vector', 'count', 'sentence')
    env.filters |= {name: getattr(formatting, name) for name in formats}
    env.filters |= {'name': breakable, 'file_name': file_name, 'script_data': script_data}
    env.globals |= {'pose': pose, 'infinity': math.inf}
    return env


def breakable(name: object) -> Markup:
    """Return a name as escaped markup in which a line may end after '_' and '/'."""
    return escape(name).replace('_', Markup('_<wbr>')).replace('/', Markup('/<wbr>'))


def file_name(source: str) -> str:
    """Return the source of a report without its folder, which a shared page must not show."""
    return Path(source).name


def script_data(value: Any) -> Markup:
    """
    Return data as JSON for the inside of a script element.

    Parameters
    ----------
    value : dict, list, str, float, int, bool or None

    Returns
    -------
    markupsafe.Markup
        Without the characters <, >, & and ', which are escaped.

    Raises
    ------
    ValueError
        If a number is NaN or infinite, which JSON does not have.

    """
    return htmlsafe_json_dumps(value, allow_nan=False, separators=(',', ':'))


def _asset(name: str) -> str:
    return (resources.files(__package__) / 'assets' / name).read_text(encoding='utf-8')


def _plotly() -> str:
    from plotly.offline import get_plotlyjs

    return get_plotlyjs()


def _policy(scripts: list[str]) -> str:
    """
    Return the content security policy: these scripts may run, and nothing may be requested.

    A text of a robot that became markup by an error in this package could not run.

    """
    hashes = ' '.join(
        f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'"
        for script in scripts
    )
    # plotly writes styles, and makes an image of a plot when it is saved.
    return (
        f"default-src 'none'; script-src {hashes}; style-src 'unsafe-inline'; "
        "img-src data: blob:; base-uri 'none'; form-action 'none'"
    )


def headline(report: Report) -> str:
    """Return the number of findings by severity, '2 problems, 1 note'."""
    parts = [count(amount, severity) for severity, amount in report.counts.items() if amount]
    return ', '.join(parts) or 'no findings'


def _verdict(report: Report) -> tuple[str, str]:
    # The text of the badge and its style.
    if report.verdict == 'refused':
        return 'refused', 'problem'
    worst = next((severity for severity, amount in report.counts.items() if amount), 'good')
    if worst == 'problem':
        return f'fix before use: {count(report.counts[worst], worst)}', worst
    if worst == 'warning':
        return f'usable, with {count(report.counts[worst], worst)}', worst
    return 'usable', 'good'


class _Tile(NamedTuple):
    """A number of the summary with its label; tone is 'problem', 'warning' or ''."""

    label: str
    value: str
    unit: str
    detail: str
    tone: str = ''


def _tiles(report: Report) -> list[_Tile]:
    moving = f'{quantity(report.moving_mass, "kg")} of it moves'
    detail = moving if report.verdict != 'refused' else 'of the links that could be read'
    tiles = [_Tile('mass', number(report.total_mass), 'kg', detail)]
    joints = [joint for joint in report.joints if joint.gravity is not None]
    if joints:
        tiles.append(_gravity_tile(joints))
    if report.payload is not None:
        tiles.append(_payload_tile(report.payload, report.moving_mass))
    if report.conditioning is not None:
        D = report.conditioning
        tiles.append(
            _Tile(
                'condition number of D, median',
                number(D.median, 3),
                '',
                f'worst {number(D.worst, 3)}'
                + ('' if D.is_positive_definite else '; not positive definite'),
                '' if D.is_positive_definite else 'problem',
            )
        )
    counts = report.counts
    severity = 'problem' if counts['problem'] else 'warning' if counts['warning'] else ''
    tiles.append(_Tile('findings', str(len(report.findings)), '', headline(report), severity))
    return tiles


def _gravity_tile(joints: list[JointEntry]) -> _Tile:
    loads = [(joint, joint.gravity) for joint in joints if joint.gravity is not None]
    limited = [(joint, load) for joint, load in loads if math.isfinite(load.share)]
    if limited:
        joint, load = max(limited, key=lambda item: item[1].share)
        share_tone = tone(load.share)
        return _Tile(
            'largest share of an effort limit',
            percent(load.share),
            '',
            f'{joint.name}: {number(load.magnitude, 3)} of '
            f'{quantity(joint.effort, joint.effort_unit)} for gravity',
            share_tone if share_tone in ('problem', 'warning') else '',
        )
    joint, load = max(loads, key=lambda item: item[1].magnitude)
    return _Tile(
        'worst gravity torque',
        number(load.magnitude, 3),
        joint.effort_unit,
        f'{joint.name}; no joint has an effort limit',
    )


def _payload_tile(payload: PayloadEntry, moving_mass: float) -> _Tile:
    label = 'payload at every pose'
    if not moving_mass > 0.0:
        return _Tile(label, '–', '', 'not known: no moving link has a mass')
    if not payload.is_moved:
        return _Tile(label, '–', '', f'no joint moves {payload.link}')
    if math.isinf(payload.everywhere):
        return _Tile(label, '–', '', 'no effort limit restricts it')
    return _Tile(
        label,
        number(payload.everywhere, 3),
        'kg',
        f'at {payload.link}; {payload.limiting_joint} allows no more',
        'problem' if payload.everywhere <= 0.0 else '',
    )
