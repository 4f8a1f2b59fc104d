"""Programs: in one line what is missing, and what to do."""

from pathlib import Path
import sys

from dynamics_node import programs
import pytest

ROOT = Path(__file__).parents[1]
ALL = ('dynamics_node', 'effort_guard', 'markers', 'simulated_robot', 'demo')


@pytest.fixture
def only_found(monkeypatch):
    """Return a function after which Python finds no module but those of a folder and its own."""

    def only(folder):
        monkeypatch.setattr(sys, 'path', [str(folder)])
        for name in [*sys.modules]:
            if name.partition('.')[0] in ('rclpy', 'dynamics_interfaces'):
                monkeypatch.delitem(sys.modules, name)

    return only


def refusal(program, capsys):
    assert getattr(programs, program)() == 1
    (line,) = capsys.readouterr().err.splitlines()
    return line


@pytest.mark.parametrize('program', ALL)
def test_without_ros_a_program_tells_to_source_it(program, only_found, capsys, tmp_path):
    only_found(tmp_path)
    line = refusal(program, capsys)
    assert line.startswith(f"{program}: no module 'rclpy'") and 'source /opt/ros' in line


# The folder of the checkout has the sources of the messages: Python finds it as a package.
@pytest.mark.parametrize('has_sources', [False, True])
@pytest.mark.parametrize('program', ['dynamics_node', 'effort_guard', 'demo'])
def test_without_messages_a_program_tells_to_build_them(
    program, has_sources, only_found, capsys, tmp_path
):
    (tmp_path / 'rclpy.py').touch()
    if has_sources:
        (tmp_path / 'dynamics_interfaces').symlink_to(ROOT / 'dynamics_interfaces')
    only_found(tmp_path)
    line = refusal(program, capsys)
    assert line.startswith(f"{program}: no module 'dynamics_interfaces'")
    assert 'ln -s dynamics_node/dynamics_interfaces' in line and 'colcon build' in line


def test_an_error_of_the_program_itself_is_raised(monkeypatch, tmp_path):
    monkeypatch.setattr(programs, '__package__', 'broken')
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / 'broken').mkdir()
    (tmp_path / 'broken' / 'program.py').write_text('import no_such_module\n')
    with pytest.raises(ModuleNotFoundError, match='no_such_module'):
        programs._run('broken', 'program')
