"""
The scripts of the set-up: their decisions, pins and messages, without the long steps.

"""

import os
import pathlib
import re
import shutil
import stat
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCRIPTS = sorted((ROOT / 'scripts').rglob('*.sh')) + [ROOT / '.ci' / 'run']
# The packages of bench.in are optional, and pinned there.
BENCH = ROOT / 'requirements' / 'bench.in'
INPUTS = sorted(set((ROOT / 'requirements').glob('*.in')) - {BENCH})
LOCKS = sorted((ROOT / 'requirements' / 'lock').glob('*.txt'))
LOCKS_WITH_ROS = [path for path in LOCKS if 'numpy1' not in path.name]
PYTHONS = ('python3.10', 'python3.11', 'python3.12', 'python3.13')
PREAMBLE = """
set -euo pipefail
cd "$1"
for part in messages release stamps progress ros_mode find_python preflight steps rivals; do
    source "scripts/lib/$part.sh"
done
"""


def run_bash(code, folder=ROOT, **environment):
    """
    Run bash code below the set-up's functions, with nothing in the environment but PATH.

    """
    environment.setdefault('PATH', '/usr/bin:/bin')
    return subprocess.run(
        [shutil.which('bash'), '-c', PREAMBLE + code, 'bash', str(folder)],
        check=False,
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
    )


def rclpy_paths():
    """
    Return the part of this environment in which a Python finds rclpy.

    """
    return {
        name: value
        for name, value in os.environ.items()
        if name in ('AMENT_PREFIX_PATH', 'PYTHONPATH', 'LD_LIBRARY_PATH')
        or name.startswith('_ROS_WHEELS')
    }


def assert_one_sentence(result, *parts):
    assert result.returncode == 1
    lines = result.stderr.splitlines()
    assert len(lines) == 1, result.stderr
    assert lines[0].startswith('error: ')
    for part in parts:
        assert part in lines[0]


def write_program(path, text='#!/bin/sh\nexit 127\n'):
    path.write_text(text)
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return path


@pytest.fixture
def tools(tmp_path):
    """
    Make a folder of links to the ordinary tools: no cmake, no make, no compiler, no Python.

    """
    folder = tmp_path / 'tools'
    folder.mkdir()
    for name in (
        'awk',
        'bash',
        'cut',
        'find',
        'getconf',
        'grep',
        'head',
        'sed',
        'sh',
        'sha256sum',
        'sort',
        'tr',
        'uname',
        'wc',
    ):
        (folder / name).symlink_to(shutil.which(name))
    return folder


def names_in(path):
    """
    Names of the packages that an input file asks for, as the locks spell them.

    """
    lines = (line.partition('#')[0].strip() for line in path.read_text().splitlines())
    names = (re.split(r'[\[<>=~!;\s]', line)[0] for line in lines if line)
    return [re.sub('[-_.]+', '-', name).lower() for name in names]


def release_of(lock):
    """
    Return the release of ROS 2 whose wheels a lock pins; None for a sourced ROS 2.

    """
    if lock not in LOCKS_WITH_ROS:
        return None
    return lock.stem.partition('-')[2] or 'jazzy'


def pins_in(path):
    return dict(line.split('==') for line in path.read_text().splitlines())


@pytest.mark.parametrize('script', SCRIPTS, ids=lambda path: path.name)
def test_bash_accepts_the_script(script):
    subprocess.run(['bash', '-n', str(script)], check=True)


@pytest.mark.parametrize('lock', LOCKS, ids=lambda path: path.stem)
def test_a_lock_holds_pins_and_nothing_else(lock):
    lines = lock.read_text().splitlines()
    assert lines == sorted(lines)
    for line in lines:
        assert re.fullmatch(r'[a-z0-9-]+==[0-9][0-9a-z.]*', line), line


def test_there_is_a_lock_for_every_supported_python():
    assert {path.stem for path in LOCKS} == {
        *PYTHONS,
        'python3.12-numpy1',
        *(f'{python}-kilted' for python in PYTHONS),
    }


@pytest.mark.parametrize('lock', LOCKS, ids=lambda path: path.stem)
@pytest.mark.parametrize('inputs', INPUTS, ids=lambda path: path.stem)
def test_a_lock_pins_every_package_that_is_asked_for(lock, inputs):
    if inputs.stem.startswith('ros-') and inputs.stem != f'ros-{release_of(lock)}':
        pytest.skip('this lock is for another ROS 2')
    assert set(names_in(inputs)) <= set(pins_in(lock))


