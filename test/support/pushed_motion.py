"""A driven and pushed robot with friction, by MuJoCo and scipy's integrator."""

from typing import NamedTuple

import mujoco
import numpy as np
from scipy.integrate import solve_ivp

from .mujoco_oracle import MujocoOracle

# Tolerance of the integrator: the remaining error is that of the observer.
TOLERANCE = 1e-9
# Rate at which the drive returns a joint to its reference, 1/s: low, so that a push moves it.
STIFFNESS = 5.0


class Motion(NamedTuple):
    """
    Measurements, and the true external efforts.

    `time` (k,) [s]; `q`, `qd`, `effort` of the motors, `external` efforts, and `lagged`, those
    behind a first-order lag: (k, n) each.

    """

    time: np.ndarray
    q: np.ndarray
    qd: np.ndarray
    effort: np.ndarray
    external: np.ndarray
    lagged: np.ndarray


class PushedRobot:
    """A robot on a reference motion of one swing per second, by MuJoCo."""

    def __init__(self, text, names, friction, seed=0, amplitude=0.5):
        """
        Read URDF text; `names` are its n independent joints.

        `friction` are a viscous coefficient [N m s/rad or N s/m], a dry effort [N m or N] and
        the speed [rad/s or m/s] that smooths it; each the same for all joints.

        """
        rng = np.random.default_rng(seed)
        self.oracle, self.names = MujocoOracle(text), names
        self.n = len(names)
        self._friction = friction
        self.start = rng.uniform(-1.0, 1.0, self.n)
        self._amplitude, self._phase = amplitude, rng.uniform(0.0, 2 * np.pi, self.n)
        self._fold, self._offset = self.oracle.fold(names)

    def friction(self, qd):
        """Return the friction, shape (n,)."""
        viscous, dry, smoothing = self._friction
        return viscous * qd + dry * np.tanh(qd / smoothing)

    def motor(self, t, q, qd):
        """Return the efforts of the motors, shape (n,)."""
        w, phase = 2 * np.pi, 2 * np.pi * t + self._phase
        wanted = self._amplitude * np.array(
            [np.sin(phase), w * np.cos(phase), -w * w * np.sin(phase)]
        )
        qdd = (
            wanted[2]
            + 2 * STIFFNESS * (wanted[1] - qd)
            + STIFFNESS**2 * (self.start + wanted[0] - q)
        )
        return self.oracle.inverse_dynamics(self.names, q, qd, qdd) + self.friction(qd)

    def wrench_on_tip(self, q, wrench):
        """Return the joint efforts of a force [N] and a moment [N m] at the tip, shape (n,)."""
        model, data = self.oracle.model, self.oracle.data
        data.qpos[:] = self._fold @ q + self._offset
        mujoco.mj_fwdPosition(model, data)
        jacobian = np.zeros((6, model.nv))
        mujoco.mj_jacBodyCom(model, data, jacobian[:3], jacobian[3:], tip(model))
        return self._fold.T @ (jacobian.T @ wrench)

    def run(self, times, external, gain, begins=0.0):
        """
        Return the Motion at increasing times, the first of them 0.

        `external(t, q)` are efforts (n,) from the time `begins` on, which must be one of times.

        """
        n = self.n
        w, phase = 2 * np.pi, self._phase
        state = np.concatenate(
            [
                self.start + self._amplitude * np.sin(phase),
                self._amplitude * w * np.cos(phase),
                np.zeros(n),
            ]
        )
        rows = [state]
        for part, is_pushed in ((times[times <= begins], False), (times[times >= begins], True)):
            if len(part) < 2:
                continue

            def derivative(t, x, is_pushed=is_pushed):
                q, qd, r = x[:n], x[n : 2 * n], x[2 * n :]
                outside = external(t, q) if is_pushed else np.zeros(n)
                effort = self.motor(t, q, qd) - self.friction(qd) + outside
                qdd = self.oracle.forward_dynamics(self.names, q, qd, effort)
                return np.concatenate([qd, qdd, gain * (outside - r)])

            solution = solve_ivp(
                derivative,
                part[[0, -1]],
                rows[-1],
                t_eval=part[1:],
                method='DOP853',
                rtol=TOLERANCE,
                atol=TOLERANCE,
            )
            if not solution.success:
                raise RuntimeError(f'the integration stopped: {solution.message}')
            rows.extend(solution.y.T)
        q, qd, lagged = np.split(np.array(rows), 3, axis=1)
        effort = np.array([self.motor(*row) for row in zip(times, q, qd, strict=True)])
        outside = np.array(
            [external(t, p) if t >= begins else np.zeros(n) for t, p in zip(times, q, strict=True)]
        )
        return Motion(times, q, qd, effort, outside, lagged)


def tip(model):
    """Return the body of a MuJoCo model with the most joints before it."""
    depth = [0] * model.nbody
    for body in range(1, model.nbody):  # parents come before their children
        depth[body] = depth[model.body_parentid[body]] + model.body_dofnum[body]
    return int(np.argmax(depth))


def halved(times):
    """Return times with the middles of all steps added."""
    return np.sort(np.concatenate([times, 0.5 * (times[1:] + times[:-1])]))


def irregular_times(rng, seconds, mean_step, through=()):
    """Return times from 0 at steps of 0.2 to 1.8 times the mean, and those of `through`."""
    steps = mean_step * rng.uniform(0.2, 1.8, int(2 * seconds / mean_step))
    times = np.concatenate([[0.0], np.cumsum(steps)])
    return np.unique(np.concatenate([times[times < seconds], [seconds], through]))
