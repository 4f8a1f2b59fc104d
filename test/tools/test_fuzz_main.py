"""`python -m fuzz`: no findings in the package, `--replay`, and digests of errors."""

import re

from fuzz.error_digest import error_digest
from support.python_process import run_tool


def test_two_thousand_inputs_find_nothing(tmp_path):
    run = run_tool('fuzz', '--inputs', 2000, '--folder', tmp_path)
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
    run = run_tool('fuzz', '--replay', description)
    assert run.stdout == "['refused: it is not XML: unclosed token, line']\n", run.stderr
    run = run_tool('fuzz', '--replay', tmp_path)
    assert run.returncode == 2
    assert 'expected a file ending in .urdf or .hex' in run.stderr


def test_a_digest_omits_names_and_numbers():
    assert error_digest("link 'a b': <mass> value: expected a finite number, got '1e999'") == (
        'link …: … value: expected a finite'
    )
    assert error_digest('link "it\'s": mass is -2.5 kg, must be >= 0') == (
        'link …: mass is … kg, must'
    )
    assert error_digest(r"link 'a\'b' is defined 2 times") == 'link … is defined … times'
