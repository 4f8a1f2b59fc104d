"""A section that is measured alone takes the place of the old one, and of nothing else."""

import pytest

from benchmarks.sections import put, Section

REPORT = '# Benchmarks\n\nhead\n\n## The node\n\nold\n\n| a |\n|---|\n| 1 |\n\n## How\n\ntext\n'


def test_it_is_put_in_its_place_with_what_it_was_measured_on():
    new = put(REPORT, Section('The node', r'new \1', [{'what': 'p50', 'ratio': '1.1'}]),
              {'CPU': 'a processor', 'Python': '3.12'})
    assert new.startswith('# Benchmarks\n\nhead\n\n## The node\n\nnew \\1\n\n')
    assert new.endswith('\n\n## How\n\ntext\n')
    assert 'CPU a processor; Python 3.12.' in new
    assert '| p50 | 1.1 |' in new and 'old' not in new


def test_a_report_without_such_a_section_is_refused():
    with pytest.raises(ValueError, match='expected a section "Trajectories"'):
        put(REPORT, Section('Trajectories', '', []), {})
