"""config/ros2_control_effort.yaml fits the node's own parameters and the arm of the demo."""

from pathlib import Path

from dynamics_node import RobotModel
import numpy as np
import pytest
import rclpy
from support.robots import ARM7
import yaml

CONFIG = Path(__file__).parents[2] / 'config'
FILE = CONFIG / 'ros2_control_effort.yaml'


@pytest.fixture(scope='module')
def control():
    nodes = yaml.safe_load(FILE.read_text())
    assert all(name.startswith('/**/') for name in nodes)
    return {name.removeprefix('/**/'): node['ros__parameters'] for name, node in nodes.items()}


@pytest.fixture(scope='module')
def dynamics():
    [node] = yaml.safe_load((CONFIG / 'dynamics.yaml').read_text()).values()
    return node['ros__parameters']


def test_every_controller_has_a_type_and_parameters(control):
    types = {
        name: value['type']
        for name, value in control['controller_manager'].items()
        if isinstance(value, dict)
    }
    assert types == {
        'joint_state_broadcaster': 'joint_state_broadcaster/JointStateBroadcaster',
        'forward_effort_controller': 'forward_command_controller/ForwardCommandController',
    }
    assert set(control) == {'controller_manager', *types}


def test_the_controller_takes_efforts_on_the_topic_of_the_node(control, dynamics):
    controller, _, topic = dynamics['command_topic'].rpartition('/')
    assert topic == 'commands'
    assert control[controller]['interface_name'] == 'effort'


def test_the_controller_has_the_joints_of_the_node_in_the_same_order(control, dynamics):
    assert 'joints' not in dynamics  # all movable joints, in the order of the URDF
    arm = RobotModel.from_urdf(ARM7)
    assert tuple(control['forward_effort_controller']['joints']) == arm.joint_names
    assert np.isfinite(arm.effort_limits).all()


def test_the_rate_of_joint_states_fits_the_state_timeout(control, dynamics):
    period = 1.0 / control['controller_manager']['update_rate']
    assert period < dynamics['state_timeout'] / 10
    assert control['joint_state_broadcaster'] == {'use_local_topics': False}


@pytest.mark.parametrize('namespace', ['', 'left', '/a/b'])
def test_ros_reads_the_file_in_every_namespace(control, namespace):
    context = rclpy.Context()
    rclpy.init(args=['--ros-args', '--params-file', str(FILE)], context=context)
    try:
        for name, expected in control.items():
            node = rclpy.create_node(
                name,
                context=context,
                namespace=namespace,
                automatically_declare_parameters_from_overrides=True,
            )
            read = {key: node.get_parameter(key).value for key in flat(expected)}
            node.destroy_node()
            assert read == flat(expected)
    finally:
        rclpy.shutdown(context=context)


def flat(parameters):
    """Return nested parameters as one dictionary with dotted names."""
    return {
        f'{name}.{inner}' if inner else name: item
        for name, value in parameters.items()
        for inner, item in (flat(value) if isinstance(value, dict) else {'': value}).items()
    }
