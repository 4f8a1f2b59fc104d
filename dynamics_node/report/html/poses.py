"""The poses that the 3D view can show at the press of a button."""

from ..formatting import number, percent, quantity


def poses(report):
    """
    Return the poses worth looking at.

    Parameters
    ----------
    report : Report
        Of a usable robot.

    Returns
    -------
    list of dict
        `label`, `caption` (a sentence), `q` (n,) in rad or m, and `joint`: the place of the
        joint whose worst pose it is, None for the others.

    """
    found = [
        _pose(
            'neutral',
            'The neutral pose: zero, or the nearest position within the limits.',
            report.model.neutral_position.tolist(),
        )
    ]
    payload = report.payload
    if payload is not None and payload.limiting_position is not None:
        found.append(
            _pose(
                'least payload',
                f'Here {payload.limiting_joint} is at its limit with '
                f'{quantity(payload.everywhere, "kg", 3)} at {payload.link}: that can be held at '
                'every pose.',
                payload.limiting_position,
            )
        )
    if payload is not None and payload.best_position and payload.best_joint is not None:
        found.append(
            _pose(
                'most payload',
                f'The best of the sampled poses: {quantity(payload.best, "kg", 3)} at '
                f'{payload.link}, limited by {payload.best_joint}.',
                payload.best_position,
            )
        )
    D = report.conditioning
    if D is not None:
        found.append(
            _pose(
                'worst conditioning',
                f'The condition number of D is {number(D.worst, 3)} here; '
                f'{D.weakest_joint} moves the least inertia.',
                D.position,
            )
        )
    loads = {joint.name: joint for joint in report.joints if joint.gravity is not None}
    for place, name in enumerate(report.joint_names):
        if name in loads:
            found.append(_pose(name, _worst(loads[name]), loads[name].gravity.position, place))
    return found


def _worst(joint):
    load = joint.gravity
    share = load.share
    of_limit = (
        ''
        if share != share
        else (f', {percent(share)} of its limit of {quantity(joint.effort, joint.effort_unit)}')
    )
    return (
        f'The worst pose of {joint.name}: gravity asks for '
        f'{quantity(load.worst, joint.effort_unit)}{of_limit}.'
    )


def _pose(label, caption, q, joint=None):
    return {'label': label, 'caption': caption, 'q': [float(value) for value in q], 'joint': joint}
