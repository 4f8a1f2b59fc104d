"""The page as a file: complete, self-contained, the numbers of the report, no name believed."""

import base64
import hashlib
from html.parser import HTMLParser
import re
import subprocess
import sys

from dynamics_node.report.html import page, write_html
from dynamics_node.report.html_numbers import number, percent, quantity
import pytest
from support.hostile_robot import hostile_urdf
from support.report_pages import (
    arm7_report,
    block_report,
    hostile_report,
    pendulum_report,
    refused_report,
    unlimited_report,
    weak_report,
)

REPORTS = {'arm7': arm7_report, 'weak': weak_report, 'unlimited': unlimited_report,
           'pendulum': pendulum_report, 'refused': refused_report, 'block': block_report,
           'hostile': hostile_report}
# Every attribute by which a browser asks for something.
ASKING = {'src', 'href', 'srcset', 'poster', 'action', 'formaction', 'background', 'data',
          'manifest', 'cite', 'ping', 'longdesc', 'xlink:href'}


class Reader(HTMLParser):
    """Elements, attributes, tables and texts of a page, as a browser without scripts has them."""

    def __init__(self, markup):
        super().__init__()
        self.elements, self.tables, self.text = [], {}, []
        self.scripts, self.styles, self.title = [], [], ''
        self._open, self._rows = [], None
        self.feed(markup)
        self.close()

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        self.elements.append((tag, attributes))
        if tag not in ('meta', 'wbr', 'input', 'br', 'img', 'link'):
            self._open.append(tag)
        if tag == 'table':
            self._rows = self.tables.setdefault(attributes['aria-label'], [])
        elif tag == 'tr':
            self._rows.append([])
        elif tag in ('td', 'th'):
            self._rows[-1].append('')
        elif tag == 'script':
            self.scripts.append('')
        elif tag == 'style':
            self.styles.append('')

    def handle_endtag(self, tag):
        assert self._open.pop() == tag, f'</{tag}> closes something else'

    def handle_data(self, data):
        if 'script' in self._open:
            self.scripts[-1] += data
        elif 'style' in self._open:
            self.styles[-1] += data
        elif 'title' in self._open:
            self.title += data
        else:
            self.text.append(data)
            if 'td' in self._open or 'th' in self._open:
                self._rows[-1][-1] += data

    @property
    def words(self):
        """All text that is seen, in one line."""
        return ' '.join(' '.join(self.text).replace('\u00a0', ' ').split())


def plain(cell):
    return cell.replace('\u00a0', ' ')


@pytest.mark.parametrize('report', REPORTS.values(), ids=REPORTS)
def test_every_element_is_closed_and_every_table_is_complete(report):
    report = report()
    seen = Reader(page(report))
    assert [row[0] for row in seen.tables['links'][1:]] == [link.name for link in report.links]
    if report.joints:
        assert [row[0] for row in seen.tables['joints'][1:]] == [
            joint.name for joint in report.joints]
    if report.bodies:
        assert [row[0] for row in seen.tables['bodies'][1:]] == [
            body.joint for body in report.bodies]
    identifiers = [attributes['id'] for _, attributes in seen.elements if 'id' in attributes]
    assert len(identifiers) == len(set(identifiers))
    anchors = [attributes['href'] for _, attributes in seen.elements if 'href' in attributes]
    assert {anchor.removeprefix('#') for anchor in anchors} <= set(identifiers)
    assert report.robot in seen.title and report.robot in ''.join(seen.text)


@pytest.mark.parametrize('report', REPORTS.values(), ids=REPORTS)
def test_the_page_refers_to_nothing_outside(report):
    seen = Reader(page(report()))
    for tag, attributes in seen.elements:
        assert tag not in ('link', 'img', 'iframe', 'object', 'embed', 'base', 'form', 'video')
        for name in ASKING & set(attributes):
            assert attributes[name].startswith('#'), (tag, name)
        assert not [name for name in attributes if name.startswith('on')]
    for style in [*seen.styles, *(attributes.get('style') or '' for _, attributes
                                  in seen.elements)]:
        assert 'url(' not in style and '@import' not in style
    assert not re.search(r'https?://', ''.join(seen.styles) + ''.join(seen.text))


