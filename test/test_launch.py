"""The launch files: they can be read, and start what this package installs."""

import importlib.util
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
LAUNCH_FILES = sorted((ROOT / 'launch').glob('*.launch.py'))


@pytest.mark.parametrize('path', LAUNCH_FILES, ids=lambda path: path.name)
def test_a_launch_file_starts_executables_of_this_package(path):
    # launch and launch_ros are not on PyPI; where ROS 2 is installed they are there.
    Node = pytest.importorskip('launch_ros.actions').Node
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    nodes = [entity for entity in module.generate_launch_description().entities
             if isinstance(entity, Node)]
    assert nodes
    installed = (ROOT / 'setup.py').read_text()
    for node in nodes:
        assert node.node_package == 'dynamics_node'
        assert f"'{node.node_executable} = " in installed
