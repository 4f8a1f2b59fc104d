"""Why a description cannot be used."""

from .kinds import PROBLEM
from ..report import Finding

_ADVICE = (
    'mend it: RobotModel and the node refuse the description until then; where it comes '
    'from a .xacro, in the .xacro'
)
# More than these are told in one.
_APART = 3
# These have findings of their own, with what they do.
_ELSEWHERE = ('mass is -', 'inertia is not physical')


def find_refusals(case):
    """Return one finding for each reason that no other finding explains."""
    reasons = case.report.refusals
    if case.examination.is_whole:
        reasons = [
            reason for reason in reasons if not any(words in reason for words in _ELSEWHERE)
        ]
    if len(reasons) > _APART:
        reasons = [f'{len(reasons)} reasons: ' + '; '.join(reasons)]
    return [
        Finding(PROBLEM, 'refused', (), reason, 'nothing can be computed for this robot', _ADVICE)
        for reason in reasons
    ]