@pytest.mark.parametrize('python', PYTHONS)
def test_the_libraries_are_the_same_on_every_release(python):
    jazzy, kilted = (
        {name: version for name, version in pins_in(lock).items() if not name.startswith('ros-')}
        for lock in LOCKS
        if lock.stem in (python, f'{python}-kilted')
    )
    assert jazzy == kilted


def test_what_is_measured_beside_is_pinned_where_it_is_named():
    lines = run_bash('rival_requirements').stdout.splitlines()
    assert [re.split('[=;]', line)[0] for line in lines] == [
        'drake',
        'roboticstoolbox-python',
        'jax',
        'jaxlib',
        'frax',
    ]
    for line in lines:
        assert re.match(r'[a-z-]+==[0-9.]+(;|$)', line), line


def test_only_the_benchmarks_install_what_is_measured_beside(tmp_path):
    # A copy, because plan_steps looks at what is installed here.
    for name in (
        'scripts',
        'requirements',
        'dynamics_interfaces',
        'dynamics_node',
        'launch',
        'config',
        'resource',
        'setup.py',
        'setup.cfg',
        'package.xml',
    ):
        (tmp_path / name).symlink_to(ROOT / name)
    planned = {
        purpose: run_bash(
            f'dynamics_root=$PWD; mode=wheels; plan_steps {purpose}; echo "${{pending[*]}}"',
            tmp_path,
        ).stdout.split()
        for purpose in ('demo', 'test', 'bench')
    }
    assert 'packages' in planned['demo']
    assert planned['test'] == planned['demo']
    assert planned['bench'] == planned['test'] + ['rivals']


@pytest.mark.parametrize('lock', LOCKS, ids=lambda path: path.stem)
def test_a_lock_keeps_what_ros_can_work_with(lock):
    pins = pins_in(lock)
    assert int(pins['setuptools'].split('.')[0]) < 80
    assert pins['empy'] == '3.3.4'
    if lock not in LOCKS_WITH_ROS:
        assert pins['numpy'].startswith('1.')
        assert pins['pytest'].startswith('7.')
        assert not [name for name in pins if name.startswith('ros-')]


def test_make_without_a_target_explains_every_target():
    make = shutil.which('make')
    if make is None:
        pytest.skip('make is not installed')
    listed = subprocess.run(
        [make, '-C', str(ROOT), '--no-print-directory'], text=True, capture_output=True, check=True
    ).stdout.splitlines()
    phony = re.search(r'^\.PHONY: (.*)$', (ROOT / 'Makefile').read_text(), re.MULTILINE).group(1)
    assert [line.split()[0] for line in listed] == phony.split()
    assert all(len(line.split()) > 1 for line in listed)


def test_a_python_that_does_not_run_is_passed_over(tmp_path, tools):
    write_program(tools / 'python3.12')
    home = tmp_path / 'home'
    folder = home / '.pyenv' / 'versions' / '3.12.99' / 'bin'
    folder.mkdir(parents=True)
    good = write_program(folder / 'python3', '#!/bin/sh\necho "ok /some/where/python3.12"\n')
    result = run_bash('find_python; echo "$good_python"', PATH=str(tools), HOME=str(home))
    assert result.stdout == '/some/where/python3.12\n', (result.stderr, good)


def test_without_any_python_the_message_names_the_packages(tmp_path, tools):
    result = run_bash('find_python', PATH=str(tools), HOME=str(tmp_path))
    assert_one_sentence(result, 'expected a CPython 3.10 to 3.13', 'apt install python3')


def test_what_an_unfit_python_lacks_is_said(tmp_path, tools):
    write_program(
        tools / 'python3.12',
        '#!/bin/sh\necho "no has no module venv (apt install python3.12-venv)"\n',
    )
    result = run_bash('find_python', PATH=str(tools), HOME=str(tmp_path))
    assert_one_sentence(result, 'python3.12 has no module venv', 'apt install python3.12-venv')


def test_the_python_of_these_tests_is_fit_or_says_why():
    result = run_bash(f'probe_python "{sys.executable}"')
    assert result.stdout.startswith(('ok /', 'no ')), result.stderr


def test_without_ros_the_wheels_are_used():
    assert run_bash('ros_mode').stdout == 'wheels\n'


def test_a_sourced_jazzy_is_found_by_its_rclpy(tmp_path):
    marker = tmp_path / 'opt' / 'share' / 'ament_index' / 'resource_index' / 'packages' / 'rclpy'
    marker.parent.mkdir(parents=True)
    marker.touch()
    result = run_bash(
        'ros_mode', ROS_DISTRO='jazzy', AMENT_PREFIX_PATH=f'{tmp_path}:{tmp_path}/opt'
    )
    assert result.stdout == f'sourced {tmp_path}/opt\n'


