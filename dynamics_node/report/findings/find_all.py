"""All findings of a robot, in descending severity."""

from __future__ import annotations

from dataclasses import replace

from .centers_of_mass import find_distant_centers
from .context import FindingContext
from .joints import find_joints
from .kinds import KINDS, PROBLEM
from .limits import find_limits
from .mass import find_masses
from .mass_matrix import find_singular_mass_matrix
from .missing_tool import find_missing_tools
from .placeholders import find_placeholders
from .tensors import find_tensors, with_absolute_values
from .units import find_units
from ..report import Finding, Report, SEVERITIES
from ..workspace_analysis import WorkspaceAnalysis
from ...errors import RobotDescriptionError
from ...urdf import PartialRead

# Kinds that explain why D is not positive definite.
_SINGULAR = {'no_inertial', 'joint_moves_nothing'}
# Refusals whose finding has a kind of its own, with its effect.
_EXPLAINED_REFUSALS = ('mass is -', 'inertia is not physical')
# Largest number of refusals with a finding each.
_SEPARATE_REFUSALS = 3
_REFUSAL_ADVICE = (
    'fix it: RobotModel and the node refuse the description until then; if it is made from a '
    '.xacro file, fix that file'
)


def find_all(
    report: Report, examination: PartialRead, analysis: WorkspaceAnalysis | None
) -> tuple[Finding, ...]:
    """
    Run all checks.

    Parameters
    ----------
    report : Report
        Without findings.
    examination : PartialRead
    analysis : WorkspaceAnalysis or None
        None for a refused robot.

    Returns
    -------
    tuple of Finding
        Problems first, then warnings, then notes.

    """
    if analysis is None and examination.is_whole:
        analysis = _with_possible_inertials(report, examination)
    if analysis is not None and not analysis.model.joint_names:
        analysis = None
    context = FindingContext(report, examination, analysis)
    findings = [
        *find_refusals(context),
        *find_masses(context),
        *find_tensors(context),
        *find_placeholders(context),
        *find_distant_centers(context),
        *find_missing_tools(context),
        *find_joints(context),
        *find_limits(context),
        *find_units(context),
    ]
    kinds = {finding.kind for finding in findings}
    findings += find_singular_mass_matrix(context, bool(kinds & _SINGULAR))
    findings = _without_duplicate_grippers(findings)
    order = list(KINDS)
    return tuple(
        sorted(
            findings,
            key=lambda finding: (SEVERITIES.index(finding.severity), order.index(finding.kind)),
        )
    )


def find_refusals(context: FindingContext) -> list[Finding]:
    """Return a finding for each refusal that no other finding explains."""
    reasons = list(context.report.refusals)
    if context.examination.is_whole:
        reasons = [
            reason
            for reason in reasons
            if not any(words in reason for words in _EXPLAINED_REFUSALS)
        ]
    if len(reasons) > _SEPARATE_REFUSALS:
        reasons = [f'{len(reasons)} reasons: ' + '; '.join(reasons)]
    return [
        Finding(
            PROBLEM,
            'refused',
            (),
            reason,
            'nothing can be computed for this robot',
            _REFUSAL_ADVICE,
        )
        for reason in reasons
    ]


def _with_possible_inertials(report: Report, examination: PartialRead) -> WorkspaceAnalysis | None:
    # The effects of impossible inertials are computed with positive ones.
    links = tuple(
        link
        if link.inertial is None
        else replace(link, inertial=with_absolute_values(link.inertial))
        for link in examination.description.links
    )
    try:
        return WorkspaceAnalysis.from_description(
            replace(examination.description, links=links),
            report.gravity,
            report.samples,
            report.seed,
        )
    except RobotDescriptionError:
        return None


def _without_duplicate_grippers(findings: list[Finding]) -> list[Finding]:
    # A massless gripper is reported as a missing gripper, not also as a massless shape.
    grippers = {
        name
        for finding in findings
        if finding.kind == 'missing_gripper'
        for name in finding.subjects
    }
    return [
        finding
        for finding in findings
        if not (finding.kind == 'shape_without_mass' and set(finding.subjects) <= grippers)
    ]
