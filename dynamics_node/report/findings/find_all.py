"""All findings of a robot, the worst first."""

from dataclasses import replace

from .case import Case
from .coms import find_coms
from .defaults import find_defaults
from .joints import find_joints
from .kinds import KINDS
from .limits import find_limits
from .mass import find_masses
from .matrix import find_matrix
from .refusal import find_refusals
from .tensors import find_tensors, mended_inertial
from .tool import find_missing_tools
from .units import find_units
from ..report import SEVERITIES
from ..study import Study
from ...errors import RobotDescriptionError

# These say already why D is not positive definite.
_SINGULAR = {'no_inertial', 'joint_moves_nothing'}


def find_all(report, examination, study):
    """
    Judge a robot.

    Parameters
    ----------
    report : Report
        Without findings.
    examination : Examination
    study : Study or None
        None for a refused robot.

    Returns
    -------
    tuple of Finding
        Problems first, then warnings, then notes.

    """
    if study is None and examination.is_whole:
        study = _of_mended(report, examination)
    case = Case(report, examination, study)
    if not (study is not None and study.model.joint_names):
        case = replace(case, study=None)
    found = [
        *find_refusals(case),
        *find_masses(case),
        *find_tensors(case),
        *find_defaults(case),
        *find_coms(case),
        *find_missing_tools(case),
        *find_joints(case),
        *find_limits(case),
        *find_units(case),
    ]
    kinds = {finding.kind for finding in found}
    found += find_matrix(case, bool(kinds & _SINGULAR))
    if 'missing_gripper' in kinds:
        found = _said_once(found)
    order = list(KINDS)
    return tuple(
        sorted(
            found,
            key=lambda finding: (SEVERITIES.index(finding.severity), order.index(finding.kind)),
        )
    )


def _of_mended(report, examination):
    links = tuple(
        link if link.inertial is None else replace(link, inertial=mended_inertial(link.inertial))
        for link in examination.description.links
    )
    try:
        return Study.begin(
            replace(examination.description, links=links),
            report.gravity,
            report.samples,
            report.seed,
        )
    except RobotDescriptionError:
        return None


def _said_once(found):
    # A gripper without mass is told as a gripper, not as a shape once more.
    grippers = {
        name for finding in found if finding.kind == 'missing_gripper' for name in finding.subjects
    }
    return [
        finding
        for finding in found
        if not (finding.kind == 'shape_without_mass' and set(finding.subjects) <= grippers)
    ]
