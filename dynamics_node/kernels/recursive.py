"""
The recursion: D, C and G in two sweeps over the tree.

Equation numbers are those of docs/mathematics.md, section 4. The equations hold in every frame at
rest; here each joint has its own, with the axes of the base and the origin on the joint. So a
light finger far from the base keeps all its digits. Quantities that pass from one joint to another
are shifted by the offset between them, equation (21).

Every 4x4 matrix has few different numbers, and only those are kept, one row per body:

    pose      = (rotation, row-major; origin; offset)   body → base; offset: from the parent
    twist     = (wx wy wz vx vy vz)                     xi, of the joint
    velocity  = (Wx Wy Wz, Ux Uy Uz)                    W of the body; U of the joint's origin
                                                        relative to the parent's
    composite = (m, hx hy hz, xx xy xz yy yz zz)        Jc, symmetric 4x4
    momentum  = (xx xy xz yx yy yz zx zy zz, x y z)     Lc, 3x4: left 3x3 block, last column

The formulas are written once, in plain arithmetic, and run in three ways: compiled for all robots
(the functions at the top), interpreted, and on tracing scalars, which turns them into
straight-line code for one robot (`codegen.trace`). So a formula must not branch on the value of a
number.

It is one file because numba's cache on disk does not notice changes in imported files.

"""

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from .jit import compiled, formula

# Numbers are float64 when compiled or interpreted, tracing scalars when recorded.
Scalar: TypeAlias = Any
Vector: TypeAlias = tuple[Scalar, Scalar, Scalar]
# 3x3, row-major.
Matrix: TypeAlias = tuple[Scalar, Scalar, Scalar, Scalar, Scalar, Scalar, Scalar, Scalar, Scalar]
Array: TypeAlias = NDArray[Any]
Structure: TypeAlias = NDArray[np.int64]
Workspace: TypeAlias = tuple[Array, Array, Array, Array, Array, Array]

# Columns of `PackedModel.structure`, one row per body.
PARENT, JOINT_TYPE, Q_INDEX = range(3)

# Columns of `PackedModel.numbers`, one row per body.
ROTATION = 0  # 9, row-major
TRANSLATION = 9  # 3, m
AXIS = 12  # 3, unit vector
INERTIA = 15  # 10, J: mass, first moments (3), second moments xx, xy, xz, yy, yz, zz
MULTIPLIER = 25  # of the joint that this one mimics; 1 for independent joints
OFFSET = 26  # rad or m
ROTOR = 27  # on the diagonal of D, kg m² or kg; 0 for joints that mimic another
WIDTH = 28

# Columns and widths of the arrays in the docstring above.
OF_ROTATION, OF_ORIGIN, OF_OFFSET = 0, 9, 12
POSE, TWIST, COMPOSITE, MOMENTUM = 15, 6, 10, 12

_PRISMATIC = 1
_EPSILON = 2.0**-52


def joint_count(structure: Structure) -> int:
    """Return the number of independent joints of a robot, n."""
    return int(np.max(structure[:, Q_INDEX])) + 1


# For every robot, B states at once ---------------------------------------------------------


@compiled
def dynamics(structure: Structure, numbers: Array, q: Array, qd: Array, D: Array, C: Array,
             G: Array) -> None:
    """
    Compute D, C and G of B states.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `PackedModel`.
    q, qd : numpy.ndarray, shape (B, n)
        Joint positions (rad or m) and velocities.
    D, C : numpy.ndarray, shape (B, n, n)
        Overwritten.
    G : numpy.ndarray, shape (B, n)
        Overwritten.

    """
    workspace = make_workspace(structure.shape[0])
    D[:], C[:], G[:] = 0.0, 0.0, 0.0
    for b in range(q.shape[0]):
        dynamics_of_state(structure, numbers, q[b], qd[b], workspace, D[b], C[b], G[b])


@compiled
def mass_matrix(structure: Structure, numbers: Array, q: Array, D: Array) -> None:
    """
    Compute D of B states.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `PackedModel`.
    q : numpy.ndarray, shape (B, n)
    D : numpy.ndarray, shape (B, n, n)
        Overwritten.

    """
    workspace = make_workspace(structure.shape[0])
    D[:] = 0.0
    for b in range(q.shape[0]):
        mass_matrix_of_state(structure, numbers, q[b], workspace, D[b])


@compiled
def gravity_torque(structure: Structure, numbers: Array, q: Array, G: Array, V: Array) -> None:
    """
    Compute G and the potential energy of B states.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `PackedModel`.
    q : numpy.ndarray, shape (B, n)
    G : numpy.ndarray, shape (B, n)
        Overwritten.
    V : numpy.ndarray, shape (B,)
        Overwritten.

    """
    workspace = make_workspace(structure.shape[0])
    G[:] = 0.0
    for b in range(q.shape[0]):
        V[b] = gravity_of_state(structure, numbers, q[b], workspace, G[b])


@compiled
def gravity_torque_of_one(structure: Structure, numbers: Array, q: Array, G: Array) -> None:
    """
    Compute G of one state, for control loops: as few arguments as possible.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `PackedModel`.
    q : numpy.ndarray, shape (n,)
    G : numpy.ndarray, shape (n,)
        Overwritten.

    """
    G[:] = 0.0
    gravity_of_state(structure, numbers, q, make_workspace(structure.shape[0]), G)


