"""The table of joints."""

from dynamics_node.report.formatting import number, percent
from support.page_reader import plain, reading
from support.report_pages import arm7_report


def test_the_table_of_joints_says_what_the_report_says():
    report = arm7_report()
    rows = reading(arm7_report).tables['joints'][1:]
    for joint, row in zip(report.joints, rows, strict=True):
        kind, reach, worst, limit, share, left = (plain(cell) for cell in row[1:7])
        assert kind.startswith(joint.kind)
        assert limit == number(joint.effort)
        if joint.gravity is None:
            assert joint.mimics in kind and worst == share == left == '–'
            continue
        assert ' to ' in reach
        assert worst == number(joint.gravity.worst)
        assert share == plain(percent(joint.gravity.share))
        assert left == number(joint.gravity.payload_left, 3)
        for name in report.joint_names:
            assert name in row[-1]
