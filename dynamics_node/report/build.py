"""Build the report of a URDF."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
import math
import os

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .conditioning import conditioning_entry
from .findings import find_all
from .gravity_load import gravity_load
from .payload_capacity import payload_entry
from .report import JointEntry, LinkEntry, Report
from .tables import body_entries, joint_entries, link_entries
from .workspace_analysis import WorkspaceAnalysis
from ..dynamics.arguments import check_link, gravity_vector
from ..dynamics.robot_model import STANDARD_GRAVITY
from ..errors import ArgumentError, quoted, RobotDescriptionError
from ..urdf import examine_urdf, PartialRead

DEFAULT_SAMPLES = 4096
DEFAULT_SEED = 1
_MAX_SAMPLES = 10_000_000

Source = str | bytes | os.PathLike[str]
Progress = Callable[[float, str], None]


def make_report(
    source: Source,
    *,
    gravity: ArrayLike = STANDARD_GRAVITY,
    samples: int = DEFAULT_SAMPLES,
    seed: int = DEFAULT_SEED,
    link: str | None = None,
    point: ArrayLike = (0.0, 0.0, 0.0),
    progress: Progress | None = None,
) -> Report:
    """
    Build the complete report of a robot.

    Parameters
    ----------
    source : str, bytes or os.PathLike
        A path or the URDF text itself. Meshes are never opened.
    gravity : array_like, shape (3,)
        m/s², in the root link's frame, points down.
    samples : int
        Number of positions at which torques are computed, before the search for the worst ones.
    seed : int
        Seed of the positions, >= 0.
    link : str, optional
        Link that carries a payload, by default `RobotModel.tip_link`.
    point : array_like, shape (3,)
        Position of the payload in the link's frame, m.
    progress : callable(fraction, text), optional
        Called with the finished fraction, from 0 to 1, and the name of the next step.

    Returns
    -------
    Report
        Also for a robot that `RobotModel` refuses; it lists every problem.

    Raises
    ------
    RobotDescriptionError
        If the source cannot be read or is not a URDF.
    ArgumentError
        If another argument is invalid.

    """
    gravity = gravity_vector(gravity)
    point = _checked_point(point)
    _check_numbers(samples, seed)
    notify = progress or (lambda fraction, text: None)
    with np.errstate(all='ignore'):  # overflow of absurd numbers leads to findings
        return _build(source, gravity, samples, seed, link, point, notify)


def _build(
    source: Source,
    gravity: NDArray[np.float64],
    samples: int,
    seed: int,
    link: str | None,
    point: NDArray[np.float64],
    notify: Progress,
) -> Report:
    notify(0.0, 'reading')
    examination = examine_urdf(source)
    report = _from_description(source, examination, gravity, samples, seed)
    analysis = None
    if not examination.problems:
        try:
            analysis = WorkspaceAnalysis.from_description(
                examination.description, gravity, samples, seed
            )
        except RobotDescriptionError as error:  # detected by the model, not by the reader
            examination = replace(examination, problems=error.problems)
        else:
            report = _with_dynamics(report, analysis, link, point, notify)
    if examination.problems:
        report = replace(report, verdict='refused', refusals=examination.problems)
    notify(0.9, 'checking')
    report = replace(report, findings=find_all(report, examination, analysis))
    notify(1.0, 'done')
    return report


def _from_description(
    source: Source, examination: PartialRead, gravity: NDArray[np.float64], samples: int, seed: int
) -> Report:
    links = link_entries(examination)
    return Report(
        robot=quoted(examination.description.name)[1:-1],
        source=_source_name(source),
        root=examination.description.root,
        gravity=tuple(gravity.tolist()),
        verdict='usable',
        refusals=(),
        total_mass=_readable_mass(links),
        moving_mass=_readable_mass(link for link in links if link.carrier),
        samples=samples,
        seed=seed,
        joint_names=(),
        links=links,
        bodies=(),
        joints=joint_entries(examination.description),
        findings=(),
    )


def _readable_mass(links: Iterable[LinkEntry]) -> float:
    # A refused robot may have masses that are not numbers.
    return float(sum(link.mass for link in links if not math.isnan(link.mass)))


def _with_dynamics(
    report: Report,
    analysis: WorkspaceAnalysis,
    link: str | None,
    point: NDArray[np.float64],
    notify: Progress,
) -> Report:
    model = analysis.model
    is_guessed = link is None
    if link is None:
        link = model.tip_link
    check_link(model.tree.links, link)
    report = replace(
        report,
        joint_names=model.joint_names,
        model=model,
        bodies=body_entries(model.tree, analysis.description),
    )
    if not model.joint_names:
        return report
    index = {name: i for i, name in enumerate(model.joint_names)}
    joints: list[JointEntry] = []
    for joint in report.joints:
        notify(0.05 + 0.5 * len(joints) / len(report.joints), f'gravity: {joint.name}')
        if joint.name in index:
            i = index[joint.name]
            joint = replace(
                joint,
                range_note=analysis.range_notes[i],
                gravity=gravity_load(analysis, i, link, point),
            )
        joints.append(joint)
    notify(0.6, 'payload')
    payload = replace(payload_entry(analysis, link, point), is_guessed=is_guessed)
    notify(0.8, 'mass matrix')
    return replace(
        report, joints=tuple(joints), payload=payload, conditioning=conditioning_entry(analysis)
    )


def _source_name(source: Source) -> str:
    if isinstance(source, os.PathLike):
        return os.fspath(source)
    if isinstance(source, bytes) or '<' in source or '\n' in source:
        return 'URDF text'
    return source


def _checked_point(point: ArrayLike) -> NDArray[np.float64]:
    try:
        point = np.array(point, dtype=float)
    except (TypeError, ValueError):
        point = np.empty(0)
    if point.shape != (3,) or not np.isfinite(point).all():
        raise ArgumentError(
            'point: expected three finite numbers in the frame of the link, m, '
            f'got {point.tolist()}'
        )
    return point


def _check_numbers(samples: int, seed: int) -> None:
    if not 1 <= samples <= _MAX_SAMPLES:
        raise ArgumentError(f'samples: expected 1 to {_MAX_SAMPLES}, got {samples}')
    if seed < 0:
        raise ArgumentError(f'seed: expected an integer >= 0, got {seed}')