@compiled
def inverse_dynamics(structure: Structure, numbers: Array, q: Array, qd: Array, qdd: Array,
                     tau: Array) -> None:
    """
    Compute the efforts of B motions.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `PackedModel`.
    q, qd, qdd : numpy.ndarray, shape (B, n)
        Joint positions (rad or m), velocities, accelerations.
    tau : numpy.ndarray, shape (B, n)
        Overwritten.

    """
    workspace = make_workspace(structure.shape[0])
    tau[:] = 0.0
    for b in range(q.shape[0]):
        inverse_dynamics_of_state(structure, numbers, q[b], qd[b], qdd[b], workspace, tau[b])


@compiled
def regressor(structure: Structure, numbers: Array, q: Array, qd: Array, qdd: Array,
              Y: Array) -> None:
    """
    Compute the regressor of B motions: the efforts are linear in the ten numbers of every J.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `PackedModel`; the inertia in it is not used.
    q, qd, qdd : numpy.ndarray, shape (B, n)
        Joint positions (rad or m), velocities, accelerations.
    Y : numpy.ndarray, shape (B, n, 10 N)
        Overwritten.

    """
    workspace = make_workspace(structure.shape[0])
    Y[:] = 0.0
    for b in range(q.shape[0]):
        regressor_of_state(structure, numbers, q[b], qd[b], qdd[b], workspace, Y[b])


@compiled
def forward_dynamics(structure: Structure, numbers: Array, q: Array, qd: Array, tau: Array,
                     qdd: Array, is_definite: Array) -> None:
    """
    Compute the accelerations caused by the efforts of B states.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `PackedModel`.
    q, qd, tau : numpy.ndarray, shape (B, n)
        Joint positions (rad or m), velocities, efforts.
    qdd : numpy.ndarray, shape (B, n)
        Overwritten.
    is_definite : numpy.ndarray of bool, shape (B,)
        Overwritten: False where D is not positive definite beyond rounding, so qdd is invalid.

    """
    workspace, n = make_workspace(structure.shape[0]), q.shape[1]
    D, pivots, pivot_margins, zeros = np.empty((n, n)), np.empty(n), np.empty(n), np.zeros(n)
    for b in range(q.shape[0]):
        D[:], qdd[b] = 0.0, 0.0
        forward_dynamics_of_state(structure, numbers, q[b], qd[b], tau[b], zeros, workspace, D,
                                  pivots, pivot_margins, qdd[b])
        # In this form NaN counts as definite, so qdd is NaN.
        is_definite[b] = not (pivot_margins <= 0.0).any()


@compiled
def jacobian(structure: Structure, numbers: Array, q: Array, body: int, point: Array,
             J: Array) -> None:
    """
    Compute the Jacobian of a point of a body at B states.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `PackedModel`.
    q : numpy.ndarray, shape (B, n)
    body : int
        Row of the body.
    point : numpy.ndarray, shape (3,)
        In the body's frame, m.
    J : numpy.ndarray, shape (B, 6, n)
        Overwritten.

    """
    workspace = make_workspace(structure.shape[0])
    J[:] = 0.0
    for b in range(q.shape[0]):
        jacobian_of_state(structure, numbers, q[b], workspace, body, point, J[b])


@compiled
def body_poses(structure: Structure, numbers: Array, q: Array, bodies: NDArray[np.int64],
               A: Array) -> None:
    """
    Compute the transforms of K bodies at B states.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `PackedModel`.
    q : numpy.ndarray, shape (B, n)
    bodies : numpy.ndarray of int64, shape (K,)
        Rows of the bodies.
    A : numpy.ndarray, shape (B, K, 3, 4)
        Overwritten: the upper three rows of the transforms body → base, m.

    """
    pose, twist, composite = make_workspace(structure.shape[0])[:3]
    for b in range(q.shape[0]):
        outward(structure, numbers, q[b], pose, twist, composite)
        for k in range(len(bodies)):
            for i in range(3):
                for j in range(3):
                    A[b, k, i, j] = pose[bodies[k], OF_ROTATION + 3 * i + j]
                A[b, k, i, 3] = pose[bodies[k], OF_ORIGIN + i]


# One state ---------------------------------------------------------------------------------
#
# Shapes: q, qd, qdd, tau and G (n,); D and C (n, n); J (6, n). Results are added to their
# arguments, so that joints that mimic one joint add up, equation (19).


@formula
def make_workspace(bodies: int) -> Workspace:
    """Return uninitialized intermediate arrays of one state, one per quantity of N bodies."""
    return (np.empty((bodies, POSE)), np.empty((bodies, TWIST)), np.empty((bodies, COMPOSITE)),
            np.empty((bodies, TWIST)), np.empty((bodies, TWIST)), np.empty((bodies, MOMENTUM)))


