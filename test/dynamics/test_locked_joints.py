"""Forward dynamics with locked joints, against Pinocchio."""

from dynamics_node import RobotModel, SingularMassMatrixError
from dynamics_node.dynamics import forward_dynamics_locked
import numpy as np
import pytest
from support.pinocchio_oracle import PinocchioOracle
from support.robots import random_state, random_urdf


@pytest.mark.parametrize('seed', range(5))
def test_locked_joints_do_not_accelerate(seed):
    text = random_urdf(seed)
    model = RobotModel.from_urdf(text)
    rng = np.random.default_rng(seed)
    q, qd = random_state(rng, model)
    tau = rng.normal(size=q.size)
    index = rng.permutation(q.size)[: max(1, q.size // 2)]
    qdd = forward_dynamics_locked(model, index, q, qd, tau)
    held = np.setdiff1d(np.arange(q.size), index)
    assert not qdd[held].any()
    # The efforts of that motion are those given, where the joints are free.
    judged = PinocchioOracle(text).inverse_dynamics(model.joint_names, q, qd, qdd)
    assert judged[index] == pytest.approx(tau[index], abs=1e-10 * np.abs(judged).max())


def test_without_locked_joints_it_equals_forward_dynamics():
    model = RobotModel.from_urdf(random_urdf(2))
    q, qd = random_state(np.random.default_rng(2), model)
    every = np.arange(q.size)
    assert np.array_equal(
        forward_dynamics_locked(model, every, q, qd, q), model.forward_dynamics(q, qd, q)
    )


def test_a_free_joint_without_inertia_is_refused():
    text = (
        '<robot name="r"><link name="w"/><link name="a"/><link name="b"/>'
        '<joint name="j" type="continuous"><parent link="w"/><child link="a"/></joint>'
        '<joint name="k" type="continuous"><parent link="w"/><child link="b"/></joint>'
        '</robot>'
    )
    model, zeros = RobotModel.from_urdf(text), np.zeros(2)
    with pytest.raises(SingularMassMatrixError, match='of these joints is not positive'):
        forward_dynamics_locked(model, np.array([1]), zeros, zeros, zeros)
