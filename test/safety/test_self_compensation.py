"""Arms that compensate gravity themselves are known by the plugin in their URDF."""

from pathlib import Path

from dynamics_node.safety import self_compensating
from dynamics_node.safety.self_compensation import SELF_COMPENSATING
from dynamics_node.urdf import read_urdf
import pytest

URDF = (
    '<robot name="arm"><link name="base"/><ros2_control name="a" type="system"><hardware>'
    '<plugin> {} </plugin></hardware></ros2_control></robot>'
)


@pytest.mark.parametrize(
    'plugin, arm',
    [
        ('ur_robot_driver/URPositionHardwareInterface', 'a Universal Robots arm'),
        ('franka_hardware/FrankaHardwareInterface', 'a Franka arm'),
        ('lbr_ros2_control::SystemInterface', 'a KUKA LBR iiwa'),
    ],
)
def test_it_is_found_in_the_description(plugin, arm):
    plugins = read_urdf(URDF.format(plugin)).hardware_plugins
    assert plugins == (plugin,)
    assert self_compensating(plugins) == [f'{plugin} ({arm})']


def test_others_are_not():
    assert self_compensating(('mock_components/GenericSystem', 'my_ur_robot_driver/Arm')) == []
    assert read_urdf('<robot name="arm"><link name="base"/></robot>').hardware_plugins == ()
    assert read_urdf(URDF.format('')).hardware_plugins == ()


def test_the_documents_name_every_one():
    text = (Path(__file__).parents[2] / 'docs' / 'arms.md').read_text(encoding='utf-8')
    assert all(f'`{package}`' in text for package in SELF_COMPENSATING)
