"""docs/report.md: its code and its commands."""

from pathlib import Path
import re

from dynamics_node.report.__main__ import parse
import pytest
from test_readme import blocks

ROOT = Path(__file__).parents[1]
TEXT = (ROOT / 'docs' / 'report.md').read_text()


def test_its_code_runs(monkeypatch, capsys):
    monkeypatch.chdir(ROOT)
    names: dict = {}
    [code] = blocks(ROOT / 'docs' / 'report.md')
    exec(compile(code, 'docs/report.md', 'exec'), names)
    assert names['plain']['format'] == 1 and not names['report'].findings
    worst, share, payload = map(float, capsys.readouterr().out.split())
    assert 0.0 < share < 1.0 < payload < abs(worst)


def test_every_command_in_it_is_one():
    commands = re.findall(r'dynamics_node(?:\.report| report) (my_arm\.urdf|-)([^|#\n]*)', TEXT)
    assert len(commands) >= 5
    for robot, options in commands:
        assert parse([robot, *options.rstrip('\\ ').split()]).robot == robot
    for option in re.findall(r'`(--[a-z-]+)', TEXT):
        with pytest.raises(SystemExit):
            parse(['--help'])
        assert option in (
            '--help',
            '--json',
            '--html',
            '--strict',
            '--gravity',
            '--samples',
            '--seed',
            '--payload-link',
            '--payload-point',
        )
