"""
What is wrong or worth knowing, each with what it does to this robot.

What may change here: what is looked for and where the lines are drawn. `kinds.py` lists every
kind, and docs/report.md explains them.

"""


def find_all(report, examination, study):
    """Return all findings, the worst first."""
    return ()
