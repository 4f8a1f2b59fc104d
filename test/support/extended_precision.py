"""
A reference in 80-bit arithmetic, which decides where two others differ.

It has its own URDF reader and computes the sums of docs/mathematics.md, section 3, with the
derivatives of the 4x4 transforms by the product rule along the chain. It shares no code with the
library. Its rounding is 2000 times smaller than that of double precision, and each body is kept
in its own frame, so that no large moments are subtracted.

"""

from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np

from .mimic import mimic_chains

REAL = np.longdouble
MOVABLE = ('revolute', 'continuous', 'prismatic')


class ExactTerms(NamedTuple):
    """
    D (n, n), C (n, n), G (n,), kinetic and potential energy, all in 80 bits.

    `height` bounds the summands of the potential energy: |g| times the sum of the masses, each
    times its distance from the origin of the base.

    """

    D: np.ndarray
    C: np.ndarray
    G: np.ndarray
    kinetic: np.longdouble
    potential: np.longdouble
    height: np.longdouble


class ExtendedPrecision:
    """The dynamics of a URDF in 80-bit arithmetic."""

    def __init__(self, text, gravity=(0.0, 0.0, -9.81)):
        """Read URDF text."""
        if np.finfo(REAL).eps > 1e-18:
            raise RuntimeError(
                'expected 80-bit long doubles, this machine has none: run this on x86-64'
            )
        self.gravity = np.array([*gravity, 0.0], dtype=REAL)
        robot = ElementTree.fromstring(text.encode())
        self._mimic = mimic_chains(robot)
        self._order, self._links = _walk(robot)
        inertia = {link.get('name'): _pseudo_inertia(link) for link in robot.findall('link')}
        count = len(self._order)
        self._J = np.zeros((count, 4, 4), dtype=REAL)
        for name, (body, placement) in self._links.items():
            if body >= 0:
                self._J[body] += placement @ inertia[name] @ placement.T

    def fold(self, names):
        """Return B (N, n) and b (N,) with the joints at B q + b."""
        B = np.zeros((len(self._order), len(names)), dtype=REAL)
        b = np.zeros(len(self._order), dtype=REAL)
        for row, joint in enumerate(self._order):
            leader, multiplier, offset = self._mimic.get(joint.name, (joint.name, 1.0, 0.0))
            B[row, list(names).index(leader)] = multiplier
            b[row] = offset
        return B, b

    def dynamics(self, names, q, qd):
        """Return the terms for the independent joints in the order of names."""
        B, b = self.fold(names)
        A, dA, ddA = self._transforms(
            B @ np.array(q, dtype=REAL) + b, B @ np.array(qd, dtype=REAL)
        )
        count = len(self._order)
        # Rows of (6) and (7): tr(X J Yᵀ) is the sum over the elements of (X J) * Y.
        flat = dA.transpose(1, 0, 2, 3).reshape(count, -1)
        D = flat @ (dA @ self._J[:, None]).transpose(1, 0, 2, 3).reshape(count, -1).T
        C = flat @ (ddA @ self._J[:, None]).transpose(1, 0, 2, 3).reshape(count, -1).T
        mass_points = self._J[:, :, 3]
        G = -(self.gravity @ (dA @ mass_points[:, None, :, None])[..., 0].sum(axis=0).T)
        points = (A @ mass_points[:, :, None])[:, :3, 0]
        V = -(points @ self.gravity[:3]).sum()
        height = np.sqrt((self.gravity**2).sum()) * np.sqrt((points**2).sum(axis=1)).sum()
        qd = np.array(qd, dtype=REAL)
        D = B.T @ D @ B
        return ExactTerms(D, B.T @ C @ B, B.T @ G, qd @ D @ qd / 2, V, height)

    def _transforms(self, positions, speeds):
        # A_k, dA[k, i] = ∂A_k/∂q_i, and the rate of dA along the motion, which is
        # Σ_j ∂²A_k/∂q_i∂q_j q̇_j: all by the product rule, one joint at a time.
        count = len(self._order)
        A = np.zeros((count, 4, 4), dtype=REAL)
        rate = np.zeros((count, 4, 4), dtype=REAL)
        dA = np.zeros((count, count, 4, 4), dtype=REAL)
        ddA = np.zeros((count, count, 4, 4), dtype=REAL)
        for k, joint in enumerate(self._order):
            E, dE, ddE = (joint.placement @ motion for motion in joint.motion(positions[k]))
            dot = speeds[k]
            if joint.parent < 0:
                A[k], rate[k], dA[k, k], ddA[k, k] = E, dE * dot, dE, ddE * dot
                continue
            p = joint.parent
            A[k] = A[p] @ E
            rate[k] = rate[p] @ E + A[p] @ dE * dot
            dA[k] = dA[p] @ E
            ddA[k] = ddA[p] @ E + dA[p] @ dE * dot
            dA[k, k] = A[p] @ dE
            ddA[k, k] = rate[p] @ dE + A[p] @ ddE * dot
        return A, dA, ddA


