"""docs/trajectory.md: its client with the real node, its controller and library code."""

import json
from pathlib import Path
import sys
from types import ModuleType, SimpleNamespace

from dynamics_node import RobotModel
import numpy as np
import pytest
from support.processes import NodeProcess
from support.python_process import run_python
from support.robots import ARM7
from test_readme import blocks

ROOT = Path(__file__).parents[1]
ASK, SEND, LIBRARY = blocks(ROOT / 'docs' / 'trajectory.md')
ARM = RobotModel.from_urdf(ARM7)
GOAL = [0.4, -0.3, 0.2, 0.5, -0.1, 0.3, 0.2]
NAMES = list(ARM.joint_names[:7])
# A separate process: it calls rclpy.init.
USE = f"""
import json
rclpy.init()
from rclpy.executors import SingleThreadedExecutor
node = rclpy.create_node('mover')
executor = SingleThreadedExecutor()
executor.add_node(node)
# A busy machine takes longer to start the node than a user waits for one that runs.
node.create_client(ComputeTrajectoryEffort,
                   'dynamics_node/compute_trajectory_effort').wait_for_service(60.0)
answers = []
for options in ({{}}, {{'without_gravity': True}}):
    motion = swing({NAMES}, [0.0] * 7, {GOAL})
    answers.append([[list(field) for field in (point.positions, point.velocities,
                                               point.accelerations, point.effort)]
                    for point in with_effort(node, executor, motion, **options).points])
try:
    with_effort(node, executor, swing({NAMES}, [0.0] * 7, {GOAL}, seconds=0.05))
except RuntimeError as error:
    answers.append(str(error))
print(json.dumps(answers))
rclpy.shutdown()
"""


@pytest.fixture
def answers():
    node = NodeProcess(robot_description_file=ARM7)
    try:
        run = run_python('-c', ASK + USE, timeout=90.0)
    finally:
        node.close()
    assert run.returncode == 0, run.stderr
    return json.loads(run.stdout)


def whole(values):
    """Add columns of zeros for the gripper."""
    return np.concatenate((values, np.zeros((len(values), len(ARM.joint_names) - 7))), axis=1)


def test_the_efforts_that_its_code_gets_are_those_of_the_motion(answers):
    with_gravity, without, refusal = answers
    q, qd, qdd, effort = np.array(with_gravity).transpose(1, 0, 2)
    np.testing.assert_allclose(q[-1], GOAL, atol=1e-12)
    expected = ARM.inverse_dynamics(whole(q), whole(qd), whole(qdd))[:, :7]
    np.testing.assert_allclose(effort, expected, rtol=0, atol=1e-11 * np.abs(expected).max())
    np.testing.assert_allclose(
        np.array(without)[:, 3],
        expected - ARM.gravity_torque(whole(q))[:, :7],
        rtol=0,
        atol=1e-11 * np.abs(expected).max(),
    )
    assert 'are over their limits, first at point 0' in refusal


def test_the_motion_of_its_code_is_one(answers):
    q, qd, qdd, _ = np.array(answers[0]).transpose(1, 0, 2)
    time = np.linspace(0.0, 3.0, 61)
    np.testing.assert_allclose(np.gradient(q, time, axis=0)[1:-1], qd[1:-1], atol=1e-3)
    np.testing.assert_allclose(np.gradient(qd, time, axis=0)[1:-1], qdd[1:-1], atol=2e-3)
    assert not qd[0].any() and not qd[-1].any()


def test_the_code_for_the_library_runs(monkeypatch):
    monkeypatch.chdir(ROOT)
    names: dict = {}
    exec(compile(LIBRARY, 'docs/trajectory.md', 'exec'), names)
    assert names['efforts'].shape == (61, 8)
    assert names['points'].tolist() == names['joints'].tolist() == []
    assert 0.0 < names['payload'][0] < 100.0


class Done:
    """A future, done from the start or never."""

    def __init__(self, result=None, is_done=True):
        self.result, self.done = lambda: result, lambda: is_done


class Controller:
    """A controller that takes every goal, and is never done with it if it is told so."""

    def __init__(self, is_done):
        self.is_done, self.canceled, self.accepted, self.goal = is_done, 0, True, None

    def wait_for_server(self, timeout_sec):
        return True

    def send_goal_async(self, goal):
        self.goal = goal
        return Done(self)

    def get_result_async(self):
        return Done(SimpleNamespace(result=SimpleNamespace(error_code=0)), self.is_done)

    def cancel_goal_async(self):
        self.canceled += 1
        return Done()

    def destroy(self):
        self.goal = self.goal or None


def test_a_goal_that_is_not_done_in_time_is_canceled(monkeypatch):
    clock = [0.0]
    executor = SimpleNamespace(spin_once=lambda timeout_sec: clock.__setitem__(0, clock[0] + 0.1))
    action = SimpleNamespace(Goal=SimpleNamespace, Result=SimpleNamespace(SUCCESSFUL=0))
    # control_msgs is not everywhere where the tests run.
    monkeypatch.setitem(sys.modules, 'control_msgs', ModuleType('control_msgs'))
    monkeypatch.setitem(
        sys.modules, 'control_msgs.action', SimpleNamespace(FollowJointTrajectory=action)
    )
    names: dict = {}
    exec(compile(ASK + SEND, 'docs/trajectory.md', 'exec'), names)
    names['monotonic'] = lambda: clock[0]
    for is_done in (True, False):
        controller = Controller(is_done)
        names['ActionClient'] = lambda *_, controller=controller: controller
        follow, motion = names['follow'], names['swing'](NAMES, [0.0] * 7, GOAL, seconds=3.5)
        if is_done:
            follow(None, executor, motion)
        else:
            with pytest.raises(RuntimeError, match='not done 3 s after the end: canceled'):
                follow(None, executor, motion)
        assert controller.canceled == (not is_done)
        assert controller.goal.goal_time_tolerance.sec == 2
    assert clock[0] == pytest.approx(6.5, abs=0.2)


def test_the_code_for_the_controller_is_python():
    assert 'follow' in compile(SEND, 'docs/trajectory.md', 'exec').co_names
