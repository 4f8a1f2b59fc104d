"""
The textbook formulas, literally: the specification of `recursive`.

Deliberately slow. Every sum of docs/mathematics.md, section 3, is written in the form of that
document, with the derivatives of the 4x4 transforms by the product rule. It shares only the tree
with `recursive`.

"""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ..model.tree import KinematicTree, PRISMATIC

Array = NDArray[np.float64]


def link_transforms(tree: KinematicTree, q: Array) -> tuple[Array, Array, Array]:
    """
    Return A_k of every body and its first and second derivatives by the body positions.

    Parameters
    ----------
    tree : KinematicTree
        N bodies, n independent joints.
    q : numpy.ndarray, shape (n,)
        rad or m.

    Returns
    -------
    A : numpy.ndarray, shape (N, 4, 4)
        Body frame → base frame.
    dA : numpy.ndarray, shape (N, N, 4, 4)
        dA[k, i] = ∂A_k/∂q_i.
    ddA : numpy.ndarray, shape (N, N, N, 4, 4)
        ddA[k, i, j] = ∂²A_k/∂q_i∂q_j.

    """
    count = len(tree.moving_joint_names)
    positions = tree.multiplier * q[tree.q_index] + tree.offset
    A = np.zeros((count, 4, 4))
    dA = np.zeros((count, count, 4, 4))
    ddA = np.zeros((count, count, count, 4, 4))
    for k in range(count):
        chain = _chain(tree, k)
        A[k] = _product(tree, chain, positions, {})
        for i in chain:
            dA[k, i] = _product(tree, chain, positions, {i: 1})
            for j in chain:
                orders = {i: 2} if i == j else {i: 1, j: 1}
                ddA[k, i, j] = _product(tree, chain, positions, orders)
    return A, dA, ddA


def mass_matrix(tree: KinematicTree, q: Array) -> Array:
    """
    Return D by the trace formula.

    Parameters
    ----------
    tree : KinematicTree
    q : numpy.ndarray, shape (n,)
        rad or m.

    Returns
    -------
    numpy.ndarray, shape (n, n)
        D_ij = Σ_k tr(∂A_k/∂q_i J_k (∂A_k/∂q_j)ᵀ), folded over mimic joints.

    References
    ----------
    docs/mathematics.md, equations (6) and (19).

    """
    _, dA, _ = link_transforms(tree, q)
    B = tree.mimic_matrix
    return B.T @ _trace_sum(dA, tree.inertia) @ B


def christoffel_symbols(tree: KinematicTree, q: Array) -> Array:
    """
    Return the Christoffel symbols of the bodies' positions from the derivatives of D.

    Parameters
    ----------
    tree : KinematicTree
    q : numpy.ndarray, shape (n,)
        rad or m.

    Returns
    -------
    numpy.ndarray, shape (N, N, N)
        c[i, k, j] = ½ (∂D_ij/∂q_k + ∂D_ik/∂q_j - ∂D_jk/∂q_i).

    References
    ----------
    docs/mathematics.md, equation (7).

    """
    _, dA, ddA = link_transforms(tree, q)
    # dD[i, j, k] = ∂D_ij/∂q_k by the product rule on (6).
    half = np.einsum('bikxy,byz,bjxz->ijk', ddA, tree.inertia, dA)
    dD = half + half.transpose(1, 0, 2)
    return 0.5 * (dD.transpose(0, 2, 1) + dD - dD.transpose(2, 1, 0))


def christoffel_symbols_by_traces(tree: KinematicTree, q: Array) -> Array:
    """
    Return the Christoffel symbols by the second form of the formula.

    Parameters
    ----------
    tree : KinematicTree
    q : numpy.ndarray, shape (n,)
        rad or m.

    Returns
    -------
    numpy.ndarray, shape (N, N, N)
        c[i, k, j] = Σ_b tr(∂²A_b/∂q_j∂q_k J_b (∂A_b/∂q_i)ᵀ).

    References
    ----------
    docs/mathematics.md, equation (7), right-hand side.

    """
    _, dA, ddA = link_transforms(tree, q)
    return np.einsum('bjkxy,byz,bixz->ikj', ddA, tree.inertia, dA)


