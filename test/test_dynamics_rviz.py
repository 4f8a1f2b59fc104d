"""config/dynamics.rviz: displays of RViz, topics of the node, name spaces of the document."""

from pathlib import Path
import re

from dynamics_node import RobotModel
from dynamics_node.visualization import Picture
import numpy as np
import pytest
from support.robots import ARM7
import yaml

ROOT = Path(__file__).parents[1]
CONFIG = yaml.safe_load((ROOT / 'config' / 'dynamics.rviz').read_text())
MANAGER = CONFIG['Visualization Manager']
DISPLAYS = {display['Name']: display for display in MANAGER['Displays']}
DOCUMENT = (ROOT / 'docs' / 'rviz.md').read_text()
# As the plugins of RViz for ROS 2 (Jazzy) are registered, and as its properties are spelled.
PLUGINS = (
    'Grid',
    'RobotModel',
    'MarkerArray',
    'TF',
    'Orbit',
    'Interact',
    'MoveCamera',
    'FocusCamera',
    'Measure',
)
CLASSES = {'rviz_common/Displays', 'rviz_common/Views'} | {
    f'rviz_default_plugins/{name}' for name in PLUGINS
}
QOS = {
    'Durability Policy': {'System Default', 'Transient Local', 'Volatile'},
    'History Policy': {'System Default', 'Keep Last', 'Keep All'},
    'Reliability Policy': {'System Default', 'Reliable', 'Best Effort'},
}


def every(node, key):
    """Return all values of a key, at any depth."""
    if isinstance(node, list):
        return [value for child in node for value in every(child, key)]
    if not isinstance(node, dict):
        return []
    own = [node[key]] if key in node else []
    return own + every(list(node.values()), key)


def groups():
    """Return the groups of a complete picture."""
    robot = RobotModel.from_urdf(
        re.sub(r'ixx="[^"]*"', 'ixx="9"', ARM7.read_text(), count=3)
    ).with_payload('hand', 1.0)
    shapes = Picture(robot.tree, robot.joint_names).shapes(
        robot, robot.neutral_position, np.ones(8), np.ones(8), robot.effort_limits
    )
    return {shape.group for shape in shapes}


def test_every_class_exists_in_rviz():
    classes = set(every(CONFIG, 'Class')) - {''}
    assert classes <= CLASSES
    assert {'rviz_default_plugins/MarkerArray', 'rviz_default_plugins/RobotModel'} <= classes


@pytest.mark.parametrize(
    ('display', 'key', 'topic'),
    [
        ('Dynamics', 'Topic', '/dynamics_node/markers'),
        ('Robot', 'Description Topic', '/robot_description'),
    ],
)
def test_topics_and_their_quality_of_service(display, key, topic):
    settings = DISPLAYS[display][key]
    assert settings['Value'] == topic
    assert isinstance(settings['Depth'], int) and settings['Depth'] > 0
    for policy, words in QOS.items():
        assert settings[policy] in words
    assert settings['Reliability Policy'] == 'Reliable'
    latched = settings['Durability Policy'] == 'Transient Local'
    assert latched == (topic == '/robot_description')
    code = (ROOT / 'dynamics_node/visualization/markers/node.py').read_text()
    assert re.search(r"declare_parameter\(\s*'dynamics_node',\s*'dynamics_node'", code)
    assert "f'{self._followed.name}/markers'" in code


def test_its_first_view_is_that_of_the_demo():
    assert MANAGER['Global Options']['Fixed Frame'] == RobotModel.from_urdf(ARM7).tree.root
    assert DISPLAYS['Dynamics']['Enabled'] and DISPLAYS['Robot']['Enabled']
    assert not DISPLAYS['TF']['Enabled']
    assert DISPLAYS['Robot']['Alpha'] < 0.5  # transparent: the masses are inside


def test_every_name_space_can_be_switched_and_is_in_the_document():
    names = groups()
    assert set(DISPLAYS['Dynamics']['Namespaces']) == names
    assert set(re.findall(r'^\| `(\w+)` \|', DOCUMENT, re.M)) == names


def test_it_is_installed():
    assert "files('config', '*.rviz')" in (ROOT / 'setup.py').read_text()