@formula
def dynamics_of_state(structure: Structure, numbers: Array, q: Array, qd: Array,
                      workspace: Workspace, D: Array, C: Array, G: Array) -> None:
    """Add D, C and G of one state to zeros, equations (15) to (17)."""
    pose, twist, composite, velocity, twist_rate, momentum = workspace
    outward(structure, numbers, q, pose, twist, composite)
    outward_velocity(structure, numbers, qd, pose, twist, velocity, twist_rate)
    body_momenta(structure, velocity, composite, momentum)
    inward_dynamics(structure, numbers, pose, twist, velocity, twist_rate, composite, momentum,
                    D, C)
    gravity_torques(structure, numbers, twist, composite, G)


@formula
def mass_matrix_of_state(structure: Structure, numbers: Array, q: Array, workspace: Workspace,
                         D: Array) -> None:
    """Add D of one state to zeros, equation (15)."""
    pose, twist, composite = workspace[:3]
    outward(structure, numbers, q, pose, twist, composite)
    inward_mass(structure, numbers, pose, twist, composite, D)


@formula
def gravity_of_state(structure: Structure, numbers: Array, q: Array, workspace: Workspace,
                     G: Array) -> Scalar:
    """Add G of one state to zeros, equation (17), and return V, equation (20)."""
    pose, twist, composite = workspace[:3]
    outward(structure, numbers, q, pose, twist, composite)
    inward_composites(structure, pose, composite)
    gravity_torques(structure, numbers, twist, composite, G)
    return potential_energy(structure, numbers, pose, composite)


@formula
def inverse_dynamics_of_state(structure: Structure, numbers: Array, q: Array, qd: Array,
                              qdd: Array, workspace: Workspace, tau: Array) -> None:
    """Add the efforts of one motion to zeros, equation (22)."""
    pose, twist, K, velocity, twist_rate, scratch = workspace
    acceleration, wrench = scratch[:, :TWIST], scratch[:, TWIST:]
    outward(structure, numbers, q, pose, twist, K)
    outward_velocity(structure, numbers, qd, pose, twist, velocity, twist_rate)
    outward_acceleration(structure, numbers, qd, qdd, pose, twist, velocity, twist_rate,
                         acceleration)
    inward_efforts(structure, numbers, pose, twist, velocity, acceleration, K, wrench, tau)
    for k in range(structure.shape[0]):
        c = structure[k, Q_INDEX]
        tau[c] += numbers[k, ROTOR] * qdd[c]                                     # (28)


@formula
def regressor_of_state(structure: Structure, numbers: Array, q: Array, qd: Array, qdd: Array,
                       workspace: Workspace, Y: Array) -> None:
    """Add the regressor of one motion, shape (n, 10 N), to zeros, equation (36)."""
    pose, twist, K, velocity, twist_rate, scratch = workspace
    acceleration = scratch[:, :TWIST]
    outward(structure, numbers, q, pose, twist, K)
    outward_velocity(structure, numbers, qd, pose, twist, velocity, twist_rate)
    outward_acceleration(structure, numbers, qd, qdd, pose, twist, velocity, twist_rate,
                         acceleration)
    inward_regressor(structure, numbers, pose, twist, velocity, acceleration, K, Y)


@formula
def forward_dynamics_of_state(structure: Structure, numbers: Array, q: Array, qd: Array,
                              tau: Array, zeros: Array, workspace: Workspace, D: Array,
                              pivots: Array, pivot_margins: Array, qdd: Array) -> None:
    """Solve equation (25) for qdd, shape (n,); D, qdd and `zeros` (n,) are zero before."""
    inverse_dynamics_of_state(structure, numbers, q, qd, zeros, workspace, qdd)
    for i in range(qdd.shape[0]):
        qdd[i] = tau[i] - qdd[i]
    mass_matrix_of_state(structure, numbers, q, workspace, D)
    solve_positive_definite(D, qdd, pivots, pivot_margins)


@formula
def jacobian_of_state(structure: Structure, numbers: Array, q: Array, workspace: Workspace,
                      body: int, point: Array, J: Array) -> None:
    """Add the Jacobian of a point of a body to zeros, equation (29)."""
    pose, twist, composite = workspace[:3]
    outward(structure, numbers, q, pose, twist, composite)
    # From the joint's origin to the point, as in (21): no digits are lost far from the base.
    r = _times(_matrix(pose, body, OF_ROTATION), (point[0], point[1], point[2]))
    k = body
    while k >= 0:
        c, multiplier = structure[k, Q_INDEX], numbers[k, MULTIPLIER]         # (19)
        w, v = _vector(twist, k, 0), _vector(twist, k, 3)
        linear = _add(_cross(w, r), v)
        for i in range(3):
            J[i, c] += multiplier * linear[i]
            J[3 + i, c] += multiplier * w[i]
        r = _add(r, _vector(pose, k, OF_OFFSET))
        k = structure[k, PARENT]


