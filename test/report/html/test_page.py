"""The page without a browser: complete, self-contained, escaped, with the report's numbers."""

import base64
from dataclasses import replace
import hashlib
from html.parser import HTMLParser
import json
import math
import re
import subprocess
import sys

from dynamics_node.report import Finding
from dynamics_node.report.formatting import count, number, percent, quantity
from dynamics_node.report.html import page, write_html
from dynamics_node.report.html.page import breakable, environment, script_data
from dynamics_node.report.html.plots import plot_text
from dynamics_node.report.html.tables import amount, Cell, Column, name, Table
import pytest
from support.hostile_robot import hostile_urdf, NAMES
from support.page_reader import plain, Reader, reading
from support.report_pages import (
    arm7_report,
    block_report,
    hostile_report,
    pendulum_report,
    refused_report,
    unlimited_report,
    weak_report,
)

REPORTS = {
    'arm7': arm7_report,
    'weak': weak_report,
    'unlimited': unlimited_report,
    'pendulum': pendulum_report,
    'refused': refused_report,
    'block': block_report,
    'hostile': hostile_report,
}
# Attributes with addresses that a browser requests.
ADDRESSES = {
    'src',
    'href',
    'srcset',
    'poster',
    'action',
    'formaction',
    'background',
    'data',
    'manifest',
    'cite',
    'ping',
    'longdesc',
    'xlink:href',
}


@pytest.mark.parametrize('report', REPORTS.values(), ids=REPORTS)
def test_every_element_is_closed_and_every_table_is_complete(report):
    seen, report = reading(report), report()
    assert [row[0] for row in seen.tables['links'][1:]] == [link.name for link in report.links]
    if report.joints:
        assert [row[0] for row in seen.tables['joints'][1:]] == [
            joint.name for joint in report.joints
        ]
    if report.bodies:
        assert [row[0] for row in seen.tables['bodies'][1:]] == [
            body.joint for body in report.bodies
        ]
    identifiers = [attributes['id'] for _, attributes in seen.elements if 'id' in attributes]
    assert len(identifiers) == len(set(identifiers))
    anchors = [attributes['href'] for _, attributes in seen.elements if 'href' in attributes]
    assert {anchor.removeprefix('#') for anchor in anchors} <= set(identifiers)
    assert report.robot in seen.title and report.robot in ''.join(seen.text)


@pytest.mark.parametrize('report', REPORTS.values(), ids=REPORTS)
def test_the_page_refers_to_nothing_outside(report):
    seen = reading(report)
    for tag, attributes in seen.elements:
        assert tag not in ('link', 'img', 'iframe', 'object', 'embed', 'base', 'form', 'video')
        for key in ADDRESSES & set(attributes):
            assert attributes[key].startswith('#'), (tag, key)
        assert not [key for key in attributes if key.startswith('on')]
    for style in [
        *seen.styles,
        *(attributes.get('style') or '' for _, attributes in seen.elements),
    ]:
        assert 'url(' not in style and '@import' not in style
    assert not re.search(r'https?://', ''.join(seen.styles) + ''.join(seen.text))


@pytest.mark.parametrize('report', REPORTS.values(), ids=REPORTS)
def test_the_policy_allows_these_scripts_and_no_network(report):
    seen = reading(report)
    policy = next(
        attributes['content']
        for tag, attributes in seen.elements
        if attributes.get('http-equiv') == 'Content-Security-Policy'
    )
    rules = dict(rule.split(' ', 1) for rule in policy.split('; '))
    assert rules['default-src'] == "'none'" and rules['img-src'] == 'data: blob:'
    kinds = [attributes.get('type') for tag, attributes in seen.elements if tag == 'script']
    run = [script for script, kind in zip(seen.scripts, kinds, strict=True) if kind is None]
    digests = [
        base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() for script in run
    ]
    assert rules['script-src'].split() == [f"'sha256-{digest}'" for digest in digests]


def test_plotly_is_there_once_and_only_where_something_is_drawn():
    drawn, refused = page(arm7_report()), page(refused_report())
    assert drawn.count('plotly.js v') == 1
    assert 'Plots: plotly.js, © Plotly, Inc., MIT license.' in drawn
    assert 'plotly.js v' not in refused and len(refused) < 60_000
    assert len(page(block_report())) < 60_000


