"""Checks of a link's inertial parameters: refused values and suspicious ones."""

import numpy as np

from .description import Inertial
from ..inertia.consistency import rounding_of, tensor_violations


def inertial_findings(
    name: str, inertial: Inertial, is_moved: bool
) -> tuple[list[str], list[str]]:
    """
    Judge one link's mass and inertia tensor.

    Parameters
    ----------
    name : str
        Name of the link.
    inertial : Inertial
    is_moved : bool
        Whether any joint moves the link. The inertia tensor of a link that is fixed to the base
        changes no torque, so a wrong one is only suspicious.

    Returns
    -------
    problems, warnings : list of str
        Problems refuse the robot: negative mass, a tensor that is not positive semidefinite.
        Warnings do not: principal moments that violate the triangle inequality are physically
        impossible, but common in published robots.

    """
    problems: list[str] = []
    if inertial.mass < 0.0:
        problems.append(f"link '{name}': mass is {inertial.mass:.6g} kg, must be >= 0")
    tolerance = rounding_of(inertial.pseudo_inertia)
    principal = np.asarray(np.linalg.eigvalsh(inertial.tensor), dtype=float)
    findings = [
        f"link '{name}': inertia is not physical: {violation}"
        for violation in tensor_violations(principal, tolerance)
    ]
    if principal[0] < -tolerance and is_moved:
        return problems + findings, []
    return problems, findings