@formula
def solve_positive_definite(D: Array, x: Array, pivots: Array, pivot_margins: Array) -> None:
    """
    Solve D x = b in place by Cholesky without square roots, D = L diag(pivots) Lᵀ.

    Parameters
    ----------
    D : numpy.ndarray, shape (n, n)
        L below the diagonal afterwards.
    x : numpy.ndarray, shape (n,)
        b before.
    pivots, pivot_margins : numpy.ndarray, shape (n,)
        Overwritten. The margins are the pivots minus their rounding: all positive if D is
        positive definite.

    """
    n = x.shape[0]
    for j in range(n):
        pivots[j] = D[j, j]
        pivot_margins[j] = -n * _EPSILON * D[j, j]
        for k in range(j):
            pivots[j] = pivots[j] - D[j, k] * D[j, k] * pivots[k]
        pivot_margins[j] = pivots[j] + pivot_margins[j]
        inverse = 1.0 / pivots[j]
        for i in range(j + 1, n):
            for k in range(j):
                D[i, j] = D[i, j] - D[i, k] * D[j, k] * pivots[k]
            D[i, j] = D[i, j] * inverse
            x[i] = x[i] - D[i, j] * x[j]
    for i in range(n - 1, -1, -1):
        x[i] = x[i] * (1.0 / pivots[i])
        for k in range(i + 1, n):
            x[i] = x[i] - D[k, i] * x[k]


# From the base to the tips -----------------------------------------------------------------


@formula
def outward(structure: Structure, numbers: Array, q: Array, pose: Array, twist: Array,
            composite: Array) -> None:
    """
    Compute pose A_k, twist xi_k and pseudo-inertia K_k of every body, base to tips.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `PackedModel`.
    q : numpy.ndarray, shape (n,)
    pose : numpy.ndarray, shape (N, 15)
        Overwritten: rotation row-major and origin, body frame → base frame; offset of the
        origin from the parent's, in the axes of the base, m.
    twist : numpy.ndarray, shape (N, 6)
        Overwritten: in the joint's own frame, equation (9).
    composite : numpy.ndarray, shape (N, 10)
        Overwritten: K_k in the joint's own frame, equation (10).

    """
    for k in range(structure.shape[0]):
        parent, prismatic = structure[k, PARENT], structure[k, JOINT_TYPE] == _PRISMATIC
        position = numbers[k, MULTIPLIER] * q[structure[k, Q_INDEX]] + numbers[k, OFFSET]
        axis = _vector(numbers, k, AXIS)
        R, offset = _matrix(numbers, k, ROTATION), _vector(numbers, k, TRANSLATION)
        if not prismatic:
            R = _product(R, _turn(axis, np.sin(position), np.cos(position)))
        if parent >= 0:
            up = _matrix(pose, parent, OF_ROTATION)
            R, offset = _product(up, R), _times(up, offset)
        # A rotation leaves its axis in place, so the rotated frame serves for (9).
        u = _times(R, axis)
        if prismatic:
            offset = _add(offset, _scale(position, u))
        origin = offset
        if parent >= 0:
            origin = _add(_vector(pose, parent, OF_ORIGIN), offset)
        _put_matrix(pose, k, OF_ROTATION, R)
        _put(pose, k, OF_ORIGIN, origin)
        _put(pose, k, OF_OFFSET, offset)
        _put_twist(twist, k, prismatic, u)
        _pseudo_inertia_in_base(numbers, k, R, composite)


@formula
def _turn(a: Vector, s: Scalar, c: Scalar) -> Matrix:
    # Rotation of A_k about the unit vector a, with sine s and cosine c of the angle (Rodrigues):
    # E = a aᵀ + c (1 - a aᵀ) + s [a]×, as in `textbook`
    x, y, z = a
    xy, xz, yz = x * y, x * z, y * z
    return (x * x + c * (1.0 - x * x), xy - c * xy - s * z, xz - c * xz + s * y,
            xy - c * xy + s * z, y * y + c * (1.0 - y * y), yz - c * yz - s * x,
            xz - c * xz - s * y, yz - c * yz + s * x, z * z + c * (1.0 - z * z))


@formula
def _put_twist(twist: Array, k: int, prismatic: bool, u: Vector) -> None:
    # (9) with the origin on the joint: revolute w = axis, v = 0; prismatic w = 0, v = axis.
    if prismatic:
        _put(twist, k, 0, (0.0, 0.0, 0.0))
        _put(twist, k, 3, u)
    else:
        _put(twist, k, 0, u)
        _put(twist, k, 3, (0.0, 0.0, 0.0))


@formula
def _pseudo_inertia_in_base(numbers: Array, k: int, R: Matrix, K: Array) -> None:
    # (10): K = A J Aᵀ in the axes of the base, with the origin on the joint: R Sigma Rᵀ, R h, m.
    x, y, z = (R[0], R[1], R[2]), (R[3], R[4], R[5]), (R[6], R[7], R[8])
    sigma = _second_moments(numbers, k, INERTIA + 4)
    sx, sy, sz = _times(sigma, x), _times(sigma, y), _times(sigma, z)
    K[k, 0] = numbers[k, INERTIA]
    _put(K, k, 1, _times(R, _vector(numbers, k, INERTIA + 1)))
    _put(K, k, 4, (_dot(x, sx), _dot(y, sx), _dot(z, sx)))
    _put(K, k, 7, (_dot(y, sy), _dot(z, sy), _dot(z, sz)))


