"""An arm that swings without efforts, integrated with `forward_dynamics`."""

from functools import cache
from typing import NamedTuple

from dynamics_node import RobotModel
import numpy as np
from scipy.integrate import solve_ivp

from .comparison import all_scales, relative_error
from .mujoco_oracle import MujocoOracle
from .robots import ARM7, public_robot

SECONDS = 3.0
SAMPLES = 100

# Tolerance of the integrator, relative to position and speed of each joint.
TOLERANCE = 1e-12

ARMS = {
    'arm7': ARM7,
    'Panda': public_robot('panda_description/urdf/panda.urdf'),
    'UR5': public_robot('ur_description/urdf/ur5_robot.urdf'),
    'Kinova': public_robot('kinova_description/robots/kinova.urdf'),
}


def free_arm(name):
    """
    Return one of ARMS as URDF text.

    Its fingers are fixed: without limits they would slide away, and their energy would dominate.

    """
    return ARMS[name].read_text().replace('type="prismatic"', 'type="fixed"')


class Swing(NamedTuple):
    """
    The errors of a swing of SECONDS.

    `drift` is the largest change of the total energy divided by the largest kinetic energy,
    `kinetic` [J]; `mujoco` the largest error of the acceleration against MuJoCo's at SAMPLES
    states on the way; `evaluations` the number of calls of forward dynamics.

    """

    drift: float
    kinetic: float
    mujoco: float
    evaluations: int


@cache
def swing(name):
    """Simulate one of ARMS and return its Swing."""
    text = free_arm(name)
    model = RobotModel.from_urdf(text)
    start = starting_position(model)
    solution = integrate(model.forward_dynamics, start)
    n = start.size
    kinetic, drift = energy_drift(model, solution)
    judge = MujocoOracle(text)
    errors = []
    for x in solution.y.T:
        q, qd, tau = x[:n], x[n:], np.zeros(n)
        expected = judge.forward_dynamics(model.joint_names, q, qd, tau)
        scale = all_scales(model, model.mass_matrix(q), qd, expected).FD
        errors.append(relative_error(model.forward_dynamics(q, qd, tau), expected, scale))
    return Swing(drift, kinetic, max(errors), solution.nfev)


def starting_position(model):
    """Return the position from which an arm falls, shape (n,)."""
    return np.random.default_rng(1).uniform(-1.0, 1.0, len(model.joint_names))


def integrate(forward_dynamics, start, tolerance=TOLERANCE, speeds=None):
    """Integrate a motion without efforts, from rest or from given speeds; y has SAMPLES states."""
    n = start.size
    tau = np.zeros(n)
    state = np.concatenate([start, np.zeros(n) if speeds is None else speeds])

    def derivative(_, x):
        return np.concatenate([x[n:], forward_dynamics(x[:n], x[n:], tau)])

    solution = solve_ivp(
        derivative,
        (0.0, SECONDS),
        state,
        t_eval=np.linspace(0.0, SECONDS, SAMPLES + 1)[1:],
        method='DOP853',
        rtol=tolerance,
        atol=tolerance,
    )
    if not solution.success:
        raise RuntimeError(f'the integration stopped: {solution.message}')
    return solution


def energy_drift(model, solution):
    """Return the largest kinetic energy, J, and the largest change of the sum relative to it."""
    n = len(model.joint_names)
    q, qd = solution.y[:n].T, solution.y[n:].T
    kinetic = model.kinetic_energy(q, qd)
    total = kinetic + model.potential_energy(q)
    largest = float(kinetic.max())
    return largest, float(np.abs(total - total[0]).max()) / largest
