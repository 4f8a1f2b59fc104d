"""The report as a program: what it prints where, and how it ends."""

import io
import json
import os
from pathlib import Path
import pty
import subprocess
import sys

from dynamics_node.report.__main__ import main, parse
import pytest
from support.arms import arm, changed
from support.robots import ARM7

ROOT = Path(__file__).parents[2]
BROKEN = changed(arm(), 'link2', mass=-1.0)
WARNED = changed(arm(), 'link2', mass=0.007)


@pytest.fixture
def robot(tmp_path):
    """Return a function that writes a robot and returns its path."""

    def write(text):
        path = tmp_path / 'my robot.urdf'
        path.write_text(text)
        return str(path)

    return write


def run(*arguments, code=None, **options):
    """Start the program in a process of its own."""
    command = ['-m', 'dynamics_node.report'] if code is None else ['-c', code]
    return subprocess.run(
        [sys.executable, *command, *map(str, arguments)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
        **options,
    )


def test_it_prints_tables_and_ends_with_the_verdict(robot, capsys):
    assert main([robot(arm()), '--samples', '100']) == 0
    printed = capsys.readouterr()
    assert printed.err == ''
    assert printed.out.strip().endswith('arm: usable; 0 problems, 0 warnings, 0 notes')
    for words in ('Links', 'What each joint moves', 'Largest gravity torque', 'It can hold'):
        assert words in printed.out
    assert '\x1b' not in printed.out


@pytest.mark.parametrize(
    'text, strict, code',
    [
        (arm(), True, 0),
        (arm(tool=False), True, 0),
        (WARNED, True, 1),
        (BROKEN, True, 1),
        (WARNED, False, 0),
        (BROKEN, False, 0),
    ],
    ids=[
        'clean',
        'a note',
        'a warning',
        'refused',
        'a warning, not strict',
        'refused, not strict',
    ],
)
@pytest.mark.parametrize('json_too', [False, True])
def test_strict_fails_for_problems_and_warnings(robot, capsys, text, strict, code, json_too):
    options = ['--strict'] * strict + ['--json'] * json_too
    assert main([robot(text), '--samples', '50', *options]) == code
    if json_too:
        json.loads(capsys.readouterr().out)


def test_json_is_all_that_is_printed(robot, capsys):
    assert main([robot(BROKEN), '--json', '--samples', '50']) == 0
    printed = capsys.readouterr()
    plain = json.loads(printed.out)
    assert (plain['format'], plain['verdict'], printed.err) == (1, 'refused', '')


@pytest.mark.parametrize(
    'text, words',
    [
        (None, "'nowhere.urdf', which does not exist"),
        ('', 'it is empty'),
        ('<robot', 'it is not XML'),
        ('<html/>', 'expected <robot>'),
        ('<robot xmlns:xacro="http://ros.org/xacro"><xacro:a/></robot>', 'expand it first'),
    ],
)
def test_what_cannot_be_read_is_one_clear_error(robot, capsys, text, words):
    path = 'nowhere.urdf' if text is None else robot(text)
    assert main([path]) == 2
    printed = capsys.readouterr()
    assert printed.out == ''
    assert printed.err.startswith('error: ') and printed.err.count('\n') == 1
    assert words in printed.err


@pytest.mark.parametrize(
    'options, words',
    [
        (
            ['--payload-link', 'unknown'],
            "link: 'unknown' is not a link of the robot; expected one of base, link1",
        ),
        (['--samples', '0'], 'samples: expected 1 to'),
        (['--seed', '-1'], 'seed: expected'),
    ],
)
def test_wrong_values_say_what_was_expected(robot, capsys, options, words):
    assert main([robot(arm()), *options]) == 2
    assert words in capsys.readouterr().err


def test_a_folder_is_not_a_urdf_file(tmp_path, capsys):
    assert main([str(tmp_path)]) == 2
    assert 'which is a folder' in capsys.readouterr().err


def test_it_reads_standard_input(monkeypatch, capsys):
    monkeypatch.setattr(sys, 'stdin', io.TextIOWrapper(io.BytesIO(arm().encode())))
    assert main(['-', '--samples', '50']) == 0
    assert 'URDF text' in capsys.readouterr().out


def test_options_reach_the_report(robot, capsys):
    assert (
        main(
            [
                robot(arm()),
                '--json',
                '--samples',
                '70',
                '--seed',
                '9',
                '--gravity',
                '0',
                '0',
                '-1.62',
                '--payload-link',
                'link4',
                '--payload-point',
                '0',
                '0',
                '0.1',
            ]
        )
        == 0
    )
    plain = json.loads(capsys.readouterr().out)
    assert (plain['samples'], plain['seed'], plain['gravity']) == (70, 9, [0.0, 0.0, -1.62])
    assert (plain['payload']['link'], plain['payload']['point']) == ('link4', [0.0, 0.0, 0.1])


def test_a_page_is_written_and_its_path_printed(robot, tmp_path, capsys):
    page = tmp_path / 'page.html'
    assert main([robot(arm()), '--json', '--samples', '50', '--html', str(page)]) == 0
    printed = capsys.readouterr()
    json.loads(printed.out)
    assert f'wrote {page}' in printed.err and page.stat().st_size > 10_000
    assert main([robot(arm()), '--samples', '50', '--html', str(tmp_path / 'no' / 'p.html')]) == 2
    assert 'No such file' in capsys.readouterr().err


def refusing(*names):
    """Return a program that is the report where some packages are not installed."""
    return (
        'import sys\n'
        'class Refuse:\n'
        '    def find_spec(self, name, path=None, target=None):\n'
        f'        if name.split(".")[0] in {names!r}:\n'
        '            raise ModuleNotFoundError(f"No module named {name!r}", name=name)\n'
        'sys.meta_path.insert(0, Refuse())\n'
        'from dynamics_node.report.__main__ import main, parse\n'
        'sys.exit(main())\n'
    )


def test_it_works_where_no_ros_is_installed():
    answer = run(
        ARM7,
        '--samples',
        200,
        code=refusing(
            'rclpy',
            'dynamics_interfaces',
            'std_msgs',
            'sensor_msgs',
            'mujoco',
            'matplotlib',
            'plotly',
            'jinja2',
        ),
    )
    assert (answer.returncode, answer.stderr) == (0, '')
    assert answer.stdout.strip().endswith('arm7: usable; 0 problems, 0 warnings, 0 notes')


def test_what_is_not_installed_is_named_with_what_to_type(tmp_path):
    answer = run(ARM7, '--samples', 10, code=refusing('rich'))
    assert answer.returncode == 2 and 'pip install rich; or use --json' in answer.stderr
    assert (
        run(ARM7, '--samples', 10, '--json', code=refusing('rich', 'plotly', 'jinja2')).returncode
        == 0
    )
    for package in ('plotly', 'jinja2'):
        answer = run(ARM7, '--samples', 10, '--html', tmp_path / 'p.html', code=refusing(package))
        assert answer.returncode == 2 and 'pip install jinja2 plotly' in answer.stderr


def test_it_can_be_piped_into_head_and_into_a_file_of_another_encoding():
    env = {**os.environ, 'PYTHONIOENCODING': 'ascii', 'PYTHONUTF8': '0'}
    answer = run(ARM7, '--samples', 10, env=env)
    assert (answer.returncode, answer.stderr) == (0, '') and 'kg m?' in answer.stdout
    whole = subprocess.run(
        f"'{sys.executable}' -m dynamics_node.report '{ARM7}' --json --samples 10 | head -n 1",
        shell=True,
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert (whole.stdout, whole.stderr) == ('{\n', '')


def shell(command):
    """Run a line of bash in the checkout."""
    return subprocess.run(
        ['bash', '-c', command], cwd=ROOT, capture_output=True, text=True, timeout=120, check=False
    )


@pytest.mark.parametrize(
    'text, options, code',
    [
        (WARNED, '--strict --json', 1),
        (WARNED, '--strict', 1),
        (WARNED, '', 0),
        (arm(), '--strict', 0),
    ],
)
def test_its_exit_code_is_the_same_where_the_reader_has_read_enough(robot, text, options, code):
    answer = shell(
        f"'{sys.executable}' -m dynamics_node.report '{robot(text)}' --samples 20 "
        f'{options} | (exec 0<&-; sleep 0.1); echo ${{PIPESTATUS[0]}}'
    )
    assert (answer.stdout, answer.stderr) == (f'{code}\n', '')


def test_it_reads_a_pipe_that_has_a_path(robot):
    answer = shell(
        f"'{sys.executable}' -m dynamics_node.report <(cat '{robot(arm())}') --samples 20"
    )
    assert (answer.returncode, answer.stderr) == (0, '')
    assert 'arm: usable' in answer.stdout


def test_an_empty_path_is_refused(capsys):
    assert main(['']) == 2
    assert "got '', which is empty" in capsys.readouterr().err


def test_defaults():
    options = parse(['a.urdf'])
    assert (options.robot, options.gravity, options.samples, options.seed) == (
        'a.urdf',
        (0.0, 0.0, -9.81),
        4096,
        1,
    )
    assert not (options.json or options.strict or options.html)


@pytest.mark.parametrize(
    'arguments',
    [
        [],
        ['a.urdf', '--gravity', '0', '0'],
        ['a.urdf', '--gravity', '0', '0', 'nan'],
        ['a.urdf', '--samples', 'many'],
        ['a.urdf', '--no-such-option'],
    ],
)
def test_unusable_arguments_end_with_2(arguments, capsys):
    with pytest.raises(SystemExit) as caught:
        parse(arguments)
    assert caught.value.code == 2
    assert 'usage: report' in capsys.readouterr().err


def test_negative_numbers_are_no_options():
    assert parse(['a.urdf', '--gravity', '-9.81', '0', '-0.001']).gravity == [-9.81, 0.0, -0.001]


def test_help_says_everything(capsys):
    with pytest.raises(SystemExit) as caught:
        parse(['--help'])
    text = capsys.readouterr().out
    assert caught.value.code == 0
    for words in (
        '--strict',
        '--json',
        '--html',
        'exit codes:',
        'xacro',
        '--payload-link',
        'm/s^2',
        'notes',
    ):
        assert words in text
    assert max(map(len, text.splitlines())) <= 99


def test_the_progress_bar_is_on_standard_error_and_only_on_a_terminal():
    master, slave = pty.openpty()
    run = subprocess.Popen(
        [sys.executable, '-m', 'dynamics_node.report', str(ARM7)],
        stdout=subprocess.PIPE,
        stderr=slave,
        text=True,
        # Where a CI runs there may be none, or one that cannot go back.
        env={**os.environ, 'TERM': 'xterm'},
    )
    os.close(slave)
    shown = b''
    try:
        while part := os.read(master, 4096):
            shown += part
    except OSError:  # the other end is closed
        pass
    finally:
        os.close(master)
    out = run.communicate(timeout=120)[0]
    assert run.returncode == 0
    assert b'%' in shown and '\x1b' not in out and ' % ' not in out.split('Largest')[0]
