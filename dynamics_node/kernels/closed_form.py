"""
The closed form: D, C and G in two sweeps over the tree. Compiled.

Equation numbers are those of docs/mathematics.md, section 4. They hold in every frame at rest;
here each joint has one of its own, with the axes of the base and its origin on the joint. So a
light finger far from the base keeps all its digits. What passes from one joint to another is
moved by the offset between them, equation (21).

Every 4x4 matrix has few different numbers, and only those are kept:

    pose          = (rotation, row-major; origin; offset)   body → base; offset: from the parent
    twist     xi  = (wx wy wz vx vy vz)                     of the joint
    composite Jc  = (m, hx hy hz, xx xy xz yy yz zz)        symmetric 4x4
    momentum  Lc  = (xx xy xz yx yy yz zx zy zz, x y z)     3x4: left 3x3 block, last column

All functions of one file, because numba's cache on disk does not notice a change in a callee
that lives in another file.

"""

import math

import numpy as np

from .jit import compiled
from .packing import (
    AXIS,
    COORDINATE,
    INERTIA,
    KIND,
    MULTIPLIER,
    OFFSET,
    PARENT,
    TRANSLATION,
)

_PRISMATIC = 1


@compiled
def dynamics(structure, numbers, q, qd, out):
    """
    Compute D, C, G and the potential energy of B states.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `packing.pack`.
    q, qd : numpy.ndarray, shape (B, n)
        Joint positions (rad or m) and velocities.
    out : numpy.ndarray, shape (B, 2 n² + n + 1)
        Overwritten: D row-major, C row-major, G, V.

    """
    bodies, n = structure.shape[0], q.shape[1]
    pose, twist, composite = _workspace(bodies)
    twist_rate = np.empty((bodies, 6))
    momentum = np.empty((bodies, 12))
    for state in range(q.shape[0]):
        row = out[state]
        row[:] = 0.0
        outward(structure, numbers, q[state], pose, twist, composite)
        _outward_velocity(structure, numbers, qd[state], pose, twist, composite, twist_rate,
                          momentum)
        _inward_dynamics(structure, numbers, pose, twist, composite, twist_rate, momentum,
                         row[:n * n].reshape(n, n), row[n * n:2 * n * n].reshape(n, n))
        _gravity_from_composites(structure, numbers, pose, twist, composite, row[2 * n * n:])


@compiled
def mass_matrix(structure, numbers, q, out):
    """
    Compute D of B states.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `packing.pack`.
    q : numpy.ndarray, shape (B, n)
    out : numpy.ndarray, shape (B, n, n)
        Overwritten.

    """
    pose, twist, composite = _workspace(structure.shape[0])
    for state in range(q.shape[0]):
        out[state] = 0.0
        outward(structure, numbers, q[state], pose, twist, composite)
        _inward_mass(structure, numbers, pose, twist, composite, out[state])


@compiled
def gravity_torque(structure, numbers, q, out):
    """
    Compute G and the potential energy of B states.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `packing.pack`.
    q : numpy.ndarray, shape (B, n)
    out : numpy.ndarray, shape (B, n + 1)
        Overwritten: G, V.

    """
    pose, twist, composite = _workspace(structure.shape[0])
    for state in range(q.shape[0]):
        out[state] = 0.0
        outward(structure, numbers, q[state], pose, twist, composite)
        _inward_composites(structure, pose, composite)
        _gravity_from_composites(structure, numbers, pose, twist, composite, out[state])


@compiled
def _workspace(bodies):
    return np.empty((bodies, 15)), np.empty((bodies, 6)), np.empty((bodies, 10))


