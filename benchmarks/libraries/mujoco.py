"""MuJoCo: only the stages that a quantity needs, into preallocated arrays."""

from xml.etree import ElementTree

import mujoco
import numpy as np

from ..quantities import Call

NAME = 'MuJoCo'
PACKAGE = 'mujoco'
NOTE = (
    'It has no C: beside D it gives the bias C q̇ + G. Only the stages that a quantity needs '
    'are called, not the whole mj_forward or mj_inverse. Setting the state is included.'
)


def model_of(robot):
    """
    Return MuJoCo's model of a robot.

    Parameters
    ----------
    robot : Robot

    Returns
    -------
    mujoco.MjModel

    Raises
    ------
    ValueError
        If its order of joints differs.

    """
    root = ElementTree.fromstring(robot.text)
    extension = ElementTree.SubElement(root, 'mujoco')
    ElementTree.SubElement(extension, 'compiler', fusestatic='true')
    model = mujoco.MjModel.from_xml_string(ElementTree.tostring(root, encoding='unicode'))
    names = tuple(model.joint(k).name for k in range(model.njnt))
    robot.check_joint_order(names)
    return model


def calls(robot):
    """
    Return MuJoCo's calls.

    Parameters
    ----------
    robot : Robot

    Returns
    -------
    dict of str to Call

    """
    model = model_of(robot)
    data, at_rest = mujoco.MjData(model), mujoco.MjData(model)
    position, velocity, acceleration = data.qpos, data.qvel, data.qacc
    position_at_rest = at_rest.qpos
    D = np.empty((model.nv, model.nv))
    bias, G, tau_out = np.empty(model.nv), np.empty(model.nv), np.empty(model.nv)
    right, qdd_out = np.empty((1, model.nv)), np.empty((1, model.nv))
    kinematics, com_position = mujoco.mj_kinematics, mujoco.mj_comPos
    com_velocity, make_inertia, full = mujoco.mj_comVel, mujoco.mj_makeM, mujoco.mj_fullM
    rne, factor, solve = mujoco.mj_rne, mujoco.mj_factorM, mujoco.mj_solveM

    def dynamics(q, qd):
        position[:] = q
        velocity[:] = qd
        kinematics(model, data)
        com_position(model, data)
        make_inertia(model, data)
        full(model, data, D)
        com_velocity(model, data)
        rne(model, data, 0, bias)
        return D, bias

    def mass_matrix(q):
        position[:] = q
        kinematics(model, data)
        com_position(model, data)
        make_inertia(model, data)
        full(model, data, D)
        return (D,)

    def gravity(q):
        # In a data of its own, where every velocity stays zero.
        position_at_rest[:] = q
        kinematics(model, at_rest)
        com_position(model, at_rest)
        rne(model, at_rest, 0, G)
        return (G,)

    def inverse(q, qd, qdd):
        position[:] = q
        velocity[:] = qd
        acceleration[:] = qdd
        kinematics(model, data)
        com_position(model, data)
        com_velocity(model, data)
        rne(model, data, 1, tau_out)
        return (tau_out,)

    def forward(q, qd, tau):
        position[:] = q
        velocity[:] = qd
        kinematics(model, data)
        com_position(model, data)
        make_inertia(model, data)
        factor(model, data)
        com_velocity(model, data)
        rne(model, data, 0, bias)
        np.subtract(tau, bias, out=right[0])
        solve(model, data, qdd_out, right)
        return (qdd_out[0],)

    stages = 'mj_kinematics, mj_comPos'
    return {
        'dynamics': Call(
            dynamics, ('D', 'C qd + G'), f'{stages}, mj_makeM, mj_fullM, mj_comVel, mj_rne'
        ),
        'mass_matrix': Call(mass_matrix, ('D',), f'{stages}, mj_makeM, mj_fullM'),
        'gravity': Call(gravity, ('G',), f'{stages}, mj_rne at rest'),
        'inverse': Call(inverse, ('tau',), f'{stages}, mj_comVel, mj_rne'),
        'forward': Call(
            forward, ('qdd',), f'{stages}, mj_makeM, mj_factorM, mj_comVel, mj_rne, mj_solveM'
        ),
    }
