"""
The model report: the dynamics of a robot as its URDF describes them, and errors in the URDF.

What may change here: the checks, their texts, and how the report is shown. Nothing in here feeds
back into the dynamics. Needs no ROS.

    from dynamics_node.report import make_report, to_json
    report = make_report('arm.urdf')
    [finding.what for finding in report.findings]

"""

from .build import make_report
from .report import Finding, Report
from .to_json import to_json

__all__ = ['Finding', 'Report', 'make_report', 'to_json']
