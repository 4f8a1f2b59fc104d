"""The tree of moving bodies: lumping, order, mimic joints, and the place of every link."""

from dynamics_node import RobotDescriptionError
from dynamics_node.inertia import combine
from dynamics_node.model import build_tree
from dynamics_node.urdf import read_urdf
import numpy as np
import pytest
from support.robots import random_urdf

MASS = (
    '<inertial><mass value="{}"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
    '</inertial>'
)


def chain(*joints):
    """Return a chain of links of 1 kg; each joint is (type, attributes of mimic or '')."""
    parts = [f'<link name="l0">{MASS.format(1)}</link>']
    for i, (kind, mimic) in enumerate(joints):
        parts.append(
            f'<link name="l{i + 1}">{MASS.format(1)}</link><joint name="j{i}" type="{kind}">'
            f'<parent link="l{i}"/><child link="l{i + 1}"/><origin xyz="0 0 1"/>'
            f'<axis xyz="0 0 1"/>{mimic and f"<mimic {mimic}/>"}</joint>'
        )
    return build_tree(read_urdf('<robot name="r">' + ''.join(parts) + '</robot>'))


def test_fixed_links_are_lumped_at_the_root_in_the_middle_and_at_the_tip():
    tree = chain(('fixed', ''), ('revolute', ''), ('fixed', ''), ('prismatic', ''), ('fixed', ''))
    assert tree.moving_joint_names == tree.joint_names == ('j1', 'j3')
    assert tree.parent.tolist() == [-1, 0]
    np.testing.assert_array_equal(tree.inertia[:, 3, 3], [2, 2])
    assert tree.base_inertia[3, 3] == 2
    # The second link of each body stands one meter above its frame.
    np.testing.assert_array_equal(tree.inertia[:, 2, 3], [1, 1])
    np.testing.assert_array_equal(tree.joint_placement[:, 2, 3], [2, 2])
    assert [tree.links[f'l{i}'].body for i in range(6)] == [-1, -1, 0, 0, 1, 1]
    assert tree.links['l5'].placement[2, 3] == 1


def test_no_mass_is_lost():
    for seed in range(20):
        description = read_urdf(random_urdf(seed))
        tree = build_tree(description)
        total = sum(link.inertial.mass for link in description.links if link.inertial)
        assert np.isclose(tree.inertia[:, 3, 3].sum() + tree.base_inertia[3, 3], total)


def test_a_body_is_the_sum_of_its_links():
    description = read_urdf(random_urdf(5))
    tree = build_tree(description)
    for body in range(len(tree.moving_joint_names)):
        parts = [
            (link.inertial.pseudo_inertia, tree.links[link.name].placement)
            for link in description.links
            if link.inertial and tree.links[link.name].body == body
        ]
        np.testing.assert_allclose(tree.inertia[body], combine(parts), atol=1e-14)


def test_parents_come_before_their_children():
    for seed in range(20):
        tree = build_tree(read_urdf(random_urdf(seed)))
        assert (tree.parent < np.arange(len(tree.parent))).all()


def test_a_chain_of_mimic_joints_is_resolved_to_its_leader():
    tree = chain(
        ('revolute', ''),
        ('revolute', 'joint="j0" multiplier="2" offset="0.5"'),
        ('revolute', 'joint="j1" multiplier="-3" offset="0.1"'),
    )
    assert tree.joint_names == ('j0',)
    assert tree.moving_joint_names == ('j0', 'j1', 'j2')
    np.testing.assert_array_equal(tree.mimic_matrix, [[1], [2], [-6]])
    np.testing.assert_allclose(tree.offset, [0, 0.5, -1.4])
    assert tree.q_index.tolist() == [0, 0, 0]


def test_a_moving_body_without_mass_is_listed():
    text = (
        '<robot name="r"><link name="a"/><link name="b"/><link name="c">'
        + MASS.format(1)
        + '</link><joint name="j" type="revolute"><parent link="a"/><child link="b"/></joint>'
        '<joint name="k" type="{}"><parent link="b"/><child link="c"/></joint></robot>'
    )
    warnings = build_tree(read_urdf(text.format('revolute'))).warnings
    assert any(warning.endswith('not compensated): b') for warning in warnings)
    # With its mass on a fixed link it is a body with mass.
    warnings = build_tree(read_urdf(text.format('fixed'))).warnings
    assert not any('without mass' in warning for warning in warnings)


def test_a_chain_longer_than_the_recursion_limit_is_built():
    tree = chain(*[('revolute' if i % 100 == 0 else 'fixed', '') for i in range(999)])
    assert len(tree.moving_joint_names) == 10


def test_products_of_mimic_multipliers_above_1e30_are_refused():
    leader, follower = ('revolute', ''), ('revolute', 'joint="j0" multiplier="1e20"')
    chain(leader, follower, ('revolute', 'joint="j1" multiplier="1e10"'))
    with pytest.raises(RobotDescriptionError, match=r'joint j2: multiplier .* most 1e.30, got'):
        chain(leader, follower, ('revolute', 'joint="j1" multiplier="1e20"'))


def test_joint_types_and_supporting_joints_of_a_branching_robot_with_mimic_joints():
    description = read_urdf(random_urdf(3, joints=8))
    tree = build_tree(description)
    joint_of = {joint.child: joint for joint in description.joints}
    for name, is_prismatic in zip(tree.moving_joint_names, tree.is_prismatic, strict=True):
        [kind] = [joint.kind for joint in description.joints if joint.name == name]
        assert is_prismatic == (kind == 'prismatic')
    by_name = {joint.name: joint for joint in description.joints}
    for link in tree.links:
        leaders, end = set(), link
        while end in joint_of:
            joint = joint_of[end]
            end = joint.parent
            while joint.mimic:
                joint = by_name[joint.mimic.leader]
            leaders |= {joint.name} if joint.is_movable else set()
        assert tree.supporting_joints(link) == sorted(map(tree.joint_names.index, leaders))
    with pytest.raises(KeyError):
        tree.supporting_joints('nothing')
