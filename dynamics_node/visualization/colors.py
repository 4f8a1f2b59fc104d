"""Colors: red, green, blue, opacity."""

BODY = (0.98, 0.75, 0.15, 1.0)
PAYLOAD = (0.85, 0.35, 0.95, 1.0)
INERTIA = (0.35, 0.65, 1.0, 0.3)
PAYLOAD_INERTIA = (0.85, 0.35, 0.95, 0.3)
PROBLEM = (1.0, 0.1, 0.1, 0.9)
GRAVITY = (0.6, 0.85, 1.0, 1.0)
JOINT = (0.8, 0.8, 0.85, 0.18)
TEXT = (1.0, 1.0, 1.0, 1.0)
# Nobody can say how much a torque is where the joint has no limit.
UNLIMITED = (0.65, 0.65, 0.65, 1.0)
OVER_THE_LIMIT = (1.0, 0.0, 0.0, 1.0)


def of_load(load):
    """
    Return the color of a torque: green, over yellow at half the limit, to red.

    Parameters
    ----------
    load : float
        Size of the torque, of its limit.

    Returns
    -------
    tuple of float, length 4

    """
    if load >= 1.0:
        return OVER_THE_LIMIT
    return (min(2.0 * load, 1.0) * 0.95, min(2.0 - 2.0 * load, 1.0) * 0.85, 0.1, 1.0)
