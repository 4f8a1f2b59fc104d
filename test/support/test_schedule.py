"""Workers get every test once, what shares something together, and the slow ones first."""

from pathlib import Path
import re

import pytest

schedule = pytest.importorskip('support.schedule', reason='needs pytest-xdist')

ROOT = Path(__file__).parents[2]
NODE = 'test/ros/test_node.py::test_'


def test_tests_with_processes_are_spread_and_what_is_shared_stays_together():
    assert schedule.unit(NODE + 'a') != schedule.unit(NODE + 'b')
    for one, other in (
        ('inertia/test_solids.py::test_a', 'inertia/test_solids.py::test_b'),
        ('ros/test_services.py::test_a', 'ros/test_services.py::test_b'),
        ('ros/demo/test_poses.py::test_a', 'ros/demo/test_poses.py::test_b'),
        ('test_accuracy_document.py::test_a', 'dynamics/test_public_robots.py::test_b'),
    ):
        assert schedule.unit('test/' + one) == schedule.unit('test/' + other)


def test_every_test_comes_once_units_in_one_piece_and_slow_ones_first():
    nodeids = [
        *(f'test/a/test_{name}.py::test_{number}' for name in 'xyz' for number in (1, 2)),
        *(NODE + name for name in 'abcdef'),
        'test/test_code_style.py::test_a',
        'test/test_accuracy_document.py::test_a',
        'test/a/test_last.py::test_a',
        'test/dynamics/test_public_robots.py::test_a',
    ]
    order = schedule.in_order(nodeids)
    assert sorted(order) == list(range(len(nodeids)))
    units = [schedule.unit(nodeids[place]) for place in order]
    starts = [name for place, name in enumerate(units) if units[place - 1] != name]
    assert len(starts) == len(set(starts))
    assert units[:3] == ['test/test_code_style.py', 'sweep', 'sweep']
    # Files and tests with processes in turn, three of one to about two of the other.
    assert not re.search('fff|nnn', ''.join('n' if '::' in name else 'f' for name in starts[2:]))


def test_the_files_that_are_named_exist():
    names = {*schedule._TOGETHER, *schedule._SHARING, *schedule._FIRST} - {'sweep'}
    assert [name for name in names if not (ROOT / name).is_file()] == []
