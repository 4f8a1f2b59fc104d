"""Pinocchio as an independent judge, with its own reading of the URDF."""

from xml.etree import ElementTree

import numpy as np
import pinocchio

from .mimic import mimic_chains


class PinocchioOracle:
    """D, C, G, inverse and forward dynamics and the energies of a URDF by Pinocchio."""

    def __init__(self, text, gravity=(0.0, 0.0, -9.81)):
        """Read URDF text; every joint, also a mimic one, becomes a joint of its own."""
        self.model = pinocchio.buildModelFromXML(text)
        self.model.gravity.linear = np.array(gravity)
        self.data = self.model.createData()
        self._mimic = mimic_chains(ElementTree.fromstring(text.encode()))

    def fold(self, names):
        """Return B (nv, n) and b (nv,) with v = B qd and the joints at B q + b."""
        B, b = np.zeros((self.model.nv, len(names))), np.zeros(self.model.nv)
        for name in self.model.names[1:]:
            joint = self.model.joints[self.model.getJointId(name)]
            leader, multiplier, offset = self._mimic.get(name, (name, 1.0, 0.0))
            B[joint.idx_v, names.index(leader)] = multiplier
            b[joint.idx_v] = offset
        return B, b

    def dynamics(self, names, q, qd):
        """Return D, C and G for the independent joints in the order of names."""
        B, b = self.fold(list(names))
        x, v = self._configuration(B @ q + b), B @ qd
        D = pinocchio.crba(self.model, self.data, x)
        D = np.triu(D) + np.triu(D, 1).T
        C = pinocchio.computeCoriolisMatrix(self.model, self.data, x, v).copy()
        G = pinocchio.computeGeneralizedGravity(self.model, self.data, x)
        return B.T @ D @ B, B.T @ C @ B, B.T @ G

    def inverse_dynamics(self, names, q, qd, qdd):
        """Return the efforts of a motion by recursive Newton-Euler, shape (n,)."""
        B, b = self.fold(list(names))
        x = self._configuration(B @ q + b)
        return B.T @ pinocchio.rnea(self.model, self.data, x, B @ qd, B @ qdd)

    def regressor(self, names, moving_names, q, qd, qdd):
        """Return the joint torque regressor, shape (n, 10 N), columns as ours per moving joint."""
        B, b = self.fold(list(names))
        x = self._configuration(B @ q + b)
        Y = pinocchio.computeJointTorqueRegressor(self.model, self.data, x, B @ qd, B @ qdd)
        blocks = []
        for name in moving_names:
            first = 10 * (self.model.getJointId(name) - 1)
            m, hx, hy, hz, Ixx, Ixy, Iyy, Ixz, Iyz, Izz = Y[:, first : first + 10].T
            # I = tr(Sigma) 1 - Sigma
            sigma = Iyy + Izz, -Ixy, -Ixz, Ixx + Izz, -Iyz, Ixx + Iyy
            blocks += [m, hx, hy, hz, *sigma]
        return B.T @ np.column_stack(blocks)

    def forward_dynamics(self, names, q, qd, tau):
        """Return the accelerations of efforts, shape (n,): by articulated bodies."""
        B, b = self.fold(list(names))
        x = self._configuration(B @ q + b)
        if len(B) > len(names):  # Mimic joints: solved here, from Pinocchio's matrix and bias.
            D, _, _ = self.dynamics(names, q, qd)
            bias = pinocchio.nonLinearEffects(self.model, self.data, x, B @ qd)
            return np.linalg.solve(D, tau - B.T @ bias)
        return B.T @ pinocchio.aba(self.model, self.data, x, B @ qd, B @ tau)

    def energies(self, names, q, qd):
        """Return kinetic and potential energy, J."""
        B, b = self.fold(list(names))
        x = self._configuration(B @ q + b)
        return (
            pinocchio.computeKineticEnergy(self.model, self.data, x, B @ qd),
            pinocchio.computePotentialEnergy(self.model, self.data, x),
        )

    def _configuration(self, positions):
        x = pinocchio.neutral(self.model)
        for joint in list(self.model.joints)[1:]:
            position = positions[joint.idx_v]
            if joint.nq == 2:  # Pinocchio keeps a continuous joint as cosine and sine
                x[joint.idx_q : joint.idx_q + 2] = np.cos(position), np.sin(position)
            else:
                x[joint.idx_q] = position
        return x
