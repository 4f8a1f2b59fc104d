"""All that the page draws, as one piece of plain data."""

from .escape import plot_text
from .plot_curve import curve_figure, histogram_figure
from .plot_distribution import distribution_figure
from .plot_mass import mass_figure
from .plot_worst import worst_figure
from .poses import poses
from .scene import scene
from ..formatting import number, vector


def page_data(report):
    """
    Return what the scripts of the page draw.

    Parameters
    ----------
    report : Report

    Returns
    -------
    dict or None
        `figures` and `arm`; None if there is nothing to draw: a refused robot, or one without
        movable joints.

    """
    loads = {joint.name: joint for joint in report.joints if joint.gravity is not None}
    if report.model is None or not loads:
        return None
    joints = [loads[name] for name in report.joint_names]
    return {
        'figures': {
            'worst': worst_figure(joints),
            'distribution': distribution_figure(joints),
            'mass': mass_figure(report.bodies),
            'joint': {
                'names': [joint.name for joint in joints],
                'first': _first(joints),
                'curves': [
                    curve_figure(joint, joint.gravity.position[place])
                    for place, joint in enumerate(joints)
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
                    f'centre of mass {vector(body.com, 3)} m'
                    for body in report.bodies
                ],
            },
        },
    }


def _first(joints):
    """Return the place of the joint nearest to its limit, or of that with the largest torque."""

    def strain(place):
        load = joints[place].gravity
        return (load.share if load.share == load.share else -1.0, load.magnitude)

    return max(range(len(joints)), key=strain)
