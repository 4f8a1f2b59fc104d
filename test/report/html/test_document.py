"""The page as a file: complete, self-contained, no name believed."""

import base64
import hashlib
import re
import subprocess
import sys

from dynamics_node.report.html import page, write_html
import pytest
from support.hostile_robot import hostile_urdf
from support.page_reader import reading
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
# Every attribute by which a browser asks for something.
ASKING = {
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
        for name in ASKING & set(attributes):
            assert attributes[name].startswith('#'), (tag, name)
        assert not [name for name in attributes if name.startswith('on')]
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


def test_names_that_are_attacks_stay_names():
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
