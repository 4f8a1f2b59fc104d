"""Findings of a report by their kind."""

from dynamics_node.report import make_report


def findings(text, kind, samples=300):
    """Return the findings of a kind of a URDF."""
    report = make_report(text, samples=samples)
    return [finding for finding in report.findings if finding.kind == kind]
