"""The tables of links and bodies."""

from dynamics_node.report.formatting import number
from support.page_reader import reading
from support.report_pages import arm7_report, refused_report


def test_the_tables_of_links_and_bodies_say_what_the_report_says():
    report = arm7_report()
    seen = reading(arm7_report)
    for link, row in zip(report.links, seen.tables['links'][1:], strict=True):
        assert row[1] == (number(link.mass) if link.has_inertial else '0')
        assert row[-1] == (link.carrier or 'stands on the base')
    for body, row in zip(report.bodies, seen.tables['bodies'][1:], strict=True):
        assert row[1] == body.link and row[3] == number(body.mass)
        assert row[2] == (', '.join(body.lumped) or '–')


def test_a_link_that_cannot_exist_says_why():
    report = refused_report()
    row = next(row for row in reading(refused_report).tables['links'] if row[0] == 'upper')
    why = next(link.violations for link in report.links if link.name == 'upper')
    assert why and row[4] == 'no: ' + '; '.join(why)