def coriolis_matrix(tree: KinematicTree, q: Array, qd: Array) -> Array:
    """
    Return C from the Christoffel symbols.

    Parameters
    ----------
    tree : KinematicTree
    q, qd : numpy.ndarray, shape (n,)
        rad or m, and per second.

    Returns
    -------
    numpy.ndarray, shape (n, n)
        C_ij = Σ_k c_ikj q̇_k, folded over mimic joints.

    References
    ----------
    docs/mathematics.md, equations (7) and (19).

    """
    B = tree.mimic_matrix
    return B.T @ np.einsum('ikj,k->ij', christoffel_symbols(tree, q), B @ qd) @ B


def gravity_torque(tree: KinematicTree, q: Array, gravity: Array) -> Array:
    """
    Return G with the center of mass as a point, (r, 1).

    Parameters
    ----------
    tree : KinematicTree
    q : numpy.ndarray, shape (n,)
        rad or m.
    gravity : numpy.ndarray, shape (3,)
        m/s², base frame, points down.

    Returns
    -------
    numpy.ndarray, shape (n,)
        G_i = -Σ_k m_k ⟨(g, 0), ∂A_k/∂q_i (r_k, 1)⟩, folded over mimic joints.

    References
    ----------
    docs/mathematics.md, equations (8) and (19).

    """
    _, dA, _ = link_transforms(tree, q)
    # Column 4 of J is m (r, 1).
    return -tree.mimic_matrix.T @ np.einsum('x,bixy,by->i', np.append(gravity, 0.0), dA,
                                            tree.inertia[:, :, 3])


def potential_energy(tree: KinematicTree, q: Array, gravity: Array) -> float:
    """
    Return V of the bodies that joints move, J.

    Parameters
    ----------
    tree : KinematicTree
    q : numpy.ndarray, shape (n,)
        rad or m.
    gravity : numpy.ndarray, shape (3,)
        m/s², base frame, points down.

    Returns
    -------
    float
        V = -Σ_k m_k gᵀ (A_k r_k).

    References
    ----------
    docs/mathematics.md, equation (20).

    """
    A, _, _ = link_transforms(tree, q)
    return float(-np.einsum('x,bxy,by->', np.append(gravity, 0.0), A, tree.inertia[:, :, 3]))


def _trace_sum(dA: Array, inertia: Array) -> Array:
    # (6): the sum over the bodies k of tr(∂A_k/∂q_i J_k (∂A_k/∂q_j)ᵀ), shape (N, N).
    return np.einsum('bixy,byz,bjxz->ij', dA, inertia, dA)


def _chain(tree: KinematicTree, k: int) -> list[int]:
    # Rows of the bodies from the base to body k.
    chain = []
    while k >= 0:
        chain.append(k)
        k = int(tree.parent[k])
    return chain[::-1]


def _product(tree: KinematicTree, chain: Sequence[int], positions: Array,
             orders: Mapping[int, int]) -> Array:
    # The product of placement and motion along the chain, shape (4, 4), with the motion of joint
    # i differentiated orders[i] times.
    result = np.eye(4)
    for i in chain:
        motion = _motion(tree, i, positions[i], orders.get(i, 0))
        result = result @ tree.joint_placement[i] @ motion
    return result


def _motion(tree: KinematicTree, i: int, position: float, order: int) -> Array:
    # E(position) or a derivative, shape (4, 4): a translation, or Rodrigues' rotation.
    hat = np.zeros((4, 4))
    if tree.joint_type[i] == PRISMATIC:
        hat[:3, 3] = tree.axis[i]
        return (np.eye(4) + position * hat, hat, np.zeros((4, 4)))[order]
    x, y, z = tree.axis[i]
    hat[:3, :3] = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]
    s, c = np.sin(position), np.cos(position)
    square = hat @ hat
    return (np.eye(4) + s * hat + (1.0 - c) * square, c * hat + s * square,
            -s * hat + c * square)[order]