def test_hostile_names_stay_text():
    seen, safe = reading(hostile_report), reading(arm7_report)
    _, names = hostile_urdf()
    # The same elements as with harmless names: nothing of a name has become one.
    tags = sorted(tag for tag, _ in seen.elements if tag != 'wbr')
    assert tags == sorted(tag for tag, _ in safe.elements if tag != 'wbr')
    assert [row[0] for row in seen.tables['links'][1:]] == [
        names[row[0]] for row in safe.tables['links'][1:]
    ]


def test_the_file_is_written_in_utf_8_and_replaced(tmp_path):
    path = tmp_path / 'page.html'
    path.write_text('old')
    write_html(pendulum_report(), path)
    text = path.read_text(encoding='utf-8')
    assert text == page(pendulum_report())
    assert text.startswith('<!DOCTYPE html>') and '<meta charset="utf-8">' in text


def test_plotly_is_only_loaded_when_a_page_is_written():
    code = (
        'import sys, dynamics_node.report.html\n'
        'assert not any(name.split(".")[0] == "plotly" for name in sys.modules)'
    )
    subprocess.run([sys.executable, '-c', code], check=True)


class Markup(HTMLParser):
    """Tags, text and attributes of a piece of markup."""

    def __init__(self, markup):
        super().__init__()
        self.tags, self.data, self.attributes = [], '', []
        self.feed(markup)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes.extend(attrs)

    def handle_data(self, data):
        self.data += data


@pytest.mark.parametrize('name', NAMES)
def test_a_name_is_text_in_an_element_and_in_an_attribute(name):
    template = environment().from_string('<p title="{{ name }}">{{ name }}</p>')
    seen = Markup(template.render(name=name))
    assert (seen.tags, seen.data, seen.attributes) == (['p'], name, [('title', name)])


@pytest.mark.parametrize('name', [*NAMES, 'left_arm/tool_0'])
def test_a_name_may_be_broken_into_lines_and_stays_the_same(name):
    seen = Markup(breakable(name))
    assert seen.data == name and set(seen.tags) <= {'wbr'}
    assert len(seen.tags) == name.count('_') + name.count('/')


@pytest.mark.parametrize('name', NAMES)
def test_data_cannot_end_its_script_element(name):
    data = script_data({'name': name, name: [name]})
    assert not set('<>&\u2028\u2029') & set(data)
    assert json.loads(data) == {'name': name, name: [name]}


def test_data_without_a_number_is_refused():
    with pytest.raises(ValueError, match='JSON compliant'):
        script_data([float('nan')])


@pytest.mark.parametrize('name', NAMES)
def test_a_label_of_a_plot_has_neither_tags_nor_templates(name):
    label = plot_text(name)
    assert not set('<>{}') & set(label)
    assert Markup(label).data == name


@pytest.mark.parametrize('report', [weak_report, refused_report])
def test_findings_come_first_and_whole(report):
    seen, report = reading(report), report()
    assert report.findings
    articles = [attributes['class'] for tag, attributes in seen.elements if tag == 'article']
    found = [f'finding {finding.severity}' for finding in report.findings]
    texts = ' '.join(finding.what for finding in report.findings)
    others = [reason for reason in report.refusals if reason not in texts]
    assert articles == ['finding problem'] * bool(others) + found
    words = seen.words.lower()
    for finding in report.findings:
        for sentence in (finding.what, finding.effect, finding.advice, *finding.subjects):
            assert ' '.join(sentence.lower().split()) in words
    assert words.index(report.findings[-1].what.lower()) < words.index('as written in the urdf')


def test_a_refused_robot_lists_every_reason():
    report = refused_report()
    words = reading(refused_report).words.lower()
    assert report.refusals
    assert 'refused' in words and all(reason.lower() in words for reason in report.refusals)


def test_a_robot_without_findings_says_so():
    assert not arm7_report().findings
    assert 'No findings.' in reading(arm7_report).words


def test_many_names_are_folded_away_but_there():
    finding = Finding('note', 'kind', tuple(f'joint_{k}' for k in range(7)), 'what', '', 'do it')
    seen = Reader(page(replace(arm7_report(), findings=(finding,))))
    assert 'and 3 more' in seen.words
    assert all(name in ''.join(seen.text) for name in finding.subjects)
    assert 'No problems and no warnings.' in seen.words


