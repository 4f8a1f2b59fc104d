"""ruff (with ament-compatible rules) and mypy find nothing."""

from pathlib import Path
import subprocess
import sys

import pytest

ROOT = Path(__file__).parents[1]


@pytest.mark.parametrize(
    'command',
    [
        ('ruff', 'check', '.'),
        ('ruff', 'format', '--check', '.'),
        ('mypy', 'dynamics_node', 'benchmarks'),
        ('codespell_lib',),
    ],
    ids=lambda command: ' '.join(command[:2]),
)
def test_a_linter_finds_nothing(command):
    run = subprocess.run(
        [sys.executable, '-m', *command], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stdout + run.stderr
