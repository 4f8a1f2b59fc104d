"""
The model report: what a URDF says about a robot's dynamics, and what is wrong with it.

What may change here: what is looked for, what is said about it, and how it is shown. Nothing in
here feeds back into the dynamics. Needs no ROS.

    from dynamics_node.report import make_report, to_json
    report = make_report('arm.urdf')
    [finding.what for finding in report.findings]

"""

from .make import make_report
from .report import Finding, Report
from .to_json import to_json

__all__ = ['Finding', 'Report', 'make_report', 'to_json']
