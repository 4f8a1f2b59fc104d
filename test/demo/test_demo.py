"""The complete demo, with its exit codes."""

from pathlib import Path
import subprocess
import sys

from dynamics_node.demo.__main__ import main
from PIL import Image
import pytest


@pytest.fixture
def demo(child_environment, tmp_path):
    """Return a function that runs the demo to its end: exit code and output."""

    def run(*arguments):
        done = subprocess.run(
            [sys.executable, '-m', 'dynamics_node.demo.__main__', *arguments],
            cwd=tmp_path,
            env=child_environment,
            timeout=280,
            text=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        )
        return done.returncode, done.stdout

    return run


def test_the_demo_succeeds_and_draws_its_figure(demo, tmp_path):
    code, output = demo('--hold', '1')
    assert code == 0, output
    assert 'shoulder_pitch' in output and 'It falls without the node' in output
    with Image.open(tmp_path / 'demo.png') as figure:
        assert figure.size == (1440, 1200)


@pytest.mark.parametrize(
    'text, sentence',
    [
        (None, 'cannot read the robot description'),
        ('<sdf/>', 'expected a URDF with <robot> at its top, got <sdf>'),
    ],
)
def test_a_robot_that_cannot_be_run_ends_it_with_a_sentence(
    capsys, tmp_path, monkeypatch, text, sentence
):
    monkeypatch.setenv('ROS_DOMAIN_ID', '17')
    path = Path(tmp_path) / 'robot.urdf'
    if text is not None:
        path.write_text(text)
    assert main(['demo', '--robot', str(path)]) == 1
    assert sentence in ' '.join(capsys.readouterr().out.split())


def test_a_viewer_without_a_display_is_refused_before_the_start(capsys, monkeypatch):
    for variable in ('DISPLAY', 'WAYLAND_DISPLAY'):
        monkeypatch.delenv(variable, raising=False)
    assert main(['demo', '--view']) == 1
    assert capsys.readouterr().out.startswith('demo failed: the viewer needs a display')
