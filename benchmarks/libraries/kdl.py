"""PyKDL: a chain of segments, its solvers and containers made once."""

import numpy as np
import PyKDL

from ..quantities import Call

NAME = 'PyKDL'
PACKAGE = 'PyKDL'
VERSION = PyKDL.__version__
NOTE = (
    'It has no C: beside D it gives the vectors C q̇ and G. Its own containers are filled '
    'before the clock starts; reading results back as arrays is not counted. Its Python '
    'bindings have no forward dynamics.'
)

# Its solvers refer to a chain that they do not keep alive.
_CHAINS: list = []


def chain_of(robot):
    """
    Return KDL's chain of a robot that does not branch.

    Parameters
    ----------
    robot : Robot

    Returns
    -------
    PyKDL.Chain

    Raises
    ------
    ValueError
        If the robot branches.

    """
    tree = robot.model.tree
    if not np.array_equal(tree.parent, np.arange(robot.n) - 1):
        raise ValueError(f'expected a chain, got the parents {tree.parent.tolist()}')
    chain = PyKDL.Chain()
    for k in range(robot.n):
        frame = _frame(tree.joint_placement[k])
        axis = frame.M * PyKDL.Vector(*tree.axis[k])
        joint = PyKDL.Joint(tree.moving_joint_names[k], frame.p, axis, PyKDL.Joint.RotAxis)
        chain.addSegment(PyKDL.Segment(joint, frame, _inertia(tree.inertia[k])))
    _CHAINS.append(chain)
    return chain


def calls(robot):
    """
    Return KDL's calls.

    Parameters
    ----------
    robot : Robot

    Returns
    -------
    dict of str to Call

    """
    chain = chain_of(robot)
    gravity_vector = PyKDL.Vector(*robot.model.gravity)
    solver = PyKDL.ChainDynParam(chain, gravity_vector)
    newton_euler = PyKDL.ChainIdSolver_RNE(chain, gravity_vector)
    D, bias, G, tau = (
        PyKDL.JntSpaceInertiaMatrix(robot.n),
        *(PyKDL.JntArray(robot.n) for _ in range(3)),
    )
    no_wrenches = [PyKDL.Wrench.Zero() for _ in range(robot.n)]

    def dynamics(q, qd):
        solver.JntToMass(q, D)
        solver.JntToCoriolis(q, qd, bias)
        solver.JntToGravity(q, G)
        return D, bias, G

    def mass_matrix(q):
        solver.JntToMass(q, D)
        return (D,)

    def gravity(q):
        solver.JntToGravity(q, G)
        return (G,)

    def inverse(q, qd, qdd):
        newton_euler.CartToJnt(q, qd, qdd, no_wrenches, tau)
        return (tau,)

    ways = {'argument': _joint_array, 'array': _numpy_array}
    return {
        'dynamics': Call(
            dynamics, ('D', 'C qd', 'G'), 'JntToMass, JntToCoriolis, JntToGravity', **ways
        ),
        'mass_matrix': Call(mass_matrix, ('D',), 'JntToMass', **ways),
        'gravity': Call(gravity, ('G',), 'JntToGravity', **ways),
        'inverse': Call(inverse, ('tau',), 'ChainIdSolver_RNE.CartToJnt', **ways),
    }


def _frame(matrix):
    rotation = PyKDL.Rotation(*matrix[:3, :3].ravel())
    return PyKDL.Frame(rotation, PyKDL.Vector(*matrix[:3, 3]))


def _inertia(J):
    # KDL wants the tensor about the center of mass, equations (3) and (4) backwards.
    mass = J[3, 3]
    com = J[:3, 3] / mass
    planes = J[:3, :3] - mass * np.outer(com, com)
    tensor = np.trace(planes) * np.eye(3) - planes
    entries = [tensor[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
    return PyKDL.RigidBodyInertia(mass, PyKDL.Vector(*com), PyKDL.RotationalInertia(*entries))


def _joint_array(values):
    array = PyKDL.JntArray(len(values))
    for k, value in enumerate(values):
        array[k] = value
    return array


def _numpy_array(value):
    if isinstance(value, PyKDL.JntArray):
        return np.array([value[k] for k in range(value.rows())])
    return np.array([[value[i, j] for j in range(value.columns())] for i in range(value.rows())])
