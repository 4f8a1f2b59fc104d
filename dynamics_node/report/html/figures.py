"""All figures of the page and the 3D view as one piece of plain data."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .joint_plots import curve_figure, histogram_figure
from .plots import distribution_figure, gravity_of, mass_figure, plot_text, worst_figure
from .scene import poses, scene
from ..formatting import number, vector
from ..report import JointEntry, Report


def page_data(report: Report) -> dict[str, Any] | None:
    """
    Return the data that the scripts of the page draw.

    Parameters
    ----------
    report : Report

    Returns
    -------
    dict or None
        `figures` and `arm`; None without figures: for a refused robot, or one without movable
        joints.

    """
    by_name = {joint.name: joint for joint in report.joints if joint.gravity is not None}
    if report.model is None or not by_name:
        return None
    joints = [by_name[name] for name in report.joint_names]
    return {
        'figures': {
            'worst': worst_figure(joints),
            'distribution': distribution_figure(joints),
            'mass': mass_figure(report.bodies),
            'joint': {
                'names': [joint.name for joint in joints],
                'first': _most_loaded(joints),
                'curves': [
                    curve_figure(joint, gravity_of(joint).position[index])
                    for index, joint in enumerate(joints)
                ],
                'histograms': [histogram_figure(joint) for joint in joints],
            },
        },
        'arm': {
            'robot': scene(report.model),
            'poses': poses(report),
            'labels': {
                'joints': [plot_text(body.joint) for body in report.bodies],
                'bodies': [
                    f'{plot_text(body.link)}<br>{number(body.mass)} kg<br>'
                    f'center of mass {vector(body.com, 3)} m'
                    for body in report.bodies
                ],
            },
        },
    }


def _most_loaded(joints: Sequence[JointEntry]) -> int:
    # The index of the joint nearest to its limit, or else of that with the largest torque.
    def load(index: int) -> tuple[float, float]:
        gravity = gravity_of(joints[index])
        return (gravity.share if gravity.share == gravity.share else -1.0, gravity.magnitude)

    return max(range(len(joints)), key=load)
