"""The compensating effort: the sum of the enabled terms."""

import itertools

from dynamics_node import RobotModel
from dynamics_node.dynamics import Compensation, JointSelection
import numpy as np
import pytest
from support.robots import ARM7


@pytest.fixture(scope='module')
def arm():
    model = RobotModel.from_urdf(ARM7)
    n = len(model.joint_names)
    return model.with_friction(viscous=np.full(n, 0.4), coulomb=np.full(n, 0.2))


@pytest.mark.parametrize(
    'gravity, coriolis, friction', list(itertools.product((False, True), repeat=3))
)
@pytest.mark.parametrize('chosen', [None, (3, 0, 1)])
def test_compensation_is_the_sum_of_its_terms(arm, chosen, gravity, coriolis, friction):
    q, qd = np.full(8, 0.3), np.linspace(-1.0, 1.0, 8)
    index = None if chosen is None else np.array(chosen)
    unit = Compensation(arm, index, gravity, coriolis, friction)
    G, effort = unit.torques(q, qd)
    places = np.arange(8) if chosen is None else index
    alone = np.zeros(8)  # joints that are not chosen count as standing still
    alone[places] = qd[places]
    expected = (
        gravity * arm.gravity_torque(q)
        + friction * arm.friction_torque(alone)
        + coriolis * (arm.coriolis_matrix(q, alone) @ alone)
    )
    np.testing.assert_allclose(effort, expected[places], rtol=1e-12, atol=1e-12)
    np.testing.assert_array_equal(G, arm.gravity_torque(q)[places])
    assert unit.needs_velocity == (coriolis or friction)


def test_an_unknown_velocity_counts_as_zero(arm):
    q, qd = np.full(8, 0.3), np.full(8, np.nan)
    _, effort = Compensation(arm, None, True, True, True).torques(q, qd)
    np.testing.assert_allclose(effort, arm.gravity_torque(q))


def test_a_permutation_maps_names_to_places(arm):
    selection = JointSelection(arm, [arm.joint_names[2]])
    G, _ = Compensation(arm, selection.index).torques(np.zeros(8), np.zeros(8))
    assert G.shape == (1,)