@formula
def outward_velocity(structure: Structure, numbers: Array, qd: Array, pose: Array, twist: Array,
                     velocity: Array, twist_rate: Array) -> None:
    """
    Compute velocities and the rate of every joint's twist, base to tips.

    A common translation of all bodies changes neither D nor C, equation (24). So velocities are
    relative to the joint's origin, and the tip of a long boom loses no digits.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `PackedModel`.
    qd : numpy.ndarray, shape (n,)
    pose, twist : numpy.ndarray
        Results of `outward`.
    velocity : numpy.ndarray, shape (N, 6)
        Overwritten: angular velocity of the body, equation (11), and velocity of the joint's
        origin relative to the parent's.
    twist_rate : numpy.ndarray, shape (N, 6)
        Overwritten: equation (14).

    """
    for k in range(structure.shape[0]):
        parent = structure[k, PARENT]
        speed = numbers[k, MULTIPLIER] * qd[structure[k, Q_INDEX]]
        w, v = _vector(twist, k, 0), _vector(twist, k, 3)
        W, U = _scale(speed, w), _scale(speed, v)
        if parent >= 0:
            up = _vector(velocity, parent, 0)
            W, U = _add(up, W), _add(_cross(up, _vector(pose, k, OF_OFFSET)), U)
        _put(velocity, k, 0, W)
        _put(velocity, k, 3, U)
        # (14) V xi - xi V with V = (W, 0): rotation W x w, translation W x v.
        _put(twist_rate, k, 0, _cross(W, w))
        _put(twist_rate, k, 3, _cross(W, v))


@formula
def body_momenta(structure: Structure, velocity: Array, K: Array, momentum: Array) -> None:
    """
    Compute V_k K_k of every body, the summand of (13), relative to the joint's origin.

    Parameters
    ----------
    structure : numpy.ndarray
        See `PackedModel`.
    velocity : numpy.ndarray, shape (N, 6)
        Result of `outward_velocity`.
    K : numpy.ndarray, shape (N, 10)
        Result of `outward`.
    momentum : numpy.ndarray, shape (N, 12)
        Overwritten.

    """
    for k in range(structure.shape[0]):
        # V K with V = (W, 0): [W]× Sigma in the left block, W x h in the last column.
        W, sigma = _vector(velocity, k, 0), _second_moments(K, k, 4)
        x = _cross(W, (sigma[0], sigma[3], sigma[6]))
        y = _cross(W, (sigma[1], sigma[4], sigma[7]))
        z = _cross(W, (sigma[2], sigma[5], sigma[8]))
        _put_matrix(momentum, k, 0, _transposed((*x, *y, *z)))
        _put(momentum, k, 9, _cross(W, _vector(K, k, 1)))


# From the tips to the base -----------------------------------------------------------------


@formula
def inward_composites(structure: Structure, pose: Array, composite: Array) -> None:
    """
    Sum K over the subtree of every joint, equation (12).

    Parameters
    ----------
    structure : numpy.ndarray
        See `PackedModel`.
    pose : numpy.ndarray, shape (N, 15)
    composite : numpy.ndarray, shape (N, 10)
        K_k before, Jc_k after.

    """
    for j in range(structure.shape[0] - 1, -1, -1):
        if structure[j, PARENT] >= 0:
            _add_composite(pose, composite, j, structure[j, PARENT])


@formula
def _add_composite(pose: Array, Jc: Array, j: int, parent: int) -> None:
    # (12) and (21), with the offset d: h + m d and Sigma + h dᵀ + d hᵀ + m d dᵀ.
    m, h, d = Jc[j, 0], _vector(Jc, j, 1), _vector(pose, j, OF_OFFSET)
    moved = _add(h, _scale(m, d))
    Jc[parent, 0] += m
    _accumulate(Jc, parent, 1, moved)
    _accumulate(Jc, parent, 4, (Jc[j, 4] + h[0] * d[0] + d[0] * moved[0],
                                Jc[j, 5] + h[0] * d[1] + d[0] * moved[1],
                                Jc[j, 6] + h[0] * d[2] + d[0] * moved[2]))
    _accumulate(Jc, parent, 7, (Jc[j, 7] + h[1] * d[1] + d[1] * moved[1],
                                Jc[j, 8] + h[1] * d[2] + d[1] * moved[2],
                                Jc[j, 9] + h[2] * d[2] + d[2] * moved[2]))


@formula
def _add_momentum(pose: Array, velocity: Array, Jc: Array, Lc: Array, j: int, parent: int) -> None:
    # (13) relative to the parent's origin, from which this joint's origin moves at U: (24) adds
    # U hᵀ to the left block and U m to the last column. Then (21): L + l dᵀ.
    U, h, d = _vector(velocity, j, 3), _vector(Jc, j, 1), _vector(pose, j, OF_OFFSET)
    l = _add(_vector(Lc, j, 9), _scale(Jc[j, 0], U))  # noqa: E741 (the formula's symbol)
    for i in range(3):
        row = _add(_scale(U[i], h), _scale(l[i], d))
        _accumulate(Lc, parent, 3 * i, _add(_vector(Lc, j, 3 * i), row))
    _accumulate(Lc, parent, 9, l)


