"""
MuJoCo as an independent judge, with its own reading of the URDF.

MuJoCo refuses some published robots: moving links without mass, and inertia that no real body
has. The judge takes such a link's inertia out of the text that MuJoCo reads and writes it into
the compiled model, where the arithmetic takes it as it is; joints and frames stay MuJoCo's own.

"""

import logging
import re
from xml.etree import ElementTree

import mujoco
import numpy as np

from .mimic import mimic_chains

# MuJoCo's own handler writes a file into the current folder.
mujoco.set_mju_user_warning(logging.getLogger('mujoco').debug)

# A body that MuJoCo accepts, turned and away from the origin: for one in the middle of its
# frame MuJoCo takes short cuts that would not see what is written into it later.
_PLACEHOLDER = (
    '<inertial><origin xyz="0.1 0.2 0.3" rpy="0.1 0.2 0.3"/><mass value="1"/><inertia '
    'ixx="0.3" ixy="0" ixz="0" iyy="0.4" iyz="0" izz="0.5"/></inertial>'
)


class MujocoOracle:
    """D, C, G, inverse and forward dynamics and the energies of a URDF by MuJoCo."""

    def __init__(self, text, gravity=(0.0, 0.0, -9.81)):
        """Read URDF text; every joint, also a mimic one, becomes a joint of its own."""
        robot = ElementTree.fromstring(text.encode())
        self._mimic = mimic_chains(robot)
        _strip(robot)
        self.model, self.replaced = _compile(robot)
        self.model.opt.gravity[:] = gravity
        # Only the rigid bodies: without limits and <dynamics>, which are stripped, and contacts.
        self.model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
        self.data = mujoco.MjData(self.model)
        # What the base carries has potential energy in MuJoCo too, but no joint moves it.
        self._static = np.flatnonzero(self.model.body_weldid == 0)

    def fold(self, names):
        """Return B (nv, n) and b (nv,) with v = B qd and the joints at B q + b."""
        B, b = np.zeros((self.model.nv, len(names))), np.zeros(self.model.nv)
        for row in range(self.model.nv):
            name = self.model.joint(row).name
            leader, multiplier, b[row] = self._mimic.get(name, (name, 1.0, 0.0))
            B[row, list(names).index(leader)] = multiplier
        return B, b

    def dynamics(self, names, q, qd):
        """
        Return D, C and G for the independent joints in the order of names.

        MuJoCo has no C. But its bias at rest is G, and c(v) = bias(v) - G is quadratic in the
        speeds, so the Christoffel matrix is its polar form: C(q, q̇) e_j = ½ (c(q̇ + e_j) -
        c(q̇) - c(e_j)). The steps e_j are of the size of the speeds, which loses least. A joint
        that moves no mass has no column: the difference would be nothing but rounding.

        """
        B, b = self.fold(names)
        self._pose(B @ q + b)
        D = self._mass_matrix()
        G = self._bias(0 * (B @ qd))
        c = self._bias(B @ qd) - G
        step = np.abs(qd).max(initial=0.0)
        C = np.zeros((self.model.nv, len(names)))
        for j in np.flatnonzero(np.diag(B.T @ D @ B)):
            e = step * B[:, j]
            C[:, j] = (self._bias(B @ qd + e) - c - self._bias(e)) / (2 * step)
        return B.T @ D @ B, B.T @ C, B.T @ G

    def inverse_dynamics(self, names, q, qd, qdd):
        """Return the efforts of a motion, shape (n,)."""
        B, b = self.fold(names)
        self.data.qpos[:], self.data.qvel[:] = B @ q + b, B @ qd
        self.data.qacc[:] = B @ qdd
        mujoco.mj_inverse(self.model, self.data)
        return B.T @ self.data.qfrc_inverse

    def forward_dynamics(self, names, q, qd, tau):
        """Return the accelerations of efforts, shape (n,)."""
        B, b = self.fold(names)
        if len(B) > len(names):  # Mimic joints: solved here, from MuJoCo's matrix and bias.
            D, _, _ = self.dynamics(names, q, qd)
            return np.linalg.solve(D, tau - B.T @ self._bias(B @ qd))
        self.data.qpos[:], self.data.qvel[:] = B @ q + b, B @ qd
        self.data.qfrc_applied[:] = B @ tau
        mujoco.mj_forward(self.model, self.data)
        return B.T @ self.data.qacc

    def energies(self, names, q, qd):
        """Return kinetic and potential energy, J."""
        B, b = self.fold(names)
        self._pose(B @ q + b)
        self.data.qvel[:] = B @ qd
        mujoco.mj_energyPos(self.model, self.data)
        mujoco.mj_energyVel(self.model, self.data)
        static = -(
            self.model.body_mass[self._static]
            @ self.data.xipos[self._static]
            @ self.model.opt.gravity
        )
        return self.data.energy[1], self.data.energy[0] - static

    def _pose(self, positions):
        self.data.qpos[:] = positions
        self.data.qvel[:] = 0.0
        mujoco.mj_fwdPosition(self.model, self.data)

    def _mass_matrix(self):
        D = np.zeros((self.model.nv, self.model.nv))
        for row, unit in zip(D, np.eye(self.model.nv), strict=True):
            mujoco.mj_mulM(self.model, self.data, row, unit)
        return D

    def _bias(self, speeds):
        # At the position of the last _pose.
        self.data.qvel[:] = speeds
        mujoco.mj_comVel(self.model, self.data)
        result = np.zeros(self.model.nv)
        mujoco.mj_rne(self.model, self.data, 0, result)
        return result


