"""From a URDF to its report."""

from dataclasses import replace
import math
import os

import numpy as np

from .carrying import payload_entry
from .conditioning import conditioning_entry
from .defaults import SAMPLES, SEED
from .entries import body_entries, joint_entries, link_entries
from .findings import find_all
from .loads import gravity_load
from .report import Report
from .study import Study
from ..dynamics.arguments import check_link, gravity_vector
from ..dynamics.robot_model import STANDARD_GRAVITY
from ..errors import ArgumentError, quoted, RobotDescriptionError
from ..urdf import examine_urdf

_MOST_SAMPLES = 10_000_000


def make_report(
    source,
    *,
    gravity=STANDARD_GRAVITY,
    samples=SAMPLES,
    seed=SEED,
    link=None,
    point=(0.0, 0.0, 0.0),
    progress=None,
):
    """
    Look at a robot from all sides.

    Parameters
    ----------
    source : str, bytes or os.PathLike
        A path or the URDF text itself. Meshes are never opened.
    gravity : array_like, shape (3,)
        m/s², in the root link's frame, points down.
    samples : int
        Positions at which torques are computed, before the worst are climbed to the top.
    seed : int
        Of their positions, >= 0.
    link : str, optional
        That carries a payload; see `RobotModel.tip_link`.
    point : array_like, shape (3,)
        Where the payload is in the link's frame, m.
    progress : callable(fraction, what), optional
        Told how much is done, from 0 to 1, and what is done next.

    Returns
    -------
    Report
        Also for a robot that `RobotModel` refuses: with every problem.

    Raises
    ------
    RobotDescriptionError
        If the source cannot be read, or is no URDF at all.
    ArgumentError
        If another argument is wrong.

    """
    gravity = gravity_vector(gravity)
    point = _checked_point(point)
    _check_numbers(samples, seed)
    tell = progress or (lambda fraction, what: None)
    with np.errstate(all='ignore'):  # absurd numbers overflow, and are told as what they are
        return _made(source, gravity, samples, seed, link, point, tell)


def _made(source, gravity, samples, seed, link, point, tell):
    tell(0.0, 'reading')
    examination = examine_urdf(source)
    report = _what_is_written(source, examination, gravity, samples, seed)
    if not examination.problems:
        try:
            study = Study.begin(examination.description, gravity, samples, seed)
        except RobotDescriptionError as error:  # found by the model, not by the reader
            examination = replace(examination, problems=error.problems)
        else:
            report = _with_dynamics(report, study, link, point, tell)
    if examination.problems:
        report = replace(report, verdict='refused', refusals=examination.problems)
        study = None
    tell(0.9, 'judging')
    report = replace(report, findings=find_all(report, examination, study))
    tell(1.0, 'done')
    return report


def _what_is_written(source, examination, gravity, samples, seed):
    links = link_entries(examination)
    return Report(
        robot=quoted(examination.description.name)[1:-1],
        source=_source_name(source),
        root=examination.description.root,
        gravity=tuple(gravity.tolist()),
        verdict='usable',
        refusals=(),
        total_mass=_sum_of_read(links),
        moving_mass=_sum_of_read(link for link in links if link.carrier),
        samples=samples,
        seed=seed,
        joint_names=(),
        links=links,
        bodies=(),
        joints=joint_entries(examination.description),
        findings=(),
    )


def _sum_of_read(links):
    # Of a refused robot some masses may have no number.
    return float(sum(link.mass for link in links if not math.isnan(link.mass)))


def _with_dynamics(report, study, link, point, tell):
    model = study.model
    is_guessed = link is None
    if link is None:
        link = model.tip_link
    check_link(model.tree.links, link)
    report = replace(
        report,
        joint_names=model.joint_names,
        model=model,
        bodies=body_entries(model.tree, study.description),
    )
    if not model.joint_names:
        return report
    index = {name: i for i, name in enumerate(model.joint_names)}
    joints: list = []
    for joint in report.joints:
        tell(0.05 + 0.5 * len(joints) / len(report.joints), f'gravity: {joint.name}')
        if joint.name in index:
            i = index[joint.name]
            joint = replace(
                joint, range_note=study.range_notes[i], gravity=gravity_load(study, i, link, point)
            )
        joints.append(joint)
    tell(0.6, 'payload')
    payload = replace(payload_entry(study, link, point), is_guessed=is_guessed)
    tell(0.8, 'mass matrix')
    return replace(
        report, joints=tuple(joints), payload=payload, conditioning=conditioning_entry(study)
    )


def _source_name(source):
    if isinstance(source, os.PathLike):
        return os.fspath(source)
    if isinstance(source, bytes) or '<' in source or '\n' in source:
        return 'URDF text'
    return source


def _checked_point(point):
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


def _check_numbers(samples, seed):
    if not 1 <= samples <= _MOST_SAMPLES:
        raise ArgumentError(f'samples: expected 1 to {_MOST_SAMPLES}, got {samples}')
    if seed < 0:
        raise ArgumentError(f'seed: expected an integer >= 0, got {seed}')