@formula
def inward_mass(structure: Structure, numbers: Array, pose: Array, twist: Array, Jc: Array,
                D: Array) -> None:
    """
    Add up D from the tips to the base, equations (12) and (15).

    Parameters
    ----------
    structure, numbers, pose, twist : numpy.ndarray
        Results of `outward`.
    Jc : numpy.ndarray, shape (N, 10)
        K_k before, Jc_k after.
    D : numpy.ndarray, shape (n, n)
        Zero before.

    """
    for j in range(structure.shape[0] - 1, -1, -1):
        if structure[j, PARENT] >= 0:
            _add_composite(pose, Jc, j, structure[j, PARENT])
        torque, force = _force(Jc, j, _vector(twist, j, 0), _vector(twist, j, 3))
        cj, mj = structure[j, Q_INDEX], numbers[j, MULTIPLIER]
        D[cj, cj] += numbers[j, ROTOR]                                           # (28)
        i = j
        while i >= 0:
            ci, scale = structure[i, Q_INDEX], numbers[i, MULTIPLIER] * mj    # (19)
            entry = scale * _pair(twist, i, torque, force)                      # (15)
            D[ci, cj] += entry
            if i != j:
                D[cj, ci] += entry
            torque = _shift_to_parent(pose, i, torque, force)
            i = structure[i, PARENT]


@formula
def inward_dynamics(structure: Structure, numbers: Array, pose: Array, twist: Array,
                    velocity: Array, twist_rate: Array, Jc: Array, Lc: Array, D: Array,
                    C: Array) -> None:
    """
    Add up D and C from the tips to the base, equations (12), (13), (15) and (16).

    Parameters
    ----------
    structure, numbers, pose, twist, velocity, twist_rate : numpy.ndarray
        Results of `outward` and `outward_velocity`.
    Jc : numpy.ndarray, shape (N, 10)
        K_k before, Jc_k after.
    Lc : numpy.ndarray, shape (N, 12)
        V_k K_k before, Lc_k after.
    D, C : numpy.ndarray, shape (n, n)
        Zero before.

    """
    for j in range(structure.shape[0] - 1, -1, -1):
        parent = structure[j, PARENT]
        if parent >= 0:
            _add_momentum(pose, velocity, Jc, Lc, j, parent)
            _add_composite(pose, Jc, j, parent)
        w, v = _vector(twist, j, 0), _vector(twist, j, 3)
        torque, force = _force(Jc, j, w, v)
        # The six numbers of (rate of xi) Jc + xi Lc, and the axial part of xi Lcᵀ.
        torque2, force2 = _force(Jc, j, _vector(twist_rate, j, 0), _vector(twist_rate, j, 3))
        L, l = _matrix(Lc, j, 0), _vector(Lc, j, 9)  # noqa: E741 (the formula's symbol)
        trace_w = _scale(L[0] + L[4] + L[8], w)
        torque2 = _add(torque2, _subtract(trace_w, _times(L, w)))
        force2 = _add(force2, _cross(w, l))
        mirrored = _add(_subtract(trace_w, _times(_transposed(L), w)), _cross(l, v))
        cj, mj = structure[j, Q_INDEX], numbers[j, MULTIPLIER]
        D[cj, cj] += numbers[j, ROTOR]                                           # (28)
        i = j
        while i >= 0:
            ci, scale = structure[i, Q_INDEX], numbers[i, MULTIPLIER] * mj    # (19)
            entry = scale * _pair(twist, i, torque, force)                      # (15)
            D[ci, cj] += entry
            C[ci, cj] += scale * _pair(twist, i, torque2, force2)               # (16), i above j
            if i != j:
                D[cj, ci] += entry
                C[cj, ci] += scale * (_pair(twist_rate, i, torque, force)       # (16), i below j:
                                      + _dot(_vector(twist, i, 0), mirrored))    # swapped names
            torque = _shift_to_parent(pose, i, torque, force)
            torque2 = _shift_to_parent(pose, i, torque2, force2)
            # xi Lcᵀ relative to the parent's origin: (24) and axial(f Uᵀ) = U x f.
            mirrored = _add(mirrored, _cross(_vector(velocity, i, 3), force))
            i = structure[i, PARENT]


@formula
def _force(Jc: Array, j: int, w: Vector, v: Vector) -> tuple[Vector, Vector]:
    # The six numbers of xi Jc that (18) needs: axial part tr(Sigma) w - Sigma w + h x v,
    # last column w x h + m v.
    h, sigma = _vector(Jc, j, 1), _second_moments(Jc, j, 4)
    return _add(_axial(sigma, w), _cross(h, v)), _add(_cross(w, h), _scale(Jc[j, 0], v))


@formula
def _axial(sigma: Matrix, w: Vector) -> Vector:
    # (18): axial([w]× Sigma) = tr(Sigma) w - Sigma w for a symmetric Sigma, with the differences
    # canceled.
    return ((sigma[4] + sigma[8]) * w[0] - sigma[1] * w[1] - sigma[2] * w[2],
            (sigma[0] + sigma[8]) * w[1] - sigma[1] * w[0] - sigma[5] * w[2],
            (sigma[0] + sigma[4]) * w[2] - sigma[2] * w[0] - sigma[5] * w[1])


@formula
def _pair(twist: Array, i: int, torque: Vector, force: Vector) -> Scalar:
    # (18): tr(B xiᵀ) = w · axial(B) + v · b.
    return _dot(_vector(twist, i, 0), torque) + _dot(_vector(twist, i, 3), force)


