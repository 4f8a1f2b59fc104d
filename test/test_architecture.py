"""Imports between the folders of the package go one way: see STREET and WALLS."""

import ast
from pathlib import Path
import sys

import pytest
from support.python_process import run_python

PACKAGE = Path(__file__).parents[1] / 'dynamics_node'
# Folder or module → those of this package that it may import.
STREET = {
    'errors': set(),
    'inertia': {'errors'},
    'urdf': {'errors', 'inertia'},
    'model': {'errors', 'inertia', 'urdf'},
    'kernels': {'errors', 'model'},
    'codegen': {'errors', 'kernels'},
    'dynamics': {'errors', 'inertia', 'urdf', 'model', 'kernels', 'codegen'},
    'report': {'errors', 'inertia', 'urdf', 'model', 'dynamics'},
    'identification': {'errors', 'urdf', 'model', 'inertia'},
    'safety': {'errors'},
    'ros': {'errors', 'inertia', 'urdf', 'model', 'kernels', 'dynamics', 'safety'},
    'visualization': {'errors', 'inertia', 'urdf', 'model', 'dynamics', 'ros'},
    'demo': set(),
}
# llvmlite is numba's compiler and comes with it.
LIBRARY = {'numpy', 'numba', 'llvmlite', 'yourdfpy', 'scipy'}
# Folders of `ros/` → those that they may import; only main.py and node.py import all of them.
WALLS = {
    'support': set(),
    'parameters': {'support'},
    'torque_path': {'support', 'parameters'},
    'services': {'support', 'parameters', 'torque_path'},
    'publishers': {'support', 'parameters', 'torque_path'},
    'effort_guard': {'support', 'parameters'},
}
WITH_ROS = ('ros/', 'visualization/markers/', 'demo/')
# Optional packages of the report, which explains how to install them.
OPTIONAL = {
    'report/terminal': {'rich'},
    'report/__main__': {'rich'},
    'report/html': {'plotly', 'jinja2', 'markupsafe'},
}
SOURCES = sorted(PACKAGE.rglob('*.py'))


def room_of(path):
    """Return the folder or module of a file."""
    return path.relative_to(PACKAGE).parts[0].removesuffix('.py')


def imported(path):
    """Return (level, dotted name) of every import in a file, also of those inside functions."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from ((0, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            if node.module is None:
                yield from ((node.level, alias.name) for alias in node.names)
            else:
                yield node.level, node.module


def own_rooms(path):
    """Return the folders of this package that a file imports."""
    here = path.relative_to(PACKAGE).parent.parts
    for level, name in imported(path):
        if level == 0:
            assert not name.startswith('dynamics_node'), f'{path}: relative imports inside'
            continue
        target = (*here[: len(here) - level + 1], *name.split('.'))
        yield target[0]


@pytest.mark.parametrize('path', SOURCES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_a_file_imports_only_allowed_folders(path):
    room = room_of(path)
    if room == '__init__':
        return
    for other in own_rooms(path):
        assert other == room or other in STREET[room], f'{path}: imports {other}'
    if not path.relative_to(PACKAGE).as_posix().startswith(WITH_ROS):
        outside = {name.split('.')[0] for level, name in imported(path) if level == 0}
        optional = {
            name
            for start, names in OPTIONAL.items()
            if path.relative_to(PACKAGE).as_posix().startswith(start)
            for name in names
        }
        unknown = outside - LIBRARY - optional - set(sys.stdlib_module_names)
        assert not unknown, f'{path}: imports {unknown}'


@pytest.mark.parametrize('wall', WALLS)
def test_folders_of_the_node_import_only_allowed_folders(wall):
    for path in (PACKAGE / 'ros' / wall).glob('*.py'):
        for level, name in imported(path):
            other = name.split('.')[0]
            allowed = {*WALLS[wall], 'context'}
            assert level != 2 or other in allowed, f'{path}: imports {other}'


def test_the_library_works_where_no_ros_is_installed():
    code = (
        'import sys\n'
        'class Refuse:\n'
        '    def find_spec(self, name, path=None, target=None):\n'
        '        if name.split(".")[0] in ("rclpy", "dynamics_interfaces", "std_msgs"):\n'
        '            raise ImportError(name)\n'
        'sys.meta_path.insert(0, Refuse())\n'
        'import dynamics_node\n'
        f'robot = dynamics_node.RobotModel.from_urdf({str(PACKAGE.parent)!r}\n'
        '    "/config/robots/pendulum.urdf")\n'
        'print(robot.gravity_torque([0.0]))\n'
        'assert not any(name.startswith("rclpy") for name in sys.modules)\n'
    )
    run = run_python('-c', code, cwd=PACKAGE.parent)
    assert run.returncode == 0, run.stderr
    assert run.stdout.startswith('[10.3')
