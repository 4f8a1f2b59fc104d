"""config/robots/*.yaml: written from the URDFs, accepted by the node, with warnings."""

from pathlib import Path
import sys

from dynamics_interfaces.srv import GetMaxPayload
from dynamics_node import RobotModel
import numpy as np
import pytest
from support.processes import Client, NodeProcess
import yaml

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / 'scripts'))

from write_robot_configs import ARMS, COMPENSATES, FOLDER, render, urdf_path  # noqa: E402

FILES = sorted(FOLDER.glob('*.yaml'))


def parameters(path):
    """Return the parameters of a file."""
    [node] = yaml.safe_load(path.read_text()).values()
    return node['ros__parameters']


def test_there_is_a_file_for_every_arm_and_no_other():
    assert [path.stem for path in FILES] == sorted(ARMS)


@pytest.mark.parametrize('path', FILES, ids=lambda path: path.stem)
def test_it_is_up_to_date(path):
    assert path.read_text() == render(path.stem), 'run python scripts/write_robot_configs.py'


@pytest.mark.parametrize('path', FILES, ids=lambda path: path.stem)
def test_its_limits_hold_the_arm_and_are_never_above_the_urdfs(path):
    robot = RobotModel.from_urdf(urdf_path(ARMS[path.stem]))
    limits = np.array(parameters(path)['effort_limits'])
    assert np.all(limits <= np.nan_to_num(robot.effort_limits, nan=np.inf))
    # Other positions than those of the generator.
    lower, upper = np.clip(robot.position_limits, -np.pi, np.pi).T
    q = np.random.default_rng(99).uniform(lower, upper, (5000, len(lower)))
    assert np.all(np.abs(robot.gravity_torque(q)).max(0) < limits)


@pytest.mark.timeout(120)
@pytest.mark.parametrize('path', FILES, ids=lambda path: path.stem)
def test_the_node_accepts_it(path):
    node = NodeProcess(parameters_file=path, robot_description_file=urdf_path(ARMS[path.stem]))
    client = Client()
    wanted = parameters(path)
    try:
        answer = client.call(
            GetMaxPayload,
            '/dynamics_node/get_max_payload',
            GetMaxPayload.Request(position=[0.0] * len(wanted['joints'])),
        )
    finally:
        client.close()
        node.close()
    assert list(answer.joint_names) == wanted['joints']
    assert list(answer.effort_limits) == wanted['effort_limits']


def test_files_of_self_compensating_arms_warn_against_enabling():
    text = (ROOT / 'docs' / 'arms.md').read_text()
    floating = text.split('## Arms that compensate')[1].split('\n## ')[0]
    for maker in ('Franka', 'Universal Robots', 'Kinova Gen2'):
        assert f'| {maker}' in floating
    for name in ('panda', 'ur5', 'kinova_j2s6s200'):
        assert COMPENSATES[0] in (FOLDER / f'{name}.yaml').read_text()
    for path in FILES:
        assert 'Simulated only' in path.read_text()
        assert 'enable_on_start' not in parameters(path)
