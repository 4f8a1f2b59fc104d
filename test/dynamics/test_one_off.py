"""A model that is looked at once."""

from dynamics_node import RobotModel
from dynamics_node.codegen import worker
from dynamics_node.dynamics import one_off_model
from dynamics_node.model import build_tree
from dynamics_node.urdf import read_urdf
import numpy as np
from support.robots import random_urdf


def test_it_computes_the_same_and_starts_no_compiler(monkeypatch):
    started = []
    monkeypatch.setattr(worker, 'start', lambda packed: started.append(packed))
    text = random_urdf(4711, joints=4)
    model = one_off_model(build_tree(read_urdf(text)), (0.0, 1.0, -9.0))
    q = np.random.default_rng(1).normal(size=(30_000, len(model.joint_names)))
    for _ in range(3):
        answer = model.gravity_torque(q)
        model.with_payload(model.tip_link, 2.0).gravity_torque(q)
    assert not started
    assert not model.specialize() and not model.is_specialized
    expected = RobotModel.from_urdf(text, (0.0, 1.0, -9.0)).gravity_torque(q)
    np.testing.assert_allclose(answer, expected, atol=1e-10)
