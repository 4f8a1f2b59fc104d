"""The complete demo, with its exit codes."""

from pathlib import Path

from dynamics_node.demo.__main__ import main
from PIL import Image
import pytest
from support.python_process import run_python


def test_the_demo_succeeds_and_draws_its_figure(child_environment, tmp_path):
    module = 'dynamics_node.demo.__main__'
    run = run_python('-m', module, '--hold', '1', cwd=tmp_path, env=child_environment, timeout=280)
    assert run.returncode == 0, run.stdout + run.stderr
    assert 'shoulder_pitch' in run.stdout and 'It falls without the node' in run.stdout
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
