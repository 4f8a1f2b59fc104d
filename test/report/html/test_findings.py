"""The findings on the page."""

from dataclasses import replace

from dynamics_node.report import Finding
from dynamics_node.report.html.findings import findings_section
import pytest
from support.page_reader import Reader, reading
from support.report_pages import arm7_report, refused_report, weak_report


@pytest.mark.parametrize('report', [weak_report, refused_report])
def test_findings_come_first_and_whole(report):
    seen, report = reading(report), report()
    assert report.findings
    articles = [attributes['class'] for tag, attributes in seen.elements if tag == 'article']
    found = [f'finding {finding.severity}' for finding in report.findings]
    refusals = ['finding problem'] * bool(report.refusals)
    assert articles == refusals + found
    words = seen.words.lower()
    for finding in report.findings:
        for sentence in (finding.what, finding.effect, finding.advice, *finding.subjects):
            assert ' '.join(sentence.lower().split()) in words
    assert words.index(report.findings[-1].what.lower()) < words.index('as they stand in the urdf')


def test_a_refused_robot_is_called_so_with_every_reason():
    report = refused_report()
    words = reading(refused_report).words.lower()
    assert report.refusals
    assert 'refused' in words and all(reason.lower() in words for reason in report.refusals)


def test_a_robot_without_findings_is_praised():
    assert not arm7_report().findings
    assert 'Nothing looks wrong.' in reading(arm7_report).words


def test_many_names_are_folded_away_but_there():
    finding = Finding('note', 'kind', tuple(f'joint_{k}' for k in range(7)), 'what', '', 'do it')
    seen = Reader(findings_section(replace(arm7_report(), findings=(finding,))))
    assert 'and 3 more' in seen.words
    assert all(name in ''.join(seen.text) for name in finding.subjects)
    assert 'No problems and no warnings.' in seen.words