@pytest.mark.parametrize('release', ['jazzy', 'kilted', 'lyrical', 'rolling'])
def test_every_sourced_release_has_an_environment_of_its_own(release, tmp_path):
    marker = tmp_path / 'share' / 'ament_index' / 'resource_index' / 'packages' / 'rclpy'
    marker.parent.mkdir(parents=True)
    marker.touch()
    result = run_bash(
        'ros_mode; echo "$venv $build_base $install_base"',
        ROS_DISTRO=release,
        AMENT_PREFIX_PATH=str(tmp_path),
    )
    end = '' if release == 'jazzy' else f'-{release}'
    assert result.stdout.splitlines() == [
        f'sourced {tmp_path}',
        f'.venv{end} build{end} install{end}',
    ], result.stderr


def test_the_wheels_of_kilted_have_an_environment_of_their_own():
    result = run_bash('ros_mode; echo "$venv $build_base $install_base"', ROS='kilted')
    assert result.stdout.split() == ['wheels', '.venv-kilted', 'build-kilted', 'install-kilted']


def test_the_wheels_of_a_release_are_those_that_are_asked_for():
    result = run_bash('mode=$(ros_mode); requirement_files test; lock_of 3.12', ROS='kilted')
    names = [pathlib.Path(path).stem for path in result.stdout.split()]
    assert names == ['build', 'runtime', 'demo', 'ros-kilted', 'test', 'python3.12-kilted']


def test_another_release_of_ros_is_refused():
    assert_one_sentence(
        run_bash('ros_mode', ROS_DISTRO='humble'),
        'jazzy kilted lyrical rolling',
        'ROS_DISTRO=humble',
    )
    assert_one_sentence(run_bash('ros_mode', ROS='humble'), 'jazzy kilted', 'ROS=humble')


def test_a_release_without_wheels_has_to_be_sourced():
    assert_one_sentence(
        run_bash('ros_mode', ROS='lyrical'),
        'ROS=lyrical',
        'install ROS 2 lyrical, source its setup.bash',
    )


def test_another_release_than_the_sourced_one_is_refused():
    assert_one_sentence(
        run_bash('ros_mode', ROS_DISTRO='jazzy', ROS='kilted'),
        'expected ROS=jazzy',
        'got ROS=kilted',
    )


def test_a_sourced_ros_without_rclpy_is_refused(tmp_path, tools):
    result = run_bash(
        'first_good_python() { good_python=; rejected=; }; find_ros_python',
        PATH=str(tools),
        HOME=str(tmp_path),
        ROS_DISTRO='kilted',
    )
    assert_one_sentence(result, 'ROS_DISTRO=kilted', 'imports rclpy', 'ros-kilted-ros-base')


def test_a_sourced_ros_brings_its_own_python_also_a_newer_one():
    # As if 3.9 were the newest that the wheels have.
    limit = 'newest_minor=9; '
    assert 'is Python 3.' in run_bash(f'{limit} probe_python "{sys.executable}"').stdout
    result = run_bash(
        f'{limit} find_ros_python; echo "$good_python"',
        PYTHON=sys.executable,
        ROS_DISTRO='rolling',
        **rclpy_paths(),
    )
    assert result.stdout.startswith('/'), result.stderr


def test_a_missing_cmake_is_named(tools):
    assert_one_sentence(run_bash('check_build_tools', PATH=str(tools)), 'apt install cmake')


def test_an_old_cmake_is_named(tools):
    write_program(tools / 'cmake', '#!/bin/sh\necho "cmake version 3.16.3"\n')
    assert_one_sentence(
        run_bash('check_build_tools', PATH=str(tools)),
        'expected cmake 3.21 or newer',
        "got '3.16.3'",
    )


def test_a_missing_compiler_is_named(tools):
    write_program(tools / 'cmake', '#!/bin/sh\necho "cmake version 3.28.3"\n')
    write_program(tools / 'make')
    write_program(tools / 'c++')
    assert_one_sentence(
        run_bash('check_build_tools', PATH=str(tools)), 'apt install build-essential'
    )


def test_another_machine_is_told_to_install_ros(tools):
    (tools / 'uname').unlink()
    write_program(tools / 'uname', '#!/bin/sh\necho aarch64\n')
    assert_one_sentence(
        run_bash('check_platform', PATH=str(tools)),
        'got aarch64',
        'install ROS 2 Jazzy',
        'pip install .',
    )


