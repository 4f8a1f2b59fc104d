"""Mass matrices that are singular or ill-conditioned."""

from __future__ import annotations

from .context import FindingContext
from .kinds import NOTE, PROBLEM
from ..formatting import plain_number
from ..report import Finding

# Condition number at which seven of sixteen digits are lost.
_ILL_CONDITIONED = 1e7


def find_singular_mass_matrix(context: FindingContext, is_explained: bool) -> list[Finding]:
    """
    Return a finding if D cannot be inverted, or hardly.

    Parameters
    ----------
    context : FindingContext
    is_explained : bool
        Whether another finding explains why D is singular.

    Returns
    -------
    list of Finding

    """
    conditioning = context.report.conditioning
    if conditioning is None or is_explained:
        return []
    joint = conditioning.weakest_joint
    if not conditioning.is_positive_definite:
        return [
            Finding(
                PROBLEM,
                'singular_mass_matrix',
                (joint,),
                'the mass matrix is not positive definite at some of '
                f"{conditioning.samples} positions, joint '{joint}' has the largest part in it",
                'the node refuses to be enabled at such a position, and forward_dynamics has no '
                'answer',
                'give the links that this joint moves a mass and a tensor; where three axes meet '
                'in one point without mass between them, two of them can become parallel',
            )
        ]
    if conditioning.worst > _ILL_CONDITIONED:
        return [
            Finding(
                NOTE,
                'ill_conditioned',
                (joint,),
                'the condition number of the mass matrix is up to '
                f'{plain_number(conditioning.worst)} (median '
                f"{plain_number(conditioning.median)}); joint '{joint}' has the least inertia",
                'no gravity torque; but accelerations (forward_dynamics, simulation) lose as many '
                'digits',
                'a rotor inertia (parameter rotor_inertia) is missing there, or a link is far too '
                'light',
            )
        ]
    return []
