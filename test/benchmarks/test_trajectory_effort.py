"""A short run of the trajectory measurement."""

from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture
def bench(monkeypatch):
    # Only for the import: folders of the root, such as launch, would hide packages.
    with monkeypatch.context() as patch:
        patch.syspath_prepend(str(ROOT))
        return import_module('benchmarks.trajectory_effort')


def test_every_way_is_timed_against_efforts_from_positions_alone(bench):
    rows = bench.measure(count=300, rounds=3)
    assert [row['what'] for row in rows] == [
        'efforts, from positions alone',
        'efforts, accelerations missing',
        'efforts, nothing missing',
        'largest payload',
        'scipy and Pinocchio: efforts, from positions alone',
    ]
    assert rows[0]['ratio'] == '1'
    assert all(float(row['ratio']) > 0.0 for row in rows)


def test_efforts_that_differ_are_not_timed(bench, monkeypatch):
    honest = bench.by_pinocchio
    monkeypatch.setattr(
        bench, 'by_pinocchio', lambda *arguments: lambda: honest(*arguments)() + 1e-3
    )
    with pytest.raises(RuntimeError, match='efforts of Pinocchio: expected a difference'):
        bench.measure(count=50, rounds=1)


def test_the_derivatives_are_those_of_the_positions(bench):
    robot = bench.arm7()
    time, q, qd, qdd = bench.motion(robot, 2001)
    np.testing.assert_allclose(np.gradient(q, time, axis=0)[1:-1], qd[1:-1], atol=1e-4)
    np.testing.assert_allclose(np.gradient(qd, time, axis=0)[1:-1], qdd[1:-1], atol=1e-4)