def _strip(robot):
    # A link of this name is MuJoCo's own world, wherever the URDF has it.
    for element in robot.iter():
        for key in ('name', 'link'):
            if element.tag in ('link', 'parent', 'child') and element.get(key) == 'world':
                element.set(key, 'link_named_world')
    for element in list(robot):
        if element.tag not in ('link', 'joint'):
            robot.remove(element)
            continue
        for part in list(element):
            if part.tag in (
                'visual',
                'collision',
                'mimic',
                'dynamics',
                'safety_controller',
                'limit',
            ):
                element.remove(part)
        if element.get('type') == 'revolute':
            element.set('type', 'continuous')  # a revolute joint without its limits
    compiler = ElementTree.SubElement(ElementTree.SubElement(robot, 'mujoco'), 'compiler')
    # Each link stays a body of its own, so that what is written into one is that link's.
    compiler.attrib.update(fusestatic='false', inertiafromgeom='false', discardvisual='false')


def _compile(robot):
    # MuJoCo names one link at a time that it refuses.
    inertials = {}
    links = {link.get('name'): link for link in robot.findall('link')}
    while True:
        try:
            model = mujoco.MjModel.from_xml_string(ElementTree.tostring(robot, 'unicode'))
            break
        except ValueError as error:
            refused = re.search(r"Element name '(.*?)', id", str(error))
            if refused is None or refused[1] in inertials or refused[1] not in links:
                raise
        link = links[refused[1]]
        inertials[refused[1]] = link.find('inertial')
        if inertials[refused[1]] is not None:
            link.remove(inertials[refused[1]])
        link.append(ElementTree.fromstring(_PLACEHOLDER))
    for name, inertial in inertials.items():
        _write(model, model.body(name).id, inertial)
    # Sums over subtrees follow from what was written.
    if inertials:
        mujoco.mj_setConst(model, mujoco.MjData(model))
    return model, tuple(inertials)


def _write(model, body, inertial):
    mass, position, axes, moments = 0.0, np.zeros(3), np.eye(3), np.zeros(3)
    if inertial is not None:
        mass = float(inertial.find('mass').get('value'))
        get = inertial.find('inertia').get
        entry = [float(get(key)) for key in ('ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz')]
        moments, axes = np.linalg.eigh(
            np.array([entry[:3], [entry[1], entry[3], entry[4]], [entry[2], entry[4], entry[5]]])
        )
        axes = axes * np.linalg.det(axes)
        origin = inertial.find('origin')
        xyz, rpy = (
            np.array(
                (origin.get(key, '0 0 0') if origin is not None else '0 0 0').split(), dtype=float
            )
            for key in ('xyz', 'rpy')
        )
        position, axes = xyz, _rotation(rpy) @ axes
    model.body_mass[body], model.body_ipos[body] = mass, position
    model.body_inertia[body] = moments
    mujoco.mju_mat2Quat(model.body_iquat[body], axes.ravel())


def _rotation(rpy):
    quaternion, result = np.zeros(4), np.zeros(9)
    mujoco.mju_euler2Quat(quaternion, rpy, 'XYZ')
    mujoco.mju_quat2Mat(result, quaternion)
    return result.reshape(3, 3)