@pytest.mark.parametrize('report', REPORTS.values(), ids=REPORTS)
def test_the_policy_allows_these_scripts_and_no_network(report):
    seen = Reader(page(report()))
    policy = next(attributes['content'] for tag, attributes in seen.elements
                  if attributes.get('http-equiv') == 'Content-Security-Policy')
    rules = dict(rule.split(' ', 1) for rule in policy.split('; '))
    assert rules['default-src'] == "'none'" and rules['img-src'] == 'data: blob:'
    kinds = [attributes.get('type') for tag, attributes in seen.elements if tag == 'script']
    run = [script for script, kind in zip(seen.scripts, kinds, strict=True) if kind is None]
    digests = [base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
               for script in run]
    assert rules['script-src'].split() == [f"'sha256-{digest}'" for digest in digests]


def test_plotly_is_there_once_and_only_where_something_is_drawn():
    drawn, refused = page(arm7_report()), page(refused_report())
    assert drawn.count('plotly.js v') == 1
    assert 'plotly.js v' not in refused and len(refused) < 60_000
    assert len(page(block_report())) < 60_000


def test_the_table_of_joints_says_what_the_report_says():
    report = arm7_report()
    rows = Reader(page(report)).tables['joints'][1:]
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


def test_the_tables_of_links_and_bodies_say_what_the_report_says():
    report = arm7_report()
    seen = Reader(page(report))
    for link, row in zip(report.links, seen.tables['links'][1:], strict=True):
        assert row[1] == (number(link.mass) if link.has_inertial else '0')
        assert row[-1] == (link.carrier or 'stands on the base')
    for body, row in zip(report.bodies, seen.tables['bodies'][1:], strict=True):
        assert row[1] == body.link and row[3] == number(body.mass)
        assert row[2] == (', '.join(body.lumped) or '–')


def test_a_link_that_cannot_exist_says_why():
    report = refused_report()
    row = next(row for row in Reader(page(report)).tables['links'] if row[0] == 'upper')
    why = next(link.violations for link in report.links if link.name == 'upper')
    assert why and row[4] == 'no: ' + '; '.join(why)


def test_the_first_screen_has_the_numbers_that_matter_most():
    report = weak_report()
    words = Reader(page(report)).words
    worst = max((joint for joint in report.joints if joint.gravity is not None),
                key=lambda joint: joint.gravity.share)
    for said in (f'mass {number(report.total_mass)} kg',
                 f'{quantity(report.moving_mass, "kg")} of it moves',
                 f'largest share of an effort limit {percent(worst.gravity.share)}',
                 f'payload at every pose {number(report.payload.everywhere, 3)} kg',
                 f'{number(report.conditioning.median, 3)} worst '
                 f'{number(report.conditioning.worst, 3)}'):
        assert plain(said) in words


@pytest.mark.parametrize('report', [weak_report, refused_report])
def test_findings_come_first_and_whole(report):
    report = report()
    seen = Reader(page(report))
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
    words = Reader(page(report)).words.lower()
    assert report.refusals
    assert 'refused' in words and all(reason.lower() in words for reason in report.refusals)


def test_names_that_are_attacks_stay_names():
    markup = page(hostile_report())
    seen = Reader(markup)
    _, names = hostile_urdf()
    safe = Reader(page(arm7_report()))
    # The same elements as with harmless names: nothing of a name has become one.
    tags = sorted(tag for tag, _ in seen.elements if tag != 'wbr')
    assert tags == sorted(tag for tag, _ in safe.elements if tag != 'wbr')
    assert [row[0] for row in seen.tables['links'][1:]] == [
        names[row[0]] for row in safe.tables['links'][1:]]


def test_the_file_is_written_in_utf_8_and_replaced(tmp_path):
    path = tmp_path / 'page.html'
    path.write_text('old')
    write_html(pendulum_report(), path)
    text = path.read_text(encoding='utf-8')
    assert text == page(pendulum_report())
    assert text.startswith('<!DOCTYPE html>') and '<meta charset="utf-8">' in text


def test_plotly_is_only_loaded_when_a_page_is_written():
    code = ('import sys, dynamics_node.report.html\n'
            'assert not any(name.split(".")[0] == "plotly" for name in sys.modules)')
    subprocess.run([sys.executable, '-c', code], check=True)
