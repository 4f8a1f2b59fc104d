"""Colors: red, green, blue, opacity, each from 0 to 1."""

Color = tuple[float, float, float, float]

BODY = (0.98, 0.75, 0.15, 1.0)
PAYLOAD = (0.85, 0.35, 0.95, 1.0)
INERTIA = (0.35, 0.65, 1.0, 0.3)
PAYLOAD_INERTIA = (0.85, 0.35, 0.95, 0.3)
PROBLEM = (1.0, 0.1, 0.1, 0.9)
GRAVITY = (0.6, 0.85, 1.0, 1.0)
JOINT = (0.8, 0.8, 0.85, 0.18)
TEXT = (1.0, 1.0, 1.0, 1.0)
# Without an effort limit there is no load to color by.
UNLIMITED = (0.65, 0.65, 0.65, 1.0)
OVER_THE_LIMIT = (1.0, 0.0, 0.0, 1.0)


def of_load(load: float) -> Color:
    """
    Return the color of a torque: green, over yellow at half the limit, to red.

    Parameters
    ----------
    load : float
        Magnitude of the torque relative to its limit, ≥ 0.

    Returns
    -------
    tuple of float, length 4

    """
    if load >= 1.0:
        return OVER_THE_LIMIT
    return (min(2.0 * load, 1.0) * 0.95, min(2.0 - 2.0 * load, 1.0) * 0.85, 0.1, 1.0)
