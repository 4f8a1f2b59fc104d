"""Pinocchio as an independent judge, with its own reading of the URDF and of mimic joints."""

from xml.etree import ElementTree

import numpy as np
import pinocchio


class PinocchioOracle:
    """D, C, G and the energies of a URDF by Pinocchio, in any order of the joints."""

    def __init__(self, text, gravity=(0.0, 0.0, -9.81)):
        """Read URDF text; every joint, also a mimic one, becomes a joint of its own."""
        self.model = pinocchio.buildModelFromXML(text)
        self.model.gravity.linear = np.array(gravity)
        self.data = self.model.createData()
        self._mimic = _mimic_chains(text)

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

    def energies(self, names, q, qd):
        """Return kinetic and potential energy, J."""
        B, b = self.fold(list(names))
        x = self._configuration(B @ q + b)
        return (pinocchio.computeKineticEnergy(self.model, self.data, x, B @ qd),
                pinocchio.computePotentialEnergy(self.model, self.data, x))

    def _configuration(self, positions):
        x = pinocchio.neutral(self.model)
        for joint in list(self.model.joints)[1:]:
            position = positions[joint.idx_v]
            if joint.nq == 2:  # Pinocchio keeps a continuous joint as cosine and sine
                x[joint.idx_q:joint.idx_q + 2] = np.cos(position), np.sin(position)
            else:
                x[joint.idx_q] = position
        return x


def _mimic_chains(text):
    mimic = {}
    for joint in ElementTree.fromstring(text).findall('joint'):
        element = joint.find('mimic')
        if element is not None:
            mimic[joint.get('name')] = (element.get('joint'),
                                        float(element.get('multiplier', 1.0)),
                                        float(element.get('offset', 0.0)))
    chains = {}
    for name in mimic:
        leader, multiplier, offset = mimic[name]
        while leader in mimic:
            leader, m, o = mimic[leader]
            offset += multiplier * o
            multiplier *= m
        chains[name] = (leader, multiplier, offset)
    return chains
