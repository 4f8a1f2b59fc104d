"""Chains and balanced binary trees of any size, as URDF text."""

import numpy as np


def chain(count):
    """
    Return a chain of revolute joints.

    Parameters
    ----------
    count : int
        Number of joints.

    Returns
    -------
    str
        URDF.

    """
    return _urdf([k - 1 for k in range(count)])


def binary_tree(count):
    """
    Return a balanced binary tree of revolute joints.

    Parameters
    ----------
    count : int
        Number of joints.

    Returns
    -------
    str
        URDF, depth first: all libraries then number the joints in the same order.

    """
    # Node k of the heap has the parent (k - 1) // 2; renumbered depth first.
    order, stack = [], [0]
    while stack:
        k = stack.pop()
        order.append(k)
        stack += [child for child in (2 * k + 2, 2 * k + 1) if child < count]
    row = {k: position for position, k in enumerate(order)}
    return _urdf([row[(k - 1) // 2] if k else -1 for k in order])


def _urdf(parents):
    rng = np.random.default_rng(11)
    lines = ['<robot name="generated">', '<link name="base"/>']
    for k, parent in enumerate(parents):
        mass = rng.uniform(0.5, 2.0)
        # The inertia of a box is physically possible.
        x, y, z = rng.uniform(0.02, 0.1, 3) ** 2
        com, origin = rng.normal(0.0, 0.03, 3), rng.normal(0.0, 0.05, 3)
        axis = rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        lines.append(
            f'<link name="link{k:04d}"><inertial><origin xyz="{_numbers(com)}"/>'
            f'<mass value="{mass:.17g}"/><inertia ixx="{mass * (y + z) / 12:.17g}" ixy="0" '
            f'ixz="0" iyy="{mass * (x + z) / 12:.17g}" iyz="0" '
            f'izz="{mass * (x + y) / 12:.17g}"/></inertial></link>'
        )
        carrier = 'base' if parent < 0 else f'link{parent:04d}'
        lines.append(
            f'<joint name="joint{k:04d}" type="revolute"><parent link="{carrier}"/>'
            f'<child link="link{k:04d}"/><origin xyz="{_numbers(origin)}"/>'
            f'<axis xyz="{_numbers(axis)}"/>'
            '<limit lower="-3" upper="3" effort="90" velocity="3"/></joint>'
        )
    return '\n'.join([*lines, '</robot>'])


def _numbers(values):
    return ' '.join(f'{value:.17g}' for value in values)
