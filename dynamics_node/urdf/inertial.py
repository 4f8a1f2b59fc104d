"""Judging the inertial parameters of a link: what is refused and what is only suspicious."""

import numpy as np

from ..inertia import pseudo_inertia, transform_pseudo_inertia
from ..inertia.consistency import rounding_of, tensor_violations


def link_pseudo_inertia(inertial):
    """
    Return the pseudo-inertia matrix of a link in the link's frame.

    Parameters
    ----------
    inertial : Inertial

    Returns
    -------
    numpy.ndarray, shape (4, 4)
        J about the link frame's origin: kg m², kg m, kg.

    References
    ----------
    docs/mathematics.md, equations (2) to (5).

    """
    own = pseudo_inertia(inertial.mass, np.zeros(3), inertial.tensor)
    return transform_pseudo_inertia(own, inertial.placement)


def inertial_findings(name, inertial, is_moved):
    """
    Judge one link's mass and inertia tensor.

    Parameters
    ----------
    name : str
        Of the link.
    inertial : Inertial
    is_moved : bool
        Whether any joint moves the link. The inertia tensor of one that stands on the base
        has no effect on any torque, so it can be suspicious but not harmful.

    Returns
    -------
    problems, warnings : list of str
        Problems refuse the robot: negative mass, a tensor that is not positive semidefinite.
        Warnings do not: principal moments that violate the triangle inequality belong to no
        real body, but are common in published robots.

    """
    problems: list[str] = []
    warnings: list[str] = []
    if inertial.mass < 0.0:
        problems.append(f"link '{name}': mass is {inertial.mass:.6g} kg, must be >= 0")
    tolerance = rounding_of(link_pseudo_inertia(inertial))
    principal = np.linalg.eigvalsh(inertial.tensor)
    findings = [
        f"link '{name}': inertia is not physical: {violation}"
        for violation in tensor_violations(principal, tolerance)
    ]
    if principal[0] < -tolerance and is_moved:
        return problems + findings, warnings
    return problems, warnings + findings