def solve(matrix, right):
    """Return the solution of a positive definite system in 80-bit arithmetic, shape (n,)."""
    L = np.array(matrix, dtype=REAL)
    x = np.array(right, dtype=REAL)
    n = len(x)
    for k in range(n):
        L[k, k] = np.sqrt(L[k, k])
        L[k + 1 :, k] /= L[k, k]
        L[k + 1 :, k + 1 :] -= np.outer(L[k + 1 :, k], L[k + 1 :, k])
    for k in range(n):
        x[k] = (x[k] - L[k, :k] @ x[:k]) / L[k, k]
    for k in reversed(range(n)):
        x[k] = (x[k] - L[k + 1 :, k] @ x[k + 1 :]) / L[k, k]
    return x


class _Joint:
    """A movable joint: its parent body, placement and axis."""

    def __init__(self, element, parent, placement):
        self.name = element.get('name')
        self.slides = element.get('type') == 'prismatic'
        self.parent, self.placement = parent, placement
        axis = element.find('axis')
        x, y, z = _numbers(axis.get('xyz') if axis is not None else '1 0 0')
        self.axis = np.array([x, y, z]) / np.sqrt(x * x + y * y + z * z)

    def motion(self, position):
        """Return the transform of the joint and its two derivatives, (4, 4) each."""
        one, hat = np.eye(4, dtype=REAL), np.zeros((4, 4), dtype=REAL)
        if self.slides:
            hat[:3, 3] = self.axis
            return one + position * hat, hat, 0 * hat
        x, y, z = self.axis
        hat[:3, :3] = [[0, -z, y], [z, 0, -x], [-y, x, 0]]
        s, c, square = np.sin(position), np.cos(position), hat @ hat
        return one + s * hat + (1 - c) * square, c * hat + s * square, c * square - s * hat


def _walk(robot):
    # The movable joints, parents first, and (body, placement in it) of each link.
    joints = robot.findall('joint')
    children = {joint.find('child').get('link') for joint in joints}
    links = {
        link.get('name'): (-1, np.eye(4, dtype=REAL))
        for link in robot.findall('link')
        if link.get('name') not in children
    }
    order = []
    waiting = joints
    while waiting:
        later = []
        for joint in waiting:
            parent = joint.find('parent').get('link')
            if parent not in links:
                later.append(joint)
                continue
            body, placement = links[parent]
            placement = placement @ _placement(joint.find('origin'))
            if joint.get('type') in MOVABLE:
                order.append(_Joint(joint, body, placement))
                body, placement = len(order) - 1, np.eye(4, dtype=REAL)
            links[joint.find('child').get('link')] = body, placement
        waiting = later
    return order, links


def _pseudo_inertia(link):
    J = np.zeros((4, 4), dtype=REAL)
    inertial = link.find('inertial')
    if inertial is None:
        return J
    entry = {key: _numbers(value)[0] for key, value in inertial.find('inertia').items()}
    tensor = np.array(
        [
            [entry['ixx'], entry['ixy'], entry['ixz']],
            [entry['ixy'], entry['iyy'], entry['iyz']],
            [entry['ixz'], entry['iyz'], entry['izz']],
        ],
        dtype=REAL,
    )
    J[:3, :3] = np.trace(tensor) / 2 * np.eye(3, dtype=REAL) - tensor
    J[3, 3] = _numbers(inertial.find('mass').get('value'))[0]
    placement = _placement(inertial.find('origin'))
    return placement @ J @ placement.T


def _placement(origin):
    result = np.eye(4, dtype=REAL)
    if origin is None:
        return result
    (cr, sr), (cp, sp), (cy, sy) = (
        (np.cos(angle), np.sin(angle)) for angle in _numbers(origin.get('rpy', '0 0 0'))
    )
    result[:3, :3] = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    result[:3, 3] = _numbers(origin.get('xyz', '0 0 0'))
    return result


def _numbers(text):
    # As doubles first, like all readers.
    return np.array([float(part) for part in text.split()]).astype(REAL)
