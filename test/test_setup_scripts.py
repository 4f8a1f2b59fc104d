"""The scripts of the set-up: their decisions and messages, without the long steps."""

import os
from pathlib import Path
import re
import shutil
import stat
import subprocess
import sys

import pytest

if sys.version_info >= (3, 11):
    import tomllib

ROOT = Path(__file__).resolve().parents[1]
SCRIPTS = [*sorted((ROOT / 'scripts').rglob('*.sh')), ROOT / '.ci' / 'run']
PREAMBLE = """
set -euo pipefail
cd "$1"
dynamics_root=$PWD
for part in messages release ros_mode tools python; do
    source "scripts/lib/$part.sh"
done
"""


def run_bash(code, folder=ROOT, **environment):
    """Run bash code below the functions of the set-up, with only PATH in the environment."""
    environment.setdefault('PATH', '/usr/bin:/bin')
    return subprocess.run(
        [shutil.which('bash'), '-c', PREAMBLE + code, 'bash', str(folder)],
        check=False,
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
    )


def assert_one_sentence(result, *parts):
    """Check that a script ended with one error line that has these parts."""
    assert result.returncode == 1
    (line,) = result.stderr.splitlines()
    assert line.startswith('error: ')
    for part in parts:
        assert part in line


def write_program(path, text='#!/bin/sh\nexit 127\n'):
    path.write_text(text)
    path.chmod(path.stat().st_mode | stat.S_IXUSR)


@pytest.fixture
def tools(tmp_path):
    """Return a folder of links to the ordinary tools: no cmake, make, compiler, Python or uv."""
    folder = tmp_path / 'tools'
    folder.mkdir()
    names = 'bash cut getconf grep head mkdir rm sed sh sort tail touch uname wc'
    for name in names.split():
        (folder / name).symlink_to(shutil.which(name))
    return folder


@pytest.fixture
def checkout(tmp_path):
    """Return a folder with the scripts alone, in which nothing is installed."""
    folder = tmp_path / 'a check out'
    folder.mkdir()
    for name in ('scripts', 'pyproject.toml', 'uv.lock', '.ci'):
        (folder / name).symlink_to(ROOT / name)
    return folder


@pytest.mark.parametrize('script', SCRIPTS, ids=lambda path: path.name)
def test_bash_accepts_the_script(script):
    subprocess.run(['bash', '-n', str(script)], check=True)


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


# The lock -------------------------------------------------------------------------------------


@pytest.mark.skipif(sys.version_info < (3, 11), reason='tomllib is part of Python 3.11')
def test_the_lock_keeps_what_ros_can_work_with():
    lock = tomllib.loads((ROOT / 'uv.lock').read_text())
    versions = {}
    for package in lock['package']:
        versions.setdefault(package['name'], set()).add(package.get('version'))
    assert all(int(version.split('.')[0]) < 80 for version in versions['setuptools'])
    assert versions['empy'] == {'3.3.4'}
    # A sourced ROS 2 of Ubuntu 24.04 is compiled against numpy 1.
    assert any(version.startswith('1.') for version in versions['numpy'])
    assert {'ros-jazzy-rclpy', 'ros-kilted-rclpy'} <= set(versions)


def test_the_lock_names_only_the_public_registry():
    addresses = re.findall(r'https?://([^/"]+)/', (ROOT / 'uv.lock').read_text())
    assert set(addresses) == {'pypi.org', 'files.pythonhosted.org'}


def test_one_version_is_stated_everywhere():
    import dynamics_node

    for package in (ROOT, ROOT / 'dynamics_interfaces'):
        assert (
            f'<version>{dynamics_node.__version__}</version>'
            in (package / 'package.xml').read_text()
        )


# Python and uv --------------------------------------------------------------------------------


def test_without_uv_python_and_network_one_sentence_tells_what_to_install(tools, checkout):
    result = run_bash('find_uv', checkout, PATH=str(tools))
    assert_one_sentence(result, 'expected the program uv', 'apt install python3 python3-venv')


def test_a_uv_on_path_is_used(tools, checkout):
    write_program(tools / 'uv', '#!/bin/sh\necho "uv: $*"\n')
    assert (
        'uv: --no-config version'
        in run_bash('find_uv; uv version', checkout, PATH=str(tools)).stdout
    )


