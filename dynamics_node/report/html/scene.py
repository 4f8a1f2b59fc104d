"""The robot as the page's 3D view wants it: how bodies follow joints, and what they weigh."""

import numpy as np

from ...model.tree import PRISMATIC

# A solid ball of aluminium is as heavy as the body it stands for: sizes one can believe.
BALL_DENSITY = 2700.0  # kg/m³

_FAR = 100.0  # rad or m; some write 1e16 for 'no limit'


def scene(model):
    """
    Return what moves on the page: plain lists, for JSON.

    The page computes positions and gravity torques of any pose itself, by the formulas of
    docs/mathematics.md, so that sliders work without a server; a test holds both against
    `RobotModel`.

    Parameters
    ----------
    model : RobotModel

    Returns
    -------
    dict
        `joints`, `neutral` (n,), `lower` and `upper` (n,) where sliders end, `continuous`,
        `prismatic`, `limit` (n,) (N m or N, None if none); per body k: `body`, `parent`,
        `slides`, `coordinate`, `multiplier`, `offset`, `placement` (3, 4), `axis`, `mass`,
        `com`, `ball` (radius, m), `ellipsoid` (3, 3) (columns: semi-axes, m); `sticks`: pairs of
        (body, point); `gravity` (3,).

    """
    tree = model.tree
    lower, upper = slider_ends(model)
    bodies = range(len(tree.moving_joint_names))
    efforts = [None if np.isnan(limit) else float(limit) for limit in model.effort_limits]
    return {
        'joints': list(model.joint_names),
        'neutral': model.neutral_position.tolist(),
        'lower': lower.tolist(),
        'upper': upper.tolist(),
        'continuous': model.is_continuous.tolist(),
        'prismatic': [kind == PRISMATIC for kind in _kinds(model)],
        'limit': efforts,
        'body': list(tree.moving_joint_names),
        'parent': tree.parent.tolist(),
        'slides': [int(value) == PRISMATIC for value in tree.joint_type],
        'coordinate': tree.q_index.tolist(),
        'multiplier': tree.multiplier.tolist(),
        'offset': tree.offset.tolist(),
        'placement': tree.joint_placement[:, :3, :].tolist(),
        'axis': tree.axis.tolist(),
        'mass': [float(tree.inertia[k, 3, 3]) for k in bodies],
        'com': [_com(tree.inertia[k]).tolist() for k in bodies],
        'ball': [ball_radius(tree.inertia[k, 3, 3]) for k in bodies],
        'ellipsoid': [ellipsoid(tree.inertia[k]).tolist() for k in bodies],
        'sticks': _sticks(tree),
        'gravity': model.gravity.tolist(),
    }


def slider_ends(model):
    """
    Return where the sliders of the joints end: their limits, or something to play with.

    Parameters
    ----------
    model : RobotModel

    Returns
    -------
    lower, upper : numpy.ndarray, shape (n,)
        rad or m; half a turn or half a meter from the neutral position where there is no limit,
        or one so far away that it says nothing.

    """
    neutral, limits = model.neutral_position, model.position_limits
    turns = np.array([kind != PRISMATIC for kind in _kinds(model)], dtype=bool)
    way = np.where(turns, np.pi, 0.5)
    is_near = np.abs(limits) < _FAR
    lower = np.where(is_near[:, 0], limits[:, 0], neutral - way)
    upper = np.where(is_near[:, 1], limits[:, 1], neutral + way)
    return lower, upper


def ball_radius(mass):
    """Return the radius of a ball of aluminium of a mass (kg), m."""
    return float(np.cbrt(3.0 * max(float(mass), 0.0) / (4.0 * np.pi * BALL_DENSITY)))


def ellipsoid(J):
    """
    Return the solid ellipsoid that has this pseudo-inertia.

    A solid ellipsoid of mass m with semi-axes a has the second moments m a² / 5 about the planes
    through its center.

    Parameters
    ----------
    J : numpy.ndarray, shape (4, 4)
        kg m², kg m, kg; in any frame.

    Returns
    -------
    numpy.ndarray, shape (3, 3)
        The semi-axes as columns, m, in that frame; zero without mass.

    References
    ----------
    docs/mathematics.md, equations (2) and (4).

    """
    mass = float(J[3, 3])
    if mass <= 0.0:
        return np.zeros((3, 3))
    com = _com(J)
    moments, directions = np.linalg.eigh(J[:3, :3] - mass * np.outer(com, com))
    # What is a little below zero is rounding of a flat body.
    return directions * np.sqrt(5.0 * np.maximum(moments, 0.0) / mass)


def _kinds(model):
    """Return the kinds of the independent joints, in the order of q."""
    tree = model.tree
    kinds = dict(zip(tree.moving_joint_names, tree.joint_type.tolist(), strict=True))
    return [kinds[name] for name in model.joint_names]


def _com(J):
    return J[:3, 3] / J[3, 3] if J[3, 3] > 0.0 else np.zeros(3)


def _sticks(tree):
    """Return the lines of the stick figure: pairs of (body, point in its frame); -1: base."""
    sticks = []
    for k, parent in enumerate(tree.parent):
        sticks.append([[int(parent), [0.0, 0.0, 0.0]], [k, [0.0, 0.0, 0.0]]])
    carriers = {int(parent) for parent in tree.parent}
    for k in range(len(tree.moving_joint_names)):
        # The last body of a chain goes on to the farthest of its links, the tool say.
        if k not in carriers:
            tips = [link.placement[:3, 3] for link in tree.links.values() if link.body == k]
            far = max(tips, key=np.linalg.norm)
            if far.any():
                sticks.append([[k, [0.0, 0.0, 0.0]], [k, far.tolist()]])
    return sticks