def test_the_first_screen_has_the_numbers_that_matter_most():
    report = weak_report()
    words = reading(weak_report).words
    worst = max(
        (joint for joint in report.joints if joint.gravity is not None),
        key=lambda joint: joint.gravity.share,
    )
    for text in (
        f'mass {number(report.total_mass)} kg',
        f'{quantity(report.moving_mass, "kg")} of it moves',
        f'largest share of an effort limit {percent(worst.gravity.share)}',
        f'payload at every pose {number(report.payload.everywhere, 3)} kg',
        f'{number(report.conditioning.median, 3)} worst {number(report.conditioning.worst, 3)}',
    ):
        assert plain(text) in words


def test_the_badge_says_how_bad_it_is():
    assert 'arm7 usable 8 joints' in reading(arm7_report).words
    assert 'refused refused 2 joints' in reading(refused_report).words
    assert '8 joints, 1 mimic, 13 links' in reading(arm7_report).words
    counts = weak_report().counts
    badge = (
        f'fix before use: {count(counts["problem"], "problem")}'
        if counts['problem']
        else f'usable, with {count(counts["warning"], "warning")}'
    )
    assert badge in reading(weak_report).words


def test_without_limits_the_torque_itself_is_shown():
    words = reading(unlimited_report).words
    worst = max(
        joint.gravity.magnitude for joint in unlimited_report().joints if joint.gravity is not None
    )
    assert f'worst gravity torque {number(worst, 3)} N m' in words
    assert 'payload at every pose – no effort limit restricts it' in words


def test_the_payload_is_that_of_the_report():
    payload, words = arm7_report().payload, reading(arm7_report).words
    for text in (
        f'carried by {payload.link}',
        f'at every pose {quantity(payload.everywhere, "kg", 3)} , limited by '
        f'{payload.limiting_joint}',
        f'best sampled pose {quantity(payload.best, "kg", 3)} , limited by {payload.best_joint}',
    ):
        # A name may be broken into lines after an underscore.
        assert plain(text).replace('_ ', '_') in words.replace('_ ', '_')


def test_joints_without_limits_are_named():
    words = reading(unlimited_report).words.replace('_ ', '_')
    assert 'no effort limit restricts it' in words
    names = ' , '.join(unlimited_report().payload.unlimited_joints)
    assert f'not counted without an effort limit: {names}' in words


def test_the_conditioning_is_that_of_the_report():
    D, words = arm7_report().conditioning, reading(arm7_report).words.replace('_ ', '_')
    assert f'median {number(D.median, 3)} worst {number(D.worst, 3)}' in words
    assert f'weakest joint {D.weakest_joint}' in words
    assert f'positive definite at all of {count(D.samples, "pose")}' in words
    assert D.has_mixed_units and 'some joints turn and some slide' in words


def rendered(label, columns, rows):
    """Return a table as markup."""
    template = environment().from_string("{% from 'macros.html' import table %}{{ table(data) }}")
    return template.render(data=Table(label, columns, tuple(rows)))


def test_a_table_has_a_heading_for_every_column_and_row():
    markup = rendered(
        'things',
        (Column('thing'), Column('mass', 'kg', True)),
        [(name('a_b'), amount(1.5)), (Cell('<c>'), amount(math.nan))],
    )
    assert markup.count('scope="col"') == 2 and markup.count('scope="row"') == 2
    assert '<td class="number" data-value="1.5">1.5</td>' in markup
    assert '&lt;c&gt;' in markup and '<c>' not in markup


def test_missing_values_have_an_empty_sort_key_and_infinity_is_a_number():
    columns = (Column('x'), Column('y', is_number=True))
    assert 'class="number missing" data-value="">–' in rendered(
        't', columns, [(Cell('a'), amount(None))]
    )
    assert 'data-value="-Infinity">−∞' in rendered('t', columns, [(Cell('a'), amount(-math.inf))])


def test_a_row_of_another_length_is_refused():
    with pytest.raises(ValueError, match='expected 2 cells in a row, got 1'):
        Table('t', (Column('x'), Column('y')), ((Cell('a'),),))


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
        assert all(other in row[-1] for other in report.joint_names)


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
