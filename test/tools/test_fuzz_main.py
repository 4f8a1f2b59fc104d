"""`python -m fuzz`: no findings in the package, and `--replay`."""

import os
from pathlib import Path
import re
import subprocess
import sys

ROOT = Path(__file__).parents[2]


def fuzz(*arguments):
    """Run `python -m fuzz` as a process."""
    return subprocess.run(
        [sys.executable, '-m', 'fuzz', *map(str, arguments)],
        text=True,
        capture_output=True,
        cwd=ROOT / 'tools',
        env={**os.environ, 'PYTHONPATH': os.pathsep.join(sys.path)},
        check=False,
    )


def test_two_thousand_inputs_find_nothing(tmp_path):
    run = fuzz('--inputs', 2000, '--folder', tmp_path)
    assert run.returncode == 0, run.stdout + run.stderr
    assert re.search(r'^ *inputs +1000 +1000 *$', run.stdout, re.M)
    assert re.search(r'^ *findings +0 +0 *$', run.stdout, re.M)
    # A share of the broken inputs is accepted.
    taken = re.search(r'^ *taken +(\d+) +(\d+) *$', run.stdout, re.M)
    assert int(taken[1]) > 100
    assert int(taken[2]) > 1000
    assert list(tmp_path.iterdir()) == []


def test_an_input_is_replayed(tmp_path):
    description = tmp_path / 'a.urdf'
    description.write_text('<robot')
    run = fuzz('--replay', description)
    assert run.stdout == "['refused: it is not XML: unclosed token, line']\n", run.stderr
    run = fuzz('--replay', tmp_path)
    assert run.returncode == 2
    assert 'expected a file ending in .urdf or .hex' in run.stderr
