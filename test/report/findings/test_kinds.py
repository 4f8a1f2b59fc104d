"""Every kind of finding: used, explained, and only as severe as it says."""

from pathlib import Path
import re

from dynamics_node.report.findings import KINDS
from dynamics_node.report.report import SEVERITIES

ROOT = Path(__file__).parents[3]
SOURCES = ROOT / 'dynamics_node' / 'report' / 'findings'


def test_every_kind_is_found_by_somebody_and_tested():
    code = ' '.join(path.read_text() for path in SOURCES.glob('*.py') if path.name != 'kinds.py')
    tests = ' '.join(
        path.read_text()
        for path in Path(__file__).parent.glob('test_*.py')
        if path != Path(__file__)
    )
    for kind, (severities, meaning) in KINDS.items():
        assert f"'{kind}'" in code, kind
        assert f"'{kind}'" in tests, kind
        assert set(severities) <= set(SEVERITIES) and severities and meaning


def test_the_document_explains_every_kind_as_it_is():
    rows = re.findall(
        r'^\| `(\w+)` \| ([a-z, ]+) \| (.+?) \|',
        (ROOT / 'docs' / 'report.md').read_text(),
        re.MULTILINE,
    )
    assert [kind for kind, *_ in rows] == list(KINDS)
    for kind, severities, meaning in rows:
        assert severities.split(', ') == list(KINDS[kind][0]), kind
        assert meaning == KINDS[kind][1], kind