def test_without_a_fitting_python_one_sentence_tells_what_to_install(tools, checkout, tmp_path):
    write_program(tools / 'uv')
    code = 'mode=wheels; find_uv; make_venv'
    result = run_bash(code, checkout, PATH=str(tools), HOME=str(tmp_path))
    assert_one_sentence(result, 'expected a CPython 3.10 to 3.13', 'apt install python3')


def test_a_python_of_pyenv_that_is_switched_off_is_found(tools, checkout, tmp_path):
    write_program(tools / 'uv')
    folder = tmp_path / '.pyenv' / 'versions' / '3.12.99' / 'bin'
    folder.mkdir(parents=True)
    write_program(folder / 'python3', '#!/bin/sh\nexit 0\n')
    result = run_bash('find_uv; choose_python', checkout, PATH=str(tools), HOME=str(tmp_path))
    assert result.stdout == f'{folder}/python3\n', result.stderr


def test_a_python_without_headers_is_refused_with_the_package_to_install(tools, checkout):
    write_program(tools / 'uv')
    result = run_bash(
        'mode=wheels; find_uv; make_venv', checkout, PATH=str(tools), PYTHON='/no/python'
    )
    assert_one_sentence(result, '/no/python', 'apt install python3-dev')


def test_an_environment_of_another_place_release_or_python_is_made_anew(checkout):
    folder = checkout / '.venv' / 'bin'
    folder.mkdir(parents=True)
    write_program(folder / 'python', '#!/bin/sh\nexit 0\n')
    made = checkout / '.venv' / '.made-for'
    code = 'mode=wheels; venv_is_usable && echo usable || echo not'
    for text, answer in ((f'wheels {checkout} ', 'usable'), ('wheels /elsewhere ', 'not')):
        made.write_text(text + '\n')
        assert run_bash(code, checkout).stdout == answer + '\n'
    made.write_text(f'wheels {checkout} \n')
    assert run_bash(code, checkout, PYTHON='/other/python').stdout == 'not\n'


# Where ROS 2 comes from -----------------------------------------------------------------------


def sourced(folder):
    """Make a folder look like a sourced ROS 2."""
    marker = folder / 'share' / 'ament_index' / 'resource_index' / 'packages' / 'rclpy'
    marker.parent.mkdir(parents=True)
    marker.touch()
    return folder


def test_without_ros_the_wheels_are_used():
    assert run_bash('ros_mode').stdout == 'wheels\n'


@pytest.mark.parametrize('release', ['jazzy', 'kilted', 'lyrical', 'rolling'])
def test_every_sourced_release_has_an_environment_of_its_own(release, tmp_path):
    prefix = sourced(tmp_path / 'opt')
    result = run_bash(
        'ros_mode; echo "$venv $build_base $install_base"',
        ROS_DISTRO=release,
        AMENT_PREFIX_PATH=f'{tmp_path}:{prefix}',
    )
    end = '' if release == 'jazzy' else f'-{release}'
    expected = [f'sourced {prefix}', f'.venv{end} build{end} install{end}']
    assert result.stdout.splitlines() == expected, result.stderr


def test_the_wheels_of_kilted_have_an_environment_of_their_own():
    result = run_bash('ros_mode; echo "$venv $build_base $install_base"', ROS='kilted')
    assert result.stdout.split() == ['wheels', '.venv-kilted', 'build-kilted', 'install-kilted']


@pytest.mark.parametrize(
    ('environment', 'parts'),
    [
        ({'ROS_DISTRO': 'humble'}, ('jazzy kilted lyrical rolling', 'ROS_DISTRO=humble')),
        ({'ROS': 'humble'}, ('jazzy kilted', 'ROS=humble')),
        ({'ROS': 'lyrical'}, ('ROS=lyrical', 'install ROS 2 lyrical, source its setup.bash')),
        ({'ROS_DISTRO': 'jazzy', 'ROS': 'kilted'}, ('expected ROS=jazzy', 'got ROS=kilted')),
    ],
)
def test_a_release_that_cannot_be_used_is_refused(environment, parts):
    assert_one_sentence(run_bash('ros_mode', **environment), *parts)


def test_a_sourced_ros_without_rclpy_is_refused(tools):
    result = run_bash('python_versions=(); sourced_python', PATH=str(tools), ROS_DISTRO='kilted')
    if result.returncode == 0:
        pytest.skip('/usr/bin/python3 imports rclpy')
    assert_one_sentence(result, 'ROS_DISTRO=kilted', 'imports rclpy', 'ros-kilted-ros-base')


