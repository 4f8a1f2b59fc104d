"""
A payload on the simulated arm, over DDS: set, moved and removed while the arm floats.

The simulated robot carries a tool; the URDF of the node does not contain it.

"""

import math

from dynamics_interfaces.srv import SetGravity, SetPayload
from dynamics_node import RobotModel
from geometry_msgs.msg import Inertia, Vector3, Vector3Stamped
import numpy as np
import pytest
from soak.rig import Rig
from support.random_payload import with_payload_link
from support.robots import ARM7

MASS, COM, TENSOR = 1.2, (0.01, -0.02, 0.06), 0.002 * np.eye(3)
TOOL = Inertia(m=MASS, com=Vector3(x=COM[0], y=COM[1], z=COM[2]), ixx=0.002, iyy=0.002, izz=0.002)
HELD = math.radians(1.0)


@pytest.fixture(scope='module')
def rig(tmp_path_factory):
    """Return the rig; for the node the hand is empty."""
    urdf = tmp_path_factory.mktemp('robot') / 'with_tool.urdf'
    urdf.write_text(with_payload_link(ARM7.read_text(), 'hand', MASS, COM, TENSOR))
    rig = Rig(
        urdf=urdf, robot_description_file=ARM7, state_timeout=0.5, start_ramp=0.2, stop_ramp=0.2
    )
    yield rig
    rig.during(0.2)
    rig.client.settle(everything=True)
    rig.close()
    assert rig.client.judge.violations == []


def set_payload(rig, link='', inertia=None):
    """Call ~/set_payload; without a payload by default."""
    return rig.client.ask(SetPayload, link=link, inertia=inertia or Inertia())


def assert_held(rig, seconds):
    """Assert that the arm keeps its position for some time; return the velocities."""
    begin = rig.client.now
    rig.during(seconds)
    _, position, velocity, _ = rig.client.truth_between(begin, rig.client.now)
    assert np.abs(position - position[0]).max() < HELD
    return velocity


def refusal(client, name, value):
    """Return the reason why a parameter of the node is refused."""
    result = client.set_node_parameter(name, value)
    assert not result.successful
    return result.reason


@pytest.fixture
def floating(rig):
    """Return the rig: the node knows the tool, and the arm floats."""
    answer = set_payload(rig, 'hand', TOOL)
    assert answer.success, answer.message
    rig.float()
    yield rig
    rig.client.settle()
    assert rig.client.judge.violations == []


def test_the_arm_floats_with_the_tool_and_sinks_without(floating):
    rig, client = floating, floating.client
    rig.until(lambda: client.speed < 0.001)  # the motion after the brakes' release fades slowly
    assert np.abs(assert_held(rig, 1.5)).max() < 0.05
    # Without the payload in the model, the arm sinks under the tool.
    assert set_payload(rig).success
    rig.until(lambda: client.speed > 0.1)
    assert set_payload(rig, 'hand', TOOL).success
    rig.until(lambda: client.speed < 0.01)
    assert client.output == 'ACTIVE', rig.explain()


def test_a_payload_is_set_moved_and_removed_in_a_loop(floating):
    rig, client = floating, floating.client
    states = len(client.outputs)
    before = client.judge.commands
    for round_ in range(25):
        link = ('forearm', 'upper_arm', 'hand', 'tool_center')[round_ % 4]
        assert set_payload(rig, link, Inertia(m=0.1 + 0.1 * (round_ % 3))).success
        rig.during(0.02)
        assert set_payload(rig).success
        assert set_payload(rig, 'hand', TOOL).success
        rig.during(0.02)
    assert len(client.outputs) == states, rig.explain()
    assert client.output == 'ACTIVE'
    client.settle(everything=True)
    assert client.judge.commands > before + 100
    assert client.judge.violations == []
    # The efforts are those of the model with the tool at the present position.
    model = RobotModel.from_urdf(ARM7).with_payload('hand', MASS, COM, TENSOR)
    rig.until(
        lambda: client.state[2] == pytest.approx(model.gravity_torque(client.state[0]), abs=0.01)
    )
    # Without it, to the last bit those of the URDF.
    rig.catch()
    assert set_payload(rig).success
    plain = RobotModel.from_urdf(ARM7)
    rig.until(
        lambda: (
            client.state[2]
            == pytest.approx(plain.gravity_torque(client.state[0]), rel=0, abs=1e-12)
        )
    )


def test_a_change_beyond_the_limits_is_refused_while_the_output_is_on(floating):
    rig, client = floating, floating.client
    answer = set_payload(rig, 'hand', Inertia(m=500.0))
    assert not answer.success
    assert 'its gravity torque would be above the limit: shoulder_pitch' in answer.message
    assert (answer.link, answer.inertia) == ('hand', TOOL)
    answer = set_payload(rig, 'hand', Inertia(m=1e308, com=Vector3(z=0.06)))
    assert not answer.success
    assert 'inertia.m: expected a number >= 0 and <= 100000' in answer.message
    upwards = Vector3Stamped(vector=Vector3(z=9.81))
    answer = client.ask(SetGravity, gravity=upwards)
    assert not answer.success
    assert 'points up in the frame of the root link' in answer.message
    assert answer.gravity.vector.z == -9.81
    # Not in two steps either: first zero, then upwards.
    assert 'not zero while output is on' in refusal(client, 'gravity', [0.0, 0.0, 0.0])
    assert 'above the limit: shoulder_pitch' in refusal(client, 'effort_scale', [10.0] * 8)
    assert 'above the limit: shoulder_yaw' in refusal(client, 'effort_offset', [95.0] * 8)
    assert_held(rig, 0.5)
    assert client.output == 'ACTIVE', rig.explain()
    # With the output off it is accepted, and the answer names the joints above their limits.
    rig.catch()
    assert client.enable(False).success
    rig.until(lambda: client.output == 'READY')
    answer = set_payload(rig, 'hand', Inertia(m=500.0))
    assert answer.success
    assert 'gravity torque is above its limit: shoulder_pitch' in answer.message
    assert set_payload(rig).success
