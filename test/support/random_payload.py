"""A payload for the references: another link in the URDF, on a fixed joint."""

import numpy as np


def random_body(rng):
    """Return mass, center of mass and inertia tensor of eight points."""
    points, masses = rng.normal(0.0, 0.1, (8, 3)), rng.uniform(0.1, 0.5, 8)
    com = masses @ points / masses.sum()
    r = points - com
    tensor = sum(m * (p @ p * np.eye(3) - np.outer(p, p)) for m, p in zip(masses, r, strict=True))
    return masses.sum(), com, tensor


def with_payload_link(text, link, mass, com, inertia):
    """
    Return URDF text with another link fixed to a link.

    Parameters
    ----------
    text : str
    link : str
    mass : float
        kg.
    com : sequence of float
        In the link's frame, m.
    inertia : numpy.ndarray, shape (3, 3)
        About the center of mass, kg m².

    Returns
    -------
    str

    """
    tensor = ' '.join(
        f'i{row}{column}="{inertia[i][j]:.17g}"'
        for i, row in enumerate('xyz')
        for j, column in enumerate('xyz')
        if i <= j
    )
    place = ' '.join(f'{value:.17g}' for value in com)
    end = text.rindex('</robot>')
    return (
        f'{text[:end]}<link name="carried"><inertial><origin xyz="{place}"/>'
        f'<mass value="{mass:.17g}"/><inertia {tensor}/></inertial></link>'
        f'<joint name="carries" type="fixed"><parent link="{link}"/><child link="carried"/>'
        '</joint></robot>'
    )