@formula
def _shift_to_parent(pose: Array, i: int, torque: Vector, force: Vector) -> Vector:
    # (21), from joint i to its parent: the axial part gains d x (last column).
    return _add(torque, _cross(_vector(pose, i, OF_OFFSET), force))


@formula
def gravity_torques(structure: Structure, numbers: Array, twist: Array, Jc: Array,
                    G: Array) -> None:
    """
    Add up G_l = -g · (w x h + m v), equation (17): the last column of xi Jc.

    Parameters
    ----------
    structure, numbers, twist : numpy.ndarray
        Results of `outward`; gravity is the last row of `numbers`.
    Jc : numpy.ndarray, shape (N, 10)
        Composites.
    G : numpy.ndarray, shape (n,)
        Zero before.

    """
    gravity = _vector(numbers, structure.shape[0], 0)
    for k in range(structure.shape[0]):
        column = _add(_cross(_vector(twist, k, 0), _vector(Jc, k, 1)),
                      _scale(Jc[k, 0], _vector(twist, k, 3)))
        G[structure[k, Q_INDEX]] -= numbers[k, MULTIPLIER] * _dot(gravity, column)


@formula
def potential_energy(structure: Structure, numbers: Array, pose: Array, Jc: Array) -> Scalar:
    """
    Return V = -g · (h + m p) of the whole tree, equation (20).

    Parameters
    ----------
    structure, numbers, pose : numpy.ndarray
        Results of `outward`; gravity is the last row of `numbers`.
    Jc : numpy.ndarray, shape (N, 10)
        Composites.

    Returns
    -------
    float
        J.

    """
    energy = 0.0
    for k in range(structure.shape[0]):
        if structure[k, PARENT] < 0:
            first_moment = _add(_vector(Jc, k, 1), _scale(Jc[k, 0], _vector(pose, k, OF_ORIGIN)))
            energy = energy - _dot(_vector(numbers, structure.shape[0], 0), first_moment)
    return energy


# Efforts of a motion, without matrices -----------------------------------------------------


@formula
def outward_acceleration(structure: Structure, numbers: Array, qd: Array, qdd: Array, pose: Array,
                         twist: Array, velocity: Array, twist_rate: Array,
                         acceleration: Array) -> None:
    """
    Compute A'' = H A of every body, base to tips, in a world that accelerates by -g.

    Parameters
    ----------
    structure, numbers, pose, twist, velocity, twist_rate : numpy.ndarray
        As `outward` and `outward_velocity` leave them; gravity is the last row of `numbers`.
    qd, qdd : numpy.ndarray, shape (n,)
    acceleration : numpy.ndarray, shape (N, 6)
        Overwritten: angular acceleration and the acceleration of the joint's origin, which make
        up H by equation (22).

    """
    for k in range(structure.shape[0]):
        parent, multiplier = structure[k, PARENT], numbers[k, MULTIPLIER]
        speed = multiplier * qd[structure[k, Q_INDEX]]
        change = multiplier * qdd[structure[k, Q_INDEX]]
        # (23), this joint's part: xi q'' + (rate of xi) q', twice the rate for a prismatic joint,
        # whose axis turns with the body.
        a = _add(_scale(change, _vector(twist, k, 0)), _scale(speed, _vector(twist_rate, k, 0)))
        c = _add(_scale(change, _vector(twist, k, 3)),
                 _scale(2.0 * speed, _vector(twist_rate, k, 3)))
        if parent >= 0:
            # The last column of the parent's H, shifted by the offset: c + [a]× d + W x (W x d).
            up, W = _vector(acceleration, parent, 0), _vector(velocity, parent, 0)
            d = _vector(pose, k, OF_OFFSET)
            c = _add(c, _add(_vector(acceleration, parent, 3),
                             _add(_cross(up, d), _cross(W, _cross(W, d)))))
            a = _add(a, up)
        else:
            c = _subtract(c, _vector(numbers, structure.shape[0], 0))
        _put(acceleration, k, 0, a)
        _put(acceleration, k, 3, c)


@formula
def inward_efforts(structure: Structure, numbers: Array, pose: Array, twist: Array,
                   velocity: Array, acceleration: Array, K: Array, wrench: Array,
                   tau: Array) -> None:
    """
    Add up the efforts of a motion from the tips to the base, equation (22).

    Parameters
    ----------
    structure, numbers, pose, twist, velocity, acceleration, K : numpy.ndarray
        Results of the outward functions.
    wrench : numpy.ndarray, shape (N, 6)
        Overwritten: axial part and last column of the sum of H K over the subtree.
    tau : numpy.ndarray, shape (n,)
        Zero before.

    """
    for k in range(structure.shape[0]):
        torque, force = _wrench(K, k, _vector(velocity, k, 0), _vector(acceleration, k, 0),
                                _vector(acceleration, k, 3))
        _put(wrench, k, 0, torque)
        _put(wrench, k, 3, force)
    for j in range(structure.shape[0] - 1, -1, -1):
        torque, force = _vector(wrench, j, 0), _vector(wrench, j, 3)
        effort = numbers[j, MULTIPLIER] * _pair(twist, j, torque, force)
        tau[structure[j, Q_INDEX]] += effort
        if structure[j, PARENT] >= 0:
            _accumulate(wrench, structure[j, PARENT], 0, _shift_to_parent(pose, j, torque, force))
            _accumulate(wrench, structure[j, PARENT], 3, force)


