"""Carriers: which link of a moving body takes the change, and what it then has."""

from dynamics_node.identification.carriers import carrier_links
from dynamics_node.identification.write_urdf import write_urdf
from dynamics_node.inertia import pseudo_inertia, transform_pseudo_inertia
from dynamics_node.model import build_tree
from dynamics_node.urdf import read_urdf
import numpy as np
import pytest
from support.arms import arm, rod
from support.robots import public_robot, random_urdf

PANDA = 'panda_description/urdf/panda.urdf'


def carriers_of(text):
    """Return tree and carriers of URDF text."""
    description = read_urdf(text)
    tree = build_tree(description)
    return tree, carrier_links(tree, description)


def with_tool(mass):
    """Return an arm of one joint whose link of 1 kg has a tool of some mass fixed to it."""
    text = arm(masses=(1.0,), lengths=(0.3,), axes=('0 1 0',))
    return text.replace(rod(0.7, 0.1), rod(mass, 0.1))


def test_the_moving_link_takes_the_change():
    _, (carrier,) = carriers_of(with_tool(3.9))
    assert carrier.link == 'link1'
    np.testing.assert_array_equal(carrier.placement, np.eye(4))
    assert carrier.rest[3, 3] == 3.9


def test_the_heaviest_link_takes_the_change_of_a_body_with_a_light_link():
    tree, (carrier,) = carriers_of(with_tool(4.1))
    assert carrier.link == 'gripper'
    np.testing.assert_array_equal(carrier.placement, tree.links['gripper'].placement)
    assert carrier.rest[3, 3] == 1.0


def test_a_body_without_mass_has_its_own_link():
    text = arm(masses=(1.0,), lengths=(0.3,), axes=('0 1 0',), tool=False)
    _, (carrier,) = carriers_of(text.replace(rod(1.0, 0.3), ''))
    assert carrier.link == 'link1'
    assert not carrier.rest.any()


def test_links_of_the_base_carry_nothing():
    tree, carriers = carriers_of(random_urdf(3))
    assert len(carriers) == len(tree.moving_joint_names)
    assert not {'base', 'stand'} & {carrier.link for carrier in carriers}


@pytest.mark.parametrize('seed', range(10))
def test_rest_and_carrier_make_the_body(seed):
    description = read_urdf(random_urdf(seed))
    tree = build_tree(description)
    own = {link.name: link.inertial for link in description.links}
    for carrier, body in zip(carrier_links(tree, description), tree.inertia, strict=True):
        alone = own[carrier.link].pseudo_inertia
        np.testing.assert_allclose(
            carrier.rest + transform_pseudo_inertia(alone, carrier.placement),
            body,
            rtol=1e-14,
            atol=1e-14,
        )
        np.testing.assert_allclose(carrier.link_inertia(body), alone, rtol=1e-12, atol=1e-13)


@pytest.mark.parametrize(
    'text', [random_urdf(seed) for seed in range(10)] + [public_robot(PANDA).read_text()]
)
def test_a_changed_body_is_written_and_lumped_again(text):
    tree, carriers = carriers_of(text)
    rng = np.random.default_rng(0)
    # A point mass more, so that the remaining link is a real body.
    bodies = [
        body + pseudo_inertia(rng.uniform(0.1, 1.0), rng.normal(0, 0.1, 3), np.eye(3) * 1e-3)
        for body in tree.inertia
    ]
    result = write_urdf(
        text,
        {
            carrier.link: carrier.link_inertia(body)
            for carrier, body in zip(carriers, bodies, strict=True)
        },
    )
    again = build_tree(read_urdf(result))
    np.testing.assert_allclose(again.inertia, bodies, rtol=1e-12, atol=1e-13)
