"""docs/how_to/mass_matrix.md: its Python and C++ clients with the real node."""

import json
import os
from pathlib import Path
import re
import shutil
import subprocess

from dynamics_node import RobotModel
import numpy as np
import pytest
from support.processes import Client, NodeProcess
from support.python_process import run_python
from support.robots import ARM7
from test_readme import blocks

ROOT = Path(__file__).parents[1]
PAGE = ROOT / 'docs' / 'how_to' / 'mass_matrix.md'
LIBRARY, ASK = blocks(PAGE)
[CPP], [CMAKE], [PACKAGE] = (blocks(PAGE, language) for language in ('cpp', 'cmake', 'xml'))
ARM = RobotModel.from_urdf(ARM7)
Q = [0.1, 0.2, -0.3, 0.4, -0.5, 0.6, 0.7, 0.02]


@pytest.fixture
def node():
    """Run a node, and wait for its services."""
    process = NodeProcess(robot_description_file=ARM7)
    client = Client()
    try:
        # A busy machine takes longer to start a node than a user waits for one that runs.
        client.until(
            lambda: any(
                name == '/dynamics_node/get_mass_matrix'
                for name, _ in client.node.get_service_names_and_types()
            )
        )
        yield
    finally:
        client.close()
        process.close()


def matrix(text):
    """Return the numbers of lines `name number number ...`, shape (n, n)."""
    return np.array([line.split()[1:] for line in text.splitlines()], dtype=float)


def test_the_code_for_the_library_runs(monkeypatch, capsys):
    monkeypatch.chdir(ROOT)
    exec(compile(LIBRARY, PAGE.name, 'exec'), {})
    assert capsys.readouterr().out == '(8, 8) True\n'


@pytest.mark.timeout(120)
def test_its_python_gets_the_matrix_of_the_library(node):
    use = f"""
import json
rclpy.init()
node = rclpy.create_node('mass_matrix_client')
executor = SingleThreadedExecutor()
executor.add_node(node)
names, D = get_mass_matrix(node, executor, {Q})
try:
    get_mass_matrix(node, executor)
except RuntimeError as error:
    refusal = str(error)
rclpy.shutdown()
main()
print(json.dumps([names, D.tolist(), refusal]))
"""
    run = run_python('-c', ASK + use, timeout=60.0)
    assert run.returncode == 0, run.stderr
    *printed, last = run.stdout.splitlines()
    names, D, refusal = json.loads(last)
    assert names == list(ARM.joint_names)
    np.testing.assert_allclose(D, ARM.mass_matrix(Q), rtol=0, atol=1e-12)
    assert refusal.startswith('no joint state within')
    assert printed[0] == str(names)
    shown = np.array(re.findall(r'-?\d+\.\d*(?:e[-+]\d+)?', ' '.join(printed[1:])), dtype=float)
    np.testing.assert_allclose(shown.reshape(8, 8), ARM.mass_matrix(np.zeros(8)), atol=1e-4)


def test_its_cpp_uses_fields_that_there_are():
    request, answer = (
        re.findall(r'^\S+ +(\w+)', part, re.M)
        for part in (ROOT / 'dynamics_interfaces/srv/GetMassMatrix.srv').read_text().split('---')
    )
    assert set(re.findall(r'request->(\w+)', CPP)) <= set(request)
    assert (
        {'success', 'message', 'joint_names', 'mass_matrix'}
        == set(re.findall(r'response->(\w+)', CPP))
        <= set(answer)
    )
    for name in re.findall(r'find_package\((\w+)', CMAKE):
        assert f'<depend>{name}</depend>' in PACKAGE or f'buildtool_depend>{name}<' in PACKAGE


def has_rclcpp():
    """Return whether rclcpp is installed here, with a compiler."""
    paths = os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep)
    return shutil.which('cmake') and any(
        (Path(path) / 'share/rclcpp/cmake').is_dir() for path in paths
    )


@pytest.mark.timeout(400)
@pytest.mark.skipif(not has_rclcpp(), reason='rclcpp is not installed (it is not on PyPI)')
def test_its_cpp_gets_the_matrix_of_the_library(node, tmp_path):
    (tmp_path / 'src').mkdir()
    (tmp_path / 'src/mass_matrix_client.cpp').write_text(CPP)
    (tmp_path / 'CMakeLists.txt').write_text(CMAKE)
    (tmp_path / 'package.xml').write_text(PACKAGE)
    for arguments in (['-B', 'build', '-Wno-dev'], ['--build', 'build']):
        run = subprocess.run(
            ['cmake', *arguments], cwd=tmp_path, capture_output=True, text=True, check=False
        )
        assert run.returncode == 0, run.stdout + run.stderr
    program = tmp_path / 'build' / 'mass_matrix_client'
    run = subprocess.run(
        [program, *map(str, Q)], capture_output=True, text=True, timeout=60.0, check=False
    )
    assert run.returncode == 0, run.stderr
    assert [line.split()[0] for line in run.stdout.splitlines()] == list(ARM.joint_names)
    np.testing.assert_allclose(matrix(run.stdout), ARM.mass_matrix(Q), atol=1e-4)
    refused = subprocess.run(
        [program, '1'], capture_output=True, text=True, timeout=60.0, check=False
    )
    assert refused.returncode == 1
    assert 'position: expected 8 values' in refused.stderr