# Compiler and machine -------------------------------------------------------------------------


def test_a_missing_cmake_is_named(tools):
    assert_one_sentence(run_bash('check_build_tools', PATH=str(tools)), 'apt install cmake')


def test_an_old_cmake_is_named(tools):
    write_program(tools / 'cmake', '#!/bin/sh\necho "cmake version 3.16.3"\n')
    result = run_bash('check_build_tools', PATH=str(tools))
    assert_one_sentence(result, 'expected cmake 3.21 or newer', "got '3.16.3'")


def test_a_missing_compiler_is_named(tools):
    write_program(tools / 'cmake', '#!/bin/sh\necho "cmake version 3.28.3"\n')
    write_program(tools / 'make')
    write_program(tools / 'c++')
    result = run_bash('check_build_tools', PATH=str(tools))
    assert_one_sentence(result, 'apt install build-essential')


def test_another_machine_is_told_to_source_ros(tools):
    (tools / 'uname').unlink()
    write_program(tools / 'uname', '#!/bin/sh\necho aarch64\n')
    result = run_bash('check_platform', PATH=str(tools))
    assert_one_sentence(result, 'got aarch64', 'install ROS 2 Jazzy', 'pip install .')


# pip ------------------------------------------------------------------------------------------


def interpreter(version):
    """Return a Python of this version on this machine, or skip."""
    root = Path(os.environ.get('PYENV_ROOT', Path.home() / '.pyenv')) / 'versions'
    candidates = [shutil.which(f'python{version}'), *root.glob(f'{version}.*/bin/python3')]
    for path in filter(None, candidates):
        run = subprocess.run([path, '-c', 'import ensurepip'], capture_output=True, check=False)
        if run.returncode == 0:
            return path
    pytest.skip(f'Python {version} is not installed')


@pytest.fixture(scope='module')
def source(tmp_path_factory):
    """Return a copy of the sources, because setuptools writes into the folder that it builds."""
    folder = tmp_path_factory.mktemp('source')
    for name in ('dynamics_node', 'resource', 'launch', 'config'):
        ignored = shutil.ignore_patterns('__pycache__')
        shutil.copytree(ROOT / name, folder / name, ignore=ignored)
    for name in ('pyproject.toml', 'setup.py', 'setup.cfg', 'package.xml', 'README.md'):
        shutil.copy(ROOT / name, folder)
    return folder


@pytest.mark.xdist_group('pip')
@pytest.mark.parametrize('version', ['3.10', '3.11', '3.12', '3.13'])
def test_pip_installs_the_library_without_ros(version, source, tmp_path):
    python = tmp_path / 'env' / 'bin' / 'python'
    environment = {
        name: value
        for name, value in os.environ.items()
        if name in ('PATH', 'HOME', 'LANG') or name.startswith(('PIP_', 'SSL_', 'UV_'))
    }

    def run(*command, code=0):
        done = subprocess.run(
            [str(part) for part in command],
            capture_output=True,
            text=True,
            check=False,
            cwd=tmp_path,
            env=environment,
        )
        assert done.returncode == code, done.stdout + done.stderr
        return done

    # uv keeps what other environments need too; pip itself is tried once.
    uv = shutil.which('uv') or ROOT / 'log' / 'uv' / 'bin' / 'uv'
    run(interpreter(version), '-m', 'venv', tmp_path / 'env')
    if version == '3.12' or not Path(uv).exists():
        run(python, '-m', 'pip', 'install', '--quiet', source)
    else:
        run(uv, 'pip', 'install', '--quiet', '--python', python, source)
    answer = run(
        python,
        '-c',
        'from dynamics_node import RobotModel\n'
        f'robot = RobotModel.from_urdf({str(ROOT / "config" / "robots" / "pendulum.urdf")!r})\n'
        'print(robot.gravity_torque([0.0]))',
    )
    assert answer.stdout.startswith('[10.3')
    names = {path.name for path in python.parent.iterdir()}
    programs = {'node', 'effort-guard', 'markers', 'simulated-robot', 'demo', 'report'}
    assert {f'dynamics-{name}' for name in programs} <= names
    assert not {'demo', 'report', 'dynamics_node', 'markers'} & names
    (line,) = run(python.parent / 'dynamics-node', code=1).stderr.splitlines()
    assert "no module 'rclpy'" in line and 'source /opt/ros' in line
