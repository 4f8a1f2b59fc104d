"""The equivalent box has the J of the body: by integration over it, and by MuJoCo."""

from dynamics_node import InertiaError
from dynamics_node.inertia import (
    box,
    cylinder,
    equivalent_box,
    inertia_tensor_at_com,
    pseudo_inertia,
    pseudo_inertia_by_integration,
    transform_pseudo_inertia,
)
import mujoco
import numpy as np
import pytest


def random_body(seed):
    """Return J of a real body, turned and away from the origin."""
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(4, 4))
    return 10.0 ** rng.uniform(-3, 3) * root @ root.T


@pytest.mark.parametrize('seed', range(20))
def test_the_integral_over_the_box_is_the_body(seed):
    J = random_body(seed)
    result = equivalent_box(J)
    a, b, c = result.size
    own = pseudo_inertia_by_integration(
        result.mass / (a * b * c), (-a / 2, a / 2), (-b / 2, b / 2), (-c / 2, c / 2)
    )
    np.testing.assert_allclose(
        transform_pseudo_inertia(own, result.pose), J, rtol=0.0, atol=1e-12 * np.abs(J).max()
    )
    assert result.mass == J[3, 3]
    assert np.linalg.det(result.pose[:3, :3]) == pytest.approx(1.0)
    assert (np.diff(result.size) >= 0.0).all()


@pytest.mark.parametrize('seed', range(5))
def test_mujoco_finds_the_same_axes_and_moments(seed):
    J = random_body(seed)
    result = equivalent_box(J)
    tensor = inertia_tensor_at_com(J)
    text = ' '.join(
        f'{tensor[i, j]:.17g}' for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
    )
    place = ' '.join(f'{x:.17g}' for x in J[:3, 3] / J[3, 3])
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><compiler boundmass="0"/><worldbody><body><joint type="free"/>'
        f'<inertial pos="{place}" mass="{J[3, 3]:.17g}" fullinertia="{text}"/>'
        '</body></worldbody></mujoco>'
    )
    m, (a, b, c) = result.mass, result.size
    moments = m / 12.0 * np.array([b * b + c * c, a * a + c * c, a * a + b * b])
    assert np.sort(model.body_inertia[1]) == pytest.approx(np.sort(moments), rel=1e-9)
    assert result.pose[:3, 3] == pytest.approx(model.body_ipos[1], rel=1e-12)
    axes = np.zeros(9)
    mujoco.mju_quat2Mat(axes, model.body_iquat[1])
    theirs = axes.reshape(3, 3)[:, np.argsort(-model.body_inertia[1])]
    # The same axes up to sign: the longest edge is along the axis of the smallest moment.
    assert np.abs(np.sum(theirs * result.pose[:3, :3], axis=0)) == pytest.approx(1.0, abs=1e-8)


def test_the_equivalent_box_of_a_box_is_the_box():
    J = box(3.0, (0.1, 0.2, 0.3))
    result = equivalent_box(J)
    assert result.size == pytest.approx([0.1, 0.2, 0.3])
    assert result.pose[:3, 3] == pytest.approx(0.0)


@pytest.mark.parametrize(
    'tensor, flat',
    [(np.zeros((3, 3)), 3), (np.diag([0.0, 0.1, 0.1]), 2), (np.diag([0.1, 0.1, 0.2]), 1)],
)
def test_flat_and_thin_bodies_have_no_thickness(tensor, flat):
    result = equivalent_box(pseudo_inertia(2.0, (0.1, -0.2, 0.3), tensor))
    assert np.isfinite(result.size).all()
    assert (result.size < 1e-7).sum() == flat


def test_an_impossible_body_has_no_box():
    with pytest.raises(InertiaError, match='triangle inequality'):
        equivalent_box(pseudo_inertia(1.0, (0, 0, 0), np.diag([0.1, 0.1, 0.3])))
    with pytest.raises(InertiaError, match='mass is 0 kg, expected > 0'):
        equivalent_box(np.zeros((4, 4)))


def test_the_equivalent_box_of_other_solids_has_another_size():
    # The length of a cylinder, and an edge of sqrt(3) times its radius.
    assert equivalent_box(cylinder(1.0, 0.05, 0.4)).size[2] == pytest.approx(0.4)
    assert equivalent_box(cylinder(1.0, 0.05, 0.4)).size[0] == pytest.approx(np.sqrt(3) * 0.05)