@formula
def _wrench(K: Array, k: int, W: Vector, a: Vector, c: Vector) -> tuple[Vector, Vector]:
    # H K has the left block [a]× + [W]×[W]× and the last column c; hence by (18), in any axes:
    h, sigma = _vector(K, k, 1), _second_moments(K, k, 4)
    return (_add(_axial(sigma, a), _add(_cross(_times(sigma, W), W), _cross(h, c))),
            _add(_add(_cross(a, h), _cross(W, _cross(W, h))), _scale(K[k, 0], c)))


# Efforts per number of J -------------------------------------------------------------------


@formula
def inward_regressor(structure: Structure, numbers: Array, pose: Array, twist: Array,
                     velocity: Array, acceleration: Array, unit: Array, Y: Array) -> None:
    """
    Add up the efforts that one unit of each of the ten numbers of every J takes, equation (36).

    Parameters
    ----------
    structure, numbers, pose, twist, velocity, acceleration : numpy.ndarray
        Results of the outward functions.
    unit : numpy.ndarray, shape (N, 10)
        Overwritten.
    Y : numpy.ndarray, shape (n, 10 N)
        Zero before; columns 10 k to 10 k + 9 are m, h and the second moments of body k.

    """
    for k in range(structure.shape[0]):
        R = _matrix(pose, k, OF_ROTATION)
        to_body = _transposed(R)
        # J is constant in the axes of the body, so its wrench is taken there.
        W = _times(to_body, _vector(velocity, k, 0))
        a = _times(to_body, _vector(acceleration, k, 0))
        c = _times(to_body, _vector(acceleration, k, 3))
        for p in range(10):
            for other in range(10):
                unit[k, other] = 0.0
            unit[k, p] = 1.0
            torque, force = _wrench(unit, k, W, a, c)
            torque, force = _times(R, torque), _times(R, force)
            i = k
            while i >= 0:
                Y[structure[i, Q_INDEX], 10 * k + p] += (numbers[i, MULTIPLIER]   # (19)
                                                         * _pair(twist, i, torque, force))
                torque = _shift_to_parent(pose, i, torque, force)
                i = structure[i, PARENT]


# Vectors of three numbers and row-major matrices of nine -----------------------------------


@formula
def _vector(array: Array, row: int, column: int) -> Vector:
    # Three numbers from `column` on.
    return array[row, column], array[row, column + 1], array[row, column + 2]


@formula
def _matrix(array: Array, row: int, column: int) -> Matrix:
    # Nine numbers from `column` on.
    return (array[row, column], array[row, column + 1], array[row, column + 2],
            array[row, column + 3], array[row, column + 4], array[row, column + 5],
            array[row, column + 6], array[row, column + 7], array[row, column + 8])


@formula
def _second_moments(array: Array, row: int, column: int) -> Matrix:
    # Symmetric, from xx, xy, xz, yy, yz, zz.
    xx, xy, xz = _vector(array, row, column)
    yy, yz, zz = _vector(array, row, column + 3)
    return xx, xy, xz, xy, yy, yz, xz, yz, zz


@formula
def _put(array: Array, row: int, column: int, a: Vector) -> None:
    array[row, column], array[row, column + 1], array[row, column + 2] = a


@formula
def _put_matrix(array: Array, row: int, column: int, A: Matrix) -> None:
    _put(array, row, column, (A[0], A[1], A[2]))
    _put(array, row, column + 3, (A[3], A[4], A[5]))
    _put(array, row, column + 6, (A[6], A[7], A[8]))


@formula
def _accumulate(array: Array, row: int, column: int, a: Vector) -> None:
    array[row, column] += a[0]
    array[row, column + 1] += a[1]
    array[row, column + 2] += a[2]


@formula
def _add(a: Vector, b: Vector) -> Vector:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@formula
def _subtract(a: Vector, b: Vector) -> Vector:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@formula
def _scale(factor: Scalar, a: Vector) -> Vector:
    return factor * a[0], factor * a[1], factor * a[2]


@formula
def _dot(a: Vector, b: Vector) -> Scalar:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@formula
def _cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@formula
def _times(A: Matrix, b: Vector) -> Vector:
    # A b.
    return (A[0] * b[0] + A[1] * b[1] + A[2] * b[2],
            A[3] * b[0] + A[4] * b[1] + A[5] * b[2],
            A[6] * b[0] + A[7] * b[1] + A[8] * b[2])


@formula
def _product(A: Matrix, B: Matrix) -> Matrix:
    # A B.
    x, y, z = (B[0], B[3], B[6]), (B[1], B[4], B[7]), (B[2], B[5], B[8])
    return _transposed((*_times(A, x), *_times(A, y), *_times(A, z)))


@formula
def _transposed(A: Matrix) -> Matrix:
    return A[0], A[3], A[6], A[1], A[4], A[7], A[2], A[5], A[8]
