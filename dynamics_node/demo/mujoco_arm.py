"""
The physics of the simulated robot: MuJoCo, from joint efforts to joint states. No ROS.

Independent of the node that it is used to judge: another URDF reader, other dynamics.

"""

from collections.abc import Callable, Sequence

import mujoco
import numpy as np

from .mujoco_model import compile_model, last_link, mimic_map, TIME_STEP
from .robot_text import movable_joints, MovableJoint

# Of the velocity limit: a glide must not trip a watchdog on the joint states.
GLIDE_SPEED = 0.7
FALLBACK_VELOCITY = 1.0  # [rad/s or m/s] for a joint without velocity limit
MIN_GLIDE_TIME = 0.2  # [s]
UNSTABLE = (
    mujoco.mjtWarning.mjWARN_BADQPOS,
    mujoco.mjtWarning.mjWARN_BADQVEL,
    mujoco.mjtWarning.mjWARN_BADQACC,
)


class UnstableError(RuntimeError):
    """The simulation has become unstable."""


class MujocoArm:
    """
    A robot in MuJoCo with brakes.

    Arrays named `driven` hold one value per joint without a mimic tag, all others one per movable
    joint; both in the order of the URDF, in rad or m, per s, and N m or N.

    """

    def __init__(
        self, urdf_text: str, extend: Callable[[mujoco.MjSpec], None] | None = None
    ) -> None:
        """
        Build the robot, at its neutral position with the brakes engaged.

        Parameters
        ----------
        urdf_text : str
        extend : callable, optional
            Adds to the MuJoCo model before it is compiled.

        Raises
        ------
        RobotRefusedError
            If the robot cannot be simulated.

        """
        self.joints = movable_joints(urdf_text)
        self.driven = [joint for joint in self.joints if joint.mimic is None]
        self.mimic_matrix, self.mimic_offset = mimic_map(self.joints)
        self.model = compile_model(urdf_text, self.joints, extend)
        self.data = mujoco.MjData(self.model)
        self.braked = True
        self.last_link = last_link(self.model)
        ids = [self.model.joint(joint.name).id for joint in self.joints]
        self._qpos, self._dof = self.model.jnt_qposadr[ids], self.model.jnt_dofadr[ids]
        self._driven_rows = [i for i, joint in enumerate(self.joints) if joint.mimic is None]
        self._scratch = mujoco.MjData(self.model)
        self._glide: Glide | None = None
        self._push_ends = 0.0
        self._push_force = np.zeros(3)
        self.place(np.zeros(len(self.driven)))

    @property
    def names(self) -> list[str]:
        """Return the names of all movable joints."""
        return [joint.name for joint in self.joints]

    @property
    def driven_names(self) -> list[str]:
        """Return the names of the driven joints."""
        return [joint.name for joint in self.driven]

    @property
    def position(self) -> np.ndarray:
        """Return the joint positions, shape (n,) [rad or m]."""
        return self.data.qpos[self._qpos]

    @property
    def velocity(self) -> np.ndarray:
        """Return the joint velocities, shape (n,) [rad/s or m/s]."""
        return self.data.qvel[self._dof]

    @property
    def effort(self) -> np.ndarray:
        """Return the motor efforts, shape (n,) [N m or N]; 0 for a mimic joint."""
        return self.data.qfrc_applied[self._dof]

    @property
    def driven_position(self) -> np.ndarray:
        """Return the positions of the driven joints, shape (n_driven,) [rad or m]."""
        return self.position[self._driven_rows]

    @property
    def gliding(self) -> bool:
        """Return whether a motion of `glide_to` is in progress."""
        return self._glide is not None

    def place(self, driven: np.ndarray) -> None:
        """Set the position, at rest, with the brakes engaged and without efforts."""
        mujoco.mj_resetData(self.model, self.data)
        self.braked, self._glide, self._push_ends = True, None, 0.0
        self._move_to(driven)

    def glide_to(self, driven: np.ndarray) -> float:
        """Engage the brakes, clear the efforts, move to a position; return the duration [s]."""
        self.set_brakes(True)
        self.data.qfrc_applied[:] = 0.0
        self._glide = Glide(self.driven_position, driven, self.driven, self.data.time)
        return self._glide.duration

    def set_brakes(self, engaged: bool) -> None:
        """Engage or release the brakes of all joints; engaged, they stop the arm at once."""
        self.braked = engaged
        if engaged:
            self._end_push()
            self.data.qvel[:] = 0.0
            mujoco.mj_forward(self.model, self.data)

    def set_effort(self, driven: Sequence[float]) -> None:
        """Apply joint efforts, shape (n_driven,) [N m or N], until the next call."""
        self.data.qfrc_applied[self._dof[self._driven_rows]] = driven

    def push(self, force: Sequence[float], duration: float) -> None:
        """Apply a force [N, base frame] at the last link's center of mass for a duration [s]."""
        self._push_force = np.array(force, dtype=float)
        self._push_ends = self.data.time + duration

    def step(self, count: int = 1) -> None:
        """
        Advance by `count` steps of TIME_STEP seconds.

        Raises
        ------
        UnstableError
            If excessive efforts have made the simulation unstable. The arm is then back at its
            previous position, with the brakes engaged.

        """
        before = self.driven_position
        for _ in range(count):
            if self._push_ends:
                # For each step: the viewer overwrites it with the force of the mouse, or zero.
                self.data.xfrc_applied[self.last_link, :3] = self._push_force
            if self.braked:
                self._step_braked()
            else:
                mujoco.mj_step(self.model, self.data)
            if self._push_ends and self.data.time >= self._push_ends:
                self._end_push()
        # MuJoCo would continue from its neutral position without an error.
        if any(self.data.warning[kind].number for kind in UNSTABLE):
            self.place(before)
            raise UnstableError(
                'the efforts were too large for the simulation, which became '
                'unstable; the brakes are engaged'
            )

    def gravity_torque(self, driven: np.ndarray) -> np.ndarray:
        """Return MuJoCo's own gravity torque of the driven joints, (n_driven,) [N m or N]."""
        self._pose(self._scratch, driven)
        return self.mimic_matrix.T @ self._scratch.qfrc_bias[self._dof]

    def mass_matrix(self, driven: np.ndarray) -> np.ndarray:
        """Return MuJoCo's own mass matrix of the driven joints, shape (n_driven, n_driven)."""
        self._pose(self._scratch, driven)
        columns = np.zeros((self.model.nv, len(self.driven)))
        unit = np.zeros((len(self.driven), self.model.nv))
        unit[:, self._dof] = self.mimic_matrix.T
        for column, vector in enumerate(unit):
            product = np.zeros(self.model.nv)
            mujoco.mj_mulM(self.model, self._scratch, product, vector)
            columns[:, column] = product
        return unit @ columns

    def last_link_jacobian(self, driven: np.ndarray) -> np.ndarray:
        """Return d(com of the last link) / d(driven position), shape (3, n_driven)."""
        self._pose(self._scratch, driven)
        jacobian = np.zeros((3, self.model.nv))
        mujoco.mj_jacBodyCom(self.model, self._scratch, jacobian, None, self.last_link)
        return jacobian[:, self._dof] @ self.mimic_matrix

    def skeleton(self, driven: np.ndarray) -> np.ndarray:
        """Return the points of a stick figure from base to last link, shape (k, 3) [m]."""
        self._pose(self._scratch, driven)
        points, body = [self._scratch.xipos[self.last_link].copy()], self.last_link
        while body:
            first = self.model.body_jntadr[body]
            points.append(self._scratch.xanchor[first].copy())
            body = self.model.body_parentid[body]
        return np.array([*points, np.zeros(3)])[::-1]

    def damping(self) -> np.ndarray:
        """Return the viscous damping of all joints, shape (n,) [N m s/rad or N s/m]."""
        return self.model.dof_damping[self._dof]

    def set_damping(self, damping: np.ndarray) -> None:
        """Replace the viscous damping of all joints, shape (n,) [N m s/rad or N s/m]."""
        self.model.dof_damping[self._dof] = damping

    def friction(self) -> np.ndarray:
        """Return the dry friction of all joints, shape (n,) [N m or N]."""
        return self.model.dof_frictionloss[self._dof]

    def _step_braked(self) -> None:
        """Advance the time; move only along a glide."""
        self.data.time += TIME_STEP
        if self._glide is None:
            return
        position, velocity = self._glide.at(self.data.time)
        self._move_to(position)
        self.data.qvel[self._dof] = self.mimic_matrix @ velocity
        if self.data.time >= self._glide.end:
            self._glide = None
            self.set_brakes(True)

    def _move_to(self, driven: np.ndarray) -> None:
        """Set the position, at rest."""
        self._pose(self.data, driven)

    def _pose(self, data: mujoco.MjData, driven: np.ndarray) -> None:
        """Set a position at rest in `data` and compute the quantities that depend on it."""
        data.qpos[self._qpos] = self.mimic_matrix @ driven + self.mimic_offset
        data.qvel[:] = 0.0
        mujoco.mj_forward(self.model, data)

    def _end_push(self) -> None:
        """Remove the external force."""
        self.data.xfrc_applied[self.last_link, :3] = 0.0
        self._push_ends = 0.0


class Glide:
    """
    A smooth motion between two positions: half a cosine wave, at rest at both ends.

    Its peak velocity is pi/2 * distance / duration.

    """

    def __init__(
        self, start: np.ndarray, goal: np.ndarray, joints: list[MovableJoint], now: float
    ) -> None:
        """Plan from `start` to `goal` [rad or m] within the velocity limits, from `now` [s]."""
        limits = np.array([joint.velocity or FALLBACK_VELOCITY for joint in joints])
        slowest = np.max(np.pi / 2 * np.abs(goal - start) / (GLIDE_SPEED * limits))
        self.duration = max(float(slowest), MIN_GLIDE_TIME)
        self.end = now + self.duration
        self._start, self._way = start, goal - start

    def at(self, now: float) -> tuple[np.ndarray, np.ndarray]:
        """Return position and velocity at a time [s]; the goal at rest from the end on."""
        phase = np.pi * min(max(1 - (self.end - now) / self.duration, 0.0), 1.0)
        position = self._start + self._way * (1 - np.cos(phase)) / 2
        return position, self._way * np.sin(phase) * np.pi / (2 * self.duration)