@compiled
def outward(structure, numbers, q, pose, twist, composite):
    """
    Walk from the base to the tips: pose A_k, twist xi_k, pseudo-inertia K_k of every body.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `packing.pack`.
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
        row = numbers[k]
        position = row[MULTIPLIER] * q[structure[k, COORDINATE]] + row[OFFSET]
        _joint_frame(structure[k, PARENT], row, pose, pose[k])
        _joint_twist(structure[k, KIND], row, pose[k], twist[k])
        _move(structure[k, KIND], row, position, twist[k], pose[k])
        _pseudo_inertia_in_base(row, pose[k], composite[k])


@compiled
def _joint_frame(parent, row, pose, here):
    # A_parent X_k: the joint frame at position 0, in the base frame.
    if parent < 0:
        here[:12] = row[:12]
        here[12:] = row[9:12]
        return
    up = pose[parent]
    for i in range(3):
        a, b, c = up[3 * i], up[3 * i + 1], up[3 * i + 2]
        for j in range(3):
            here[3 * i + j] = a * row[j] + b * row[3 + j] + c * row[6 + j]
        here[12 + i] = (a * row[TRANSLATION] + b * row[TRANSLATION + 1]
                        + c * row[TRANSLATION + 2])
        here[9 + i] = up[9 + i] + here[12 + i]


@compiled
def _joint_twist(kind, row, here, xi):
    # (9) with the origin on the joint: revolute w = axis, v = 0; prismatic w = 0, v = axis. The
    # axis does not turn with the joint's own position, so the frame at position 0 will do.
    ax, ay, az = row[AXIS], row[AXIS + 1], row[AXIS + 2]
    first = 3 if kind == _PRISMATIC else 0
    xi[:] = 0.0
    for i in range(3):
        xi[first + i] = here[3 * i] * ax + here[3 * i + 1] * ay + here[3 * i + 2] * az


@compiled
def _move(kind, row, position, xi, here):
    # A_k = A_parent X_k E(position): slide along the axis, or turn by Rodrigues' formula.
    if kind == _PRISMATIC:
        for i in range(3):
            here[9 + i] += position * xi[3 + i]
            here[12 + i] += position * xi[3 + i]
        return
    s, c = math.sin(position), math.cos(position)
    ax, ay, az = row[AXIS], row[AXIS + 1], row[AXIS + 2]
    for i in range(3):
        x, y, z = here[3 * i], here[3 * i + 1], here[3 * i + 2]
        along = (1.0 - c) * (x * ax + y * ay + z * az)
        here[3 * i] = c * x + s * (y * az - z * ay) + along * ax
        here[3 * i + 1] = c * y + s * (z * ax - x * az) + along * ay
        here[3 * i + 2] = c * z + s * (x * ay - y * ax) + along * az


@compiled
def _pseudo_inertia_in_base(row, here, K):
    # (10): K = A J Aᵀ in the axes of the base, with the origin on the joint: R Sigma Rᵀ, R h, m.
    hx, hy, hz = row[INERTIA + 1], row[INERTIA + 2], row[INERTIA + 3]
    xx, xy, xz = row[INERTIA + 4], row[INERTIA + 5], row[INERTIA + 6]
    yy, yz, zz = row[INERTIA + 7], row[INERTIA + 8], row[INERTIA + 9]
    K[0] = row[INERTIA]
    entry = 4
    for i in range(3):
        a, b, c = here[3 * i], here[3 * i + 1], here[3 * i + 2]
        K[1 + i] = a * hx + b * hy + c * hz
        u, v, w = a * xx + b * xy + c * xz, a * xy + b * yy + c * yz, a * xz + b * yz + c * zz
        for j in range(i, 3):
            K[entry] = u * here[3 * j] + v * here[3 * j + 1] + w * here[3 * j + 2]
            entry += 1


@compiled
def _outward_velocity(structure, numbers, qd, pose, twist, K, twist_rate, momentum):
    # (11) V_k = V_parent + xi_k qd_k, (14) rate of xi_k, and V_k K_k, the summand of (13). The
    # parent's twist is moved to this joint first, (21).
    velocity = np.empty((structure.shape[0], 6))
    for k in range(structure.shape[0]):
        V, xi = velocity[k], twist[k]
        speed = numbers[k, MULTIPLIER] * qd[structure[k, COORDINATE]]
        parent = structure[k, PARENT]
        for i in range(6):
            V[i] = xi[i] * speed
        if parent >= 0:
            up = velocity[parent]
            x, y, z = _cross(up[0], up[1], up[2], pose[k, 12], pose[k, 13], pose[k, 14])
            V[0] += up[0]
            V[1] += up[1]
            V[2] += up[2]
            V[3] += up[3] + x
            V[4] += up[4] + y
            V[5] += up[5] + z
        _commutator(V, xi, twist_rate[k])
        _momentum(V, K[k], momentum[k])


@compiled
def _commutator(V, xi, rate):
    # (14): V xi - xi V. Rotation W x w; translation W x v - w x U, with V = (W, U).
    rate[0], rate[1], rate[2] = _cross(V[0], V[1], V[2], xi[0], xi[1], xi[2])
    x, y, z = _cross(V[0], V[1], V[2], xi[3], xi[4], xi[5])
    u, v, w = _cross(xi[0], xi[1], xi[2], V[3], V[4], V[5])
    rate[3], rate[4], rate[5] = x - u, y - v, z - w


@compiled
def _momentum(V, K, L):
    # V K = [W]x Sigma + U hᵀ in the left block, W x h + m U in the last column.
    m, hx, hy, hz = K[0], K[1], K[2], K[3]
    xx, xy, xz, yy, yz, zz = K[4], K[5], K[6], K[7], K[8], K[9]
    a, b, c = _cross(V[0], V[1], V[2], xx, xy, xz)
    L[0], L[3], L[6] = a + V[3] * hx, b + V[4] * hx, c + V[5] * hx
    a, b, c = _cross(V[0], V[1], V[2], xy, yy, yz)
    L[1], L[4], L[7] = a + V[3] * hy, b + V[4] * hy, c + V[5] * hy
    a, b, c = _cross(V[0], V[1], V[2], xz, yz, zz)
    L[2], L[5], L[8] = a + V[3] * hz, b + V[4] * hz, c + V[5] * hz
    a, b, c = _cross(V[0], V[1], V[2], hx, hy, hz)
    L[9], L[10], L[11] = a + m * V[3], b + m * V[4], c + m * V[5]


@compiled
def _inward_composites(structure, pose, composite):
    # (12): Jc_j = sum of K over the subtree of j, from the tips inward.
    for j in range(structure.shape[0] - 1, -1, -1):
        if structure[j, PARENT] >= 0:
            _add_composite(composite[j], pose[j], composite[structure[j, PARENT]])


@compiled
def _add_composite(Jc, here, up):
    # (12) and (21): the parent's composite gains this one, moved by the offset d.
    # h + m d and Sigma + h dᵀ + d hᵀ + m d dᵀ.
    m = Jc[0]
    up[0] += m
    entry = 4
    for i in range(3):
        d = here[12 + i]
        up[1 + i] += Jc[1 + i] + m * d
        for j in range(i, 3):
            up[entry] += (Jc[entry] + Jc[1 + i] * here[12 + j] + d * Jc[1 + j]
                          + m * d * here[12 + j])
            entry += 1


@compiled
def _add_momentum(Lc, here, up):
    # (13) and (21): L + l dᵀ in the left block, l in the last column.
    for i in range(3):
        for j in range(3):
            up[3 * i + j] += Lc[3 * i + j] + Lc[9 + i] * here[12 + j]
        up[9 + i] += Lc[9 + i]


@compiled
def _inward_mass(structure, numbers, pose, twist, composite, D):
    force = np.empty(6)
    for j in range(structure.shape[0] - 1, -1, -1):
        if structure[j, PARENT] >= 0:
            _add_composite(composite[j], pose[j], composite[structure[j, PARENT]])
        _force(twist[j], composite[j], force)
        cj, mj = structure[j, COORDINATE], numbers[j, MULTIPLIER]
        l = j  # noqa: E741 (the symbol of the formula)
        while l >= 0:
            cl, ml = structure[l, COORDINATE], numbers[l, MULTIPLIER]
            entry = ml * mj * _dot(twist[l], force)          # (15), (19)
            D[cl, cj] += entry
            if l != j:
                D[cj, cl] += entry
            _to_parent(pose[l], force)
            l = structure[l, PARENT]  # noqa: E741


@compiled
def _inward_dynamics(structure, numbers, pose, twist, composite, twist_rate, momentum, D, C):
    force, rate_force, transposed = np.empty(6), np.empty(6), np.empty(3)
    for j in range(structure.shape[0] - 1, -1, -1):
        parent = structure[j, PARENT]
        if parent >= 0:
            _add_composite(composite[j], pose[j], composite[parent])
            _add_momentum(momentum[j], pose[j], momentum[parent])
        _force(twist[j], composite[j], force)
        _force(twist_rate[j], composite[j], rate_force)
        _momentum_force(twist[j], momentum[j], rate_force, transposed)
        cj, mj = structure[j, COORDINATE], numbers[j, MULTIPLIER]
        l = j  # noqa: E741 (the symbol of the formula)
        while l >= 0:
            cl, ml = structure[l, COORDINATE], numbers[l, MULTIPLIER]
            xi, scale = twist[l], ml * mj                    # (19)
            entry = scale * _dot(xi, force)                  # (15)
            D[cl, cj] += entry
            C[cl, cj] += scale * _dot(xi, rate_force)        # (16), l above j
            if l != j:
                D[cj, cl] += entry
                C[cj, cl] += scale * (                       # (16), l below j: swapped names
                    _dot(twist_rate[l], force)
                    + xi[0] * transposed[0] + xi[1] * transposed[1] + xi[2] * transposed[2])
            _to_parent(pose[l], force)
            _to_parent(pose[l], rate_force)
            l = structure[l, PARENT]  # noqa: E741


@compiled
def _to_parent(here, force):
    # (21): the axial part gains d x (last column).
    x, y, z = _cross(here[12], here[13], here[14], force[3], force[4], force[5])
    force[0] += x
    force[1] += y
    force[2] += z


@compiled
def _force(xi, Jc, force):
    # The six numbers of xi Jc that (18) needs: axial part tr(Sigma) w - Sigma w + h x v,
    # last column w x h + m v.
    m, hx, hy, hz = Jc[0], Jc[1], Jc[2], Jc[3]
    xx, xy, xz, yy, yz, zz = Jc[4], Jc[5], Jc[6], Jc[7], Jc[8], Jc[9]
    wx, wy, wz, vx, vy, vz = xi[0], xi[1], xi[2], xi[3], xi[4], xi[5]
    a, b, c = _cross(hx, hy, hz, vx, vy, vz)
    force[0] = (yy + zz) * wx - xy * wy - xz * wz + a
    force[1] = (xx + zz) * wy - xy * wx - yz * wz + b
    force[2] = (xx + yy) * wz - xz * wx - yz * wy + c
    a, b, c = _cross(wx, wy, wz, hx, hy, hz)
    force[3], force[4], force[5] = a + m * vx, b + m * vy, c + m * vz


@compiled
def _momentum_force(xi, L, rate_force, transposed):
    # xi Lc, added to the force of the twist's rate: axial part tr(L) w - L w, column w x l;
    # and the axial part of xi Lcᵀ for the mirrored entry: tr(L) w - Lᵀ w + l x v.
    wx, wy, wz = xi[0], xi[1], xi[2]
    trace = L[0] + L[4] + L[8]
    rate_force[0] += trace * wx - L[0] * wx - L[1] * wy - L[2] * wz
    rate_force[1] += trace * wy - L[3] * wx - L[4] * wy - L[5] * wz
    rate_force[2] += trace * wz - L[6] * wx - L[7] * wy - L[8] * wz
    a, b, c = _cross(wx, wy, wz, L[9], L[10], L[11])
    rate_force[3] += a
    rate_force[4] += b
    rate_force[5] += c
    a, b, c = _cross(L[9], L[10], L[11], xi[3], xi[4], xi[5])
    transposed[0] = trace * wx - L[0] * wx - L[3] * wy - L[6] * wz + a
    transposed[1] = trace * wy - L[1] * wx - L[4] * wy - L[7] * wz + b
    transposed[2] = trace * wz - L[2] * wx - L[5] * wy - L[8] * wz + c


@compiled
def _gravity_from_composites(structure, numbers, pose, twist, Jc, out):
    # (17): G_l = -g · (w x h + m v), the last column of xi Jc; and V = -g · (h + m p) of (20).
    bodies, n = structure.shape[0], out.shape[0] - 1
    gx, gy, gz = numbers[bodies, 0], numbers[bodies, 1], numbers[bodies, 2]
    for k in range(bodies):
        m, hx, hy, hz = Jc[k, 0], Jc[k, 1], Jc[k, 2], Jc[k, 3]
        a, b, c = _cross(twist[k, 0], twist[k, 1], twist[k, 2], hx, hy, hz)
        pull = (gx * (a + m * twist[k, 3]) + gy * (b + m * twist[k, 4])
                + gz * (c + m * twist[k, 5]))
        out[structure[k, COORDINATE]] -= numbers[k, MULTIPLIER] * pull
        if structure[k, PARENT] < 0:
            out[n] -= (gx * (hx + m * pose[k, 9]) + gy * (hy + m * pose[k, 10])
                       + gz * (hz + m * pose[k, 11]))


@compiled
def _cross(ax, ay, az, bx, by, bz):
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


@compiled
def _dot(a, b):
    # (18)
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] + a[4] * b[4] + a[5] * b[5]