def test_another_machine_goes_on_with_a_sourced_ros(tools):
    (tools / 'uname').unlink()
    write_program(tools / 'uname', '#!/bin/sh\necho aarch64\n')
    result = run_bash(
        'mode="sourced /opt/ros/kilted"; pending=(venv)\n'
        'find_ros_python() { echo on; }; check_first',
        PATH=str(tools),
        ROS_DISTRO='kilted',
    )
    assert result.stdout == 'on\n', result.stderr


def test_a_key_changes_with_texts_names_and_contents(tmp_path):
    (tmp_path / 'a').write_text('1')
    (tmp_path / 'b').write_text('1')
    (tmp_path / 'scripts').symlink_to(ROOT / 'scripts')
    keys = run_bash(
        """
        key_of x -- a; key_of y -- a; key_of x -- b; key_of x --; key_of -- a
        echo 2 >a; key_of x -- a; echo -n 1 >a; key_of x -- a
    """,
        tmp_path,
    ).stdout.split()
    assert keys[0] == keys[-1]
    assert len(set(keys)) == len(keys) - 1


def test_a_step_is_done_only_with_its_own_key(tmp_path):
    (tmp_path / '.venv').mkdir()
    (tmp_path / 'scripts').symlink_to(ROOT / 'scripts')
    result = run_bash(
        """
        stamp_is demo 1 || echo absent
        write_stamp demo 1; stamp_is demo 1 && echo done
        stamp_is demo 2 || echo other
        drop_stamp demo; stamp_is demo 1 || echo dropped
    """,
        tmp_path,
    )
    assert result.stdout.split() == ['absent', 'done', 'other', 'dropped']


def test_a_failed_step_shows_the_end_of_its_output(tmp_path):
    (tmp_path / 'scripts').symlink_to(ROOT / 'scripts')
    result = run_bash(
        """
        begin_steps 2
        run_step first bash -c 'seq 1 100'
        run_step second bash -c 'seq 201 300; exit 7'
        echo not reached
    """,
        tmp_path,
    )
    assert result.returncode == 1
    assert 'not reached' not in result.stdout
    assert '[2/2] second' in result.stdout
    shown = result.stderr.split()
    assert '300' in shown and '100' not in shown
    assert "step 'second' failed with exit code 7" in result.stderr
    assert 'log/setup.log' in result.stderr


def test_every_test_that_needs_ros_runs_on_every_release():
    paths = run_bash('source scripts/lib/ros_tests.sh; printf "%s\\n" "${ros_tests[@]}"')
    paths = [ROOT / path for path in paths.stdout.split()]
    assert all(path.exists() for path in paths)
    needs_ros = re.compile(
        r'^ *(?:from|import) (?:rclpy|\w+_msgs|std_srvs|dynamics_interfaces|dynamics_node\.ros|'
        r'support\.processes)\b',
        re.MULTILINE,
    )
    for module in sorted((ROOT / 'test').rglob('test_*.py')):
        if needs_ros.search(module.read_text()):
            assert any(module.is_relative_to(path) for path in paths), module


def isolated(**environment):
    result = run_bash(
        """
        dynamics_root=${CHECKOUT:-$PWD}
        source scripts/isolate.sh
        echo "$ROS_DOMAIN_ID $ROS_AUTOMATIC_DISCOVERY_RANGE"
    """,
        **environment,
    )
    return result.stdout.split()


def test_every_checkout_has_a_domain_of_its_own_on_this_machine_only():
    domains = set()
    for number in range(20):
        domain, discovery_range = isolated(CHECKOUT=f'/home/user/checkout{number}')
        assert 1 <= int(domain) <= 101
        assert discovery_range == 'LOCALHOST'
        domains.add(domain)
    assert len(domains) > 10


def test_a_domain_that_the_user_has_set_stays():
    assert isolated(ROS_DOMAIN_ID='0', ROS_AUTOMATIC_DISCOVERY_RANGE='SUBNET') == ['0', 'SUBNET']


def test_a_folder_is_put_in_front_of_a_path_once(tmp_path):
    (tmp_path / 'scripts').symlink_to(ROOT / 'scripts')
    result = run_bash(
        """
        dynamics_root=$PWD
        source scripts/lib/base_env.sh
        WAY=/a:/b:/c; prepend_path WAY /b; prepend_path WAY /d; echo "$WAY"
        prepend_path FRESH /b; echo "$FRESH"
    """,
        tmp_path,
    )
    assert result.stdout.split() == ['/d:/b:/a:/c', '/b']
