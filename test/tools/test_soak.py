"""A soak of some seconds: exit code and table."""

import os
from pathlib import Path
import subprocess
import sys

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture
def run():
    """Return a function that runs the soak: exit code and output."""
    path = os.pathsep.join(
        [str(ROOT / 'test'), str(ROOT / 'tools'), str(ROOT), os.environ.get('PYTHONPATH', '')]
    )

    def run(*arguments):
        done = subprocess.run(
            [sys.executable, '-m', 'soak', *arguments],
            text=True,
            timeout=110,
            env={**os.environ, 'PYTHONPATH': path},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        )
        return done.returncode, done.stdout

    return run


def test_some_seconds_of_soak_lose_nothing(run):
    code, output = run('--minutes', '0.13', '--seed', '1')
    assert code == 0, output
    assert 'Nothing lost, nothing leaked, nothing out of limits.' in output
    for row in ('joint states accepted', 'state to command, p99', 'memory of the node'):
        assert row in output
