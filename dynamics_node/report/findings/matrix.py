"""Mass matrices that cannot be inverted, or hardly."""

from .kinds import NOTE, PROBLEM
from .words import number
from ..report import Finding

# Seven of sixteen digits are lost.
_ILL = 1e7


def find_matrix(case, is_explained):
    """
    Return what is wrong with D.

    Parameters
    ----------
    case : Case
    is_explained : bool
        Whether another finding says already why D is singular.

    """
    found = case.report.conditioning
    if found is None or is_explained:
        return []
    if not found.is_positive_definite:
        return [
            Finding(
                PROBLEM,
                'singular_mass_matrix',
                (found.weakest_joint,),
                f'the mass matrix is not positive definite at some of {found.samples} positions, '
                f"joint '{found.weakest_joint}' has the largest part in it",
                'the node refuses to be enabled at such a position, and forward_dynamics has no '
                'answer',
                'give the links that this joint moves a mass and a tensor; where three axes meet '
                'in one point without mass between them, two of them can fall together',
            )
        ]
    if found.worst > _ILL:
        return [
            Finding(
                NOTE,
                'ill_conditioned',
                (found.weakest_joint,),
                f'the condition number of the mass matrix is up to {number(found.worst)} (median '
                f"{number(found.median)}); joint '{found.weakest_joint}' feels least inertia",
                'no gravity torque; but accelerations (forward_dynamics, simulation) lose as many '
                'digits',
                'a rotor inertia (parameter rotor_inertia) is missing there, or a link is far too '
                'light',
            )
        ]
    return []
