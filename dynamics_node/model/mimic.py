"""Mimic joints: which independent joint each movable joint follows in the end."""


def resolve_mimic(joints):
    """
    Follow every chain of mimic joints to its leader.

    Parameters
    ----------
    joints : iterable of Joint
        The movable joints; chains end and have no cycle (the description is checked).

    Returns
    -------
    dict of str to (str, float, float)
        Joint name → leader, multiplier, offset with q = multiplier * q_leader + offset;
        an independent joint is its own leader with 1 and 0.

    References
    ----------
    docs/mathematics.md, equation (19).

    """
    by_name = {joint.name: joint for joint in joints}
    return {name: _resolve(name, by_name) for name in by_name}


def _resolve(name, by_name):
    multiplier, offset = 1.0, 0.0
    while (mimic := by_name[name].mimic) is not None:
        # q = m (m' q'' + o') + o, one link of the chain at a time.
        offset += multiplier * mimic.offset
        multiplier *= mimic.multiplier
        name = mimic.leader
    return name, multiplier, offset
