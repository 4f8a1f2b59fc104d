"""
A payload on the simulated arm, over DDS: set, moved and removed while the arm floats.

The robot really carries a tool of which the URDF that the node reads says nothing.

"""

import math

from dynamics_interfaces.srv import SetGravity, SetPayload
from dynamics_node import RobotModel
from geometry_msgs.msg import Inertia, Vector3, Vector3Stamped
import numpy as np
import pytest
from rcl_interfaces.srv import SetParameters
from rclpy.parameter import Parameter
from soak.rig import Rig
from support.random_payload import with_payload_link
from support.robots import ARM7

MASS, COM, TENSOR = 1.2, (0.01, -0.02, 0.06), 0.002 * np.eye(3)
TOOL = Inertia(m=MASS, com=Vector3(x=COM[0], y=COM[1], z=COM[2]), ixx=0.002, iyy=0.002, izz=0.002)
HELD = math.radians(1.0)


@pytest.fixture(scope='module')
def rig(tmp_path_factory):
    """Return the rig; the node believes that the hand is empty."""
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


def carry(rig, link='', inertia=None):
    """Call ~/set_payload."""
    return rig.client.call(
        SetPayload,
        '/dynamics_node/set_payload',
        SetPayload.Request(link=link, inertia=inertia or Inertia()),
    )


def set_parameter(client, name, value):
    """Set a parameter of the node; return why it is refused."""
    answer = client.call(
        SetParameters,
        '/dynamics_node/set_parameters',
        SetParameters.Request(parameters=[Parameter(name, value=value).to_parameter_msg()]),
    )
    assert not answer.results[0].successful
    return answer.results[0].reason


@pytest.fixture
def floating(rig):
    """Return the rig: the node knows the tool, and the arm floats."""
    answer = carry(rig, 'hand', TOOL)
    assert answer.success, answer.message
    rig.float()
    yield rig
    rig.client.settle()
    assert rig.client.judge.violations == []


def test_it_floats_with_the_tool_sinks_without_and_is_caught_again(floating):
    rig, client = floating, floating.client
    rig.until(lambda: client.speed < 0.001)  # what the brakes' release has left fades slowly
    begin = client.now
    rig.during(1.5)
    _, position, velocity, _ = client.truth_between(begin, client.now)
    assert np.abs(position - position[0]).max() < HELD
    assert np.abs(velocity).max() < 0.05
    # Forgotten: the arm gives way under what the node does not know of.
    assert carry(rig).success
    rig.until(lambda: client.speed > 0.1)
    assert carry(rig, 'hand', TOOL).success
    rig.until(lambda: client.speed < 0.01)
    assert client.output == 'ACTIVE', rig.explain()


def test_set_moved_and_removed_in_a_loop(floating):
    rig, client = floating, floating.client
    states = len(client.outputs)
    before = client.judge.commands
    for round_ in range(25):
        link = ('forearm', 'upper_arm', 'hand', 'tool_center')[round_ % 4]
        assert carry(rig, link, Inertia(m=0.1 + 0.1 * (round_ % 3))).success
        rig.during(0.02)
        assert carry(rig).success
        assert carry(rig, 'hand', TOOL).success
        rig.during(0.02)
    assert len(client.outputs) == states, rig.explain()
    assert client.output == 'ACTIVE'
    client.settle(everything=True)
    assert client.judge.commands > before + 100
    assert client.judge.violations == []
    # What the node sends is what the model with the tool needs, where the arm is now.
    model = RobotModel.from_urdf(ARM7).with_payload('hand', MASS, COM, TENSOR)
    rig.until(
        lambda: client.state[2] == pytest.approx(model.gravity_torque(client.state[0]), abs=0.01)
    )
    # And without it, to the last bit that of the URDF.
    rig.catch()
    assert carry(rig).success
    plain = RobotModel.from_urdf(ARM7)
    rig.until(
        lambda: (
            client.state[2]
            == pytest.approx(plain.gravity_torque(client.state[0]), rel=0, abs=1e-12)
        )
    )


def test_what_the_arm_cannot_hold_is_refused_while_output_is_on(floating):
    rig, client = floating, floating.client
    answer = carry(rig, 'hand', Inertia(m=500.0))
    assert not answer.success
    assert 'its gravity torque would be above the limit: shoulder_pitch' in answer.message
    assert (answer.link, answer.inertia) == ('hand', TOOL)
    answer = carry(rig, 'hand', Inertia(m=1e308, com=Vector3(z=0.06)))
    assert not answer.success
    assert 'inertia.m: expected a number >= 0 and <= 100000' in answer.message
    upwards = Vector3Stamped(vector=Vector3(z=9.81))
    answer = client.call(
        SetGravity, '/dynamics_node/set_gravity', SetGravity.Request(gravity=upwards)
    )
    assert not answer.success
    assert 'points up in the frame of the root link' in answer.message
    assert answer.gravity.vector.z == -9.81
    # In two steps neither: first none at all, then upwards.
    assert 'not zero while output is on' in set_parameter(client, 'gravity', [0.0, 0.0, 0.0])
    assert 'above the limit: shoulder_pitch' in set_parameter(client, 'effort_scale', [10.0] * 8)
    begin = client.now
    rig.during(0.5)
    _, position, _, _ = client.truth_between(begin, client.now)
    assert np.abs(position - position[0]).max() < HELD
    assert client.output == 'ACTIVE', rig.explain()
    # With the output off it may be said, and the answer tells what it means.
    rig.catch()
    assert client.enable(False).success
    rig.until(lambda: client.output == 'READY')
    answer = carry(rig, 'hand', Inertia(m=500.0))
    assert answer.success
    assert 'gravity torque is above its limit: shoulder_pitch' in answer.message
    assert carry(rig).success
