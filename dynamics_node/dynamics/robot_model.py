"""`RobotModel`: the dynamics of one robot, for one state or many."""

from __future__ import annotations

import inspect
import os
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .arguments import check_link, gravity_vector, per_joint
from .batch import DynamicsTerms, Evaluation, SHAPES
from .effort_limits import max_payload, MaxPayload
from .friction import Friction, make_friction, SMOOTHING_VELOCITY
from .payload import loaded_inertia, make_payload, Payload
from .trajectory import complete_trajectory
from ..codegen import RobotCode, Specialization
from ..errors import ArgumentError
from ..kernels.packing import pack, ten_numbers
from ..model import build_tree
from ..model.tree import KinematicTree
from ..urdf import read_urdf

# m/s²
STANDARD_GRAVITY = (0.0, 0.0, -9.81)

Array = NDArray[np.float64]


class RobotModel:
    """
    A robot with a fixed base: D(q) q̈ + C(q, q̇) q̇ + G(q) = τ.

    A model is immutable: `with_gravity`, `with_payload` and the like return a new model at little
    cost. Friction is not part of the equation above; `friction_torque` returns it. Every method
    takes arrays with leading batch axes and is thread-safe. NaN in an argument gives NaN in all
    results that depend on it.

    Large batches are computed by one thread per available processor, or by `threads`.

    A robot in frequent use gets machine code of its own, compiled by another process and kept on
    disk; until it is ready, and for large robots, a general kernel answers. The two agree to
    rounding. See `specialize`.

    Units are rad, rad/s, N m for revolute joints and m, m/s, N for prismatic joints. The base
    frame is the root link's frame.

    """

    def __init__(
        self,
        tree: KinematicTree,
        gravity: ArrayLike = STANDARD_GRAVITY,
        *,
        payload: Payload | None = None,
        rotor_inertia: ArrayLike = 0.0,
        friction: Friction | None = None,
        compile: bool = True,
        specialization: Specialization | None = None,
    ):
        """
        Make the model of a kinematic tree; `from_urdf` is the usual way.

        Parameters
        ----------
        tree : KinematicTree
        gravity : array_like, shape (3,)
            Gravity acceleration in the base frame, m/s², points down.
        payload : Payload, optional
            See `with_payload`.
        rotor_inertia : array_like, shape (n,), or float
            See `with_rotor_inertia`.
        friction : Friction, optional
            See `with_friction`; by default that of the tree.
        compile : bool
            False: never use machine code of this robot's own, neither from disk nor compiled.
            For a short-lived model, loading takes longer than it saves; and the general kernel
            gives the same digits whether or not there is code on disk. It holds for models derived
            from this one (`with_payload` and the like) too.
        specialization : Specialization, optional
            Of another model of the same tree; it decides in place of `compile`.

        Raises
        ------
        ArgumentError
            If gravity is not three finite numbers, or a rotor inertia is negative.

        """
        self._tree = tree
        self._gravity = gravity_vector(gravity)
        self._n = len(tree.joint_names)
        self._payload = payload
        self._rotor_inertia = per_joint('rotor_inertia', tree.joint_names, rotor_inertia)
        self._friction = friction or make_friction(
            tree.joint_names, tree.friction[:, 0], tree.friction[:, 1], SMOOTHING_VELOCITY
        )
        self._inertia = loaded_inertia(tree, payload)
        packed = pack(tree, self._gravity, self._inertia, self._rotor_inertia)
        if specialization is None:
            # Usually the first model has no payload, and its numbers are those of the bare robot.
            own = pack(tree, self._gravity) if packed.payload_variant else packed
            specialization = Specialization(own, compile)
        self._specialization = specialization
        if packed.payload_variant and specialization.payload_variant is not None:
            specialization = specialization.payload_variant
        self._evaluation = Evaluation(packed, tree.joint_names, specialization)
        specialization.attach(self, _install)

    @classmethod
    def from_urdf(
        cls,
        source: str | bytes | os.PathLike[str],
        gravity: ArrayLike = STANDARD_GRAVITY,
        *,
        compile: bool = True,
    ) -> RobotModel:
        """
        Make the model of a URDF.

        Parameters
        ----------
        source : str, bytes or os.PathLike
            A path or the URDF text. Meshes are never opened.
        gravity : array_like, shape (3,)
            Gravity acceleration in the root link's frame, m/s², points down.
        compile : bool
            False: never use machine code of this robot's own.

        Returns
        -------
        RobotModel

        Raises
        ------
        RobotDescriptionError
            If the URDF is unusable; lists every problem.
        ArgumentError
            If gravity is not three finite numbers.

        """
        return cls(build_tree(read_urdf(source)), gravity, compile=compile)

    def __getstate__(self) -> dict[str, Any]:
        # Without machine code: its addresses are meaningless in another process.
        return {name: value for name, value in vars(self).items() if not inspect.isbuiltin(value)}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        self._evaluation.specialization.attach(self, _install)

    def __repr__(self) -> str:
        return (
            f'RobotModel({self._n} joints, {self.moving_mass:.6g} kg moving, '
            f'gravity {self._gravity.tolist()} m/s^2)'
        )

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the n independent joints in the order of the URDF: the order of q."""
        return self._tree.joint_names

    @property
    def tree(self) -> KinematicTree:
        """The tree of moving bodies, a `KinematicTree`."""
        return self._tree

    @property
    def gravity(self) -> Array:
        """Gravity acceleration in the base frame, m/s², shape (3,), read-only."""
        return self._gravity

    @property
    def payload(self) -> Payload | None:
        """The payload, or None; see `with_payload`."""
        return self._payload

    @property
    def rotor_inertia(self) -> Array:
        """Inertia of the rotors on the diagonal of D, kg m² or kg, shape (n,), read-only."""
        return self._rotor_inertia

    @property
    def friction(self) -> Friction:
        """Friction of the joints, a `Friction`; see `with_friction`."""
        return self._friction

    @property
    def link_names(self) -> tuple[str, ...]:
        """Names of all links, the root link first."""
        return tuple(self._tree.links)

    @property
    def tip_link(self) -> str:
        """Name of the link at the end of the arm: a tool or a hand, not a finger."""
        return self._tree.tip_link

    @property
    def warnings(self) -> tuple[str, ...]:
        """Implausible but accepted parts of the description, one sentence each."""
        return self._tree.warnings

    @property
    def moving_mass(self) -> float:
        """Total mass of the moving bodies and the payload, kg."""
        return float(self._inertia[:, 3, 3].sum())

    @property
    def inertial_parameters(self) -> Array:
        """
        The ten numbers of every moving body's J with its payload, shape (10 N,).

        m (kg), hx, hy, hz (kg m), xx, xy, xz, yy, yz, zz (kg m²) in the frame of the body: the
        order of the columns of `regressor`.

        """
        return ten_numbers(self._inertia).reshape(-1)

    @property
    def position_limits(self) -> Array:
        """Lower and upper position limits, shape (n, 2), rad or m; infinite if none."""
        return self._tree.limits[:, :2]

    @property
    def velocity_limits(self) -> Array:
        """Velocity limits, shape (n,), rad/s or m/s; NaN if the URDF states none."""
        return self._tree.limits[:, 2]

    @property
    def effort_limits(self) -> Array:
        """Effort limits, shape (n,), N m or N; NaN if the URDF states none."""
        return self._tree.limits[:, 3]

    @property
    def is_continuous(self) -> NDArray[np.bool_]:
        """Whether a joint is revolute without position limits, bool, shape (n,)."""
        independent = self._tree.is_independent
        turns = np.empty(self._n, dtype=bool)
        turns[self._tree.q_index[independent]] = ~self._tree.is_prismatic[independent]
        return turns & np.isinf(self._tree.limits[:, :2]).all(axis=1)

    @property
    def neutral_position(self) -> Array:
        """Zero, or the nearest position within the limits; shape (n,), rad or m."""
        return np.clip(np.zeros(self._n), self._tree.limits[:, 0], self._tree.limits[:, 1])

    def with_gravity(self, gravity: ArrayLike) -> RobotModel:
        """
        Return the same robot under another gravity.

        Parameters
        ----------
        gravity : array_like, shape (3,)
            Gravity acceleration in the base frame, m/s², points down.

        Returns
        -------
        RobotModel

        Raises
        ------
        ArgumentError
            If gravity is not three finite numbers.

        """
        return self._with(gravity=gravity)

    def with_payload(
        self,
        link: str,
        mass: float,
        com: ArrayLike = (0.0, 0.0, 0.0),
        inertia: ArrayLike | None = None,
    ) -> RobotModel:
        """
        Return the same robot with a payload on a link, which replaces a previous payload.

        Parameters
        ----------
        link : str
            Any link of the URDF; on a link fixed to the base a payload has no effect.
        mass : float
            kg; 0 for the robot without payload, equal to the original to the last bit.
        com : array_like, shape (3,)
            Center of mass in the link's frame, m.
        inertia : array_like, shape (3, 3), optional
            Inertia tensor about the center of mass, along the axes of the link's frame, kg m²;
            off-diagonal entries -∫xy dm as in URDF. By default a point mass.

        Returns
        -------
        RobotModel

        Raises
        ------
        ArgumentError
            If the link is unknown, a shape is wrong or a number is not finite.
        InertiaError
            If this mass and inertia are physically impossible; lists every violated condition.

        References
        ----------
        docs/mathematics.md, equation (5).

        """
        return self._with(payload=make_payload(self._tree.links, link, mass, com, inertia))

    def with_rotor_inertia(self, rotor_inertia: ArrayLike) -> RobotModel:
        """
        Return the same robot with the inertia of its motors' rotors.

        Parameters
        ----------
        rotor_inertia : array_like, shape (n,), or float
            Reflected to the joint: times the square of the gear ratio; kg m² or kg.

        Returns
        -------
        RobotModel

        Raises
        ------
        ArgumentError
            If the length is wrong or a number is negative or not finite.

        References
        ----------
        docs/mathematics.md, equation (28).

        """
        return self._with(rotor_inertia=rotor_inertia)

    def with_friction(
        self,
        viscous: ArrayLike | None = None,
        coulomb: ArrayLike | None = None,
        smoothing_velocity: ArrayLike | None = None,
    ) -> RobotModel:
        """
        Return the same robot with other friction; parameters that are None stay.

        Parameters
        ----------
        viscous : array_like, shape (n,), or float, optional
            N m s/rad or N s/m.
        coulomb : array_like, shape (n,), or float, optional
            Dry friction, N m or N.
        smoothing_velocity : array_like, shape (n,), or float, optional
            rad/s or m/s, > 0: dry friction is coulomb tanh(q̇ / smoothing_velocity).

        Returns
        -------
        RobotModel

        Raises
        ------
        ArgumentError
            If a length is wrong, a number is negative or not finite, or a smoothing velocity
            is zero.

        References
        ----------
        docs/mathematics.md, equation (27).

        """
        old = self._friction
        return self._with(
            friction=make_friction(
                self.joint_names,
                old.viscous if viscous is None else viscous,
                old.coulomb if coulomb is None else coulomb,
                old.smoothing_velocity if smoothing_velocity is None else smoothing_velocity,
            )
        )

    def _with(self, **changes: Any) -> RobotModel:
        arguments: dict[str, Any] = {
            'gravity': self._gravity,
            'payload': self._payload,
            'rotor_inertia': self._rotor_inertia,
            'friction': self._friction,
            'specialization': self._specialization,
            **changes,
        }
        return type(self)(self._tree, **arguments)

    @property
    def is_specialized(self) -> bool:
        """Whether machine code of this robot's own is in use."""
        return self._evaluation.specialization.code is not None

    def specialize(self, wait: bool = True, with_payload_code: bool = False) -> bool:
        """
        Request machine code of this robot's own now, not only after frequent use.

        Parameters
        ----------
        wait : bool
            True: return when it is in use, after some seconds if it was never compiled on this
            machine. False: return immediately; another process compiles it.
        with_payload_code : bool
            True: request the machine code for every payload and rotor inertia of this robot too,
            so that it is ready for the first payload. A robot has two codes because its own,
            with many numbers folded to zero, is faster.

        Returns
        -------
        bool
            Whether this model's code is in use. It never is with `compile=False`, for robots with
            more than 15 000 operations per quantity (from 16 to 30 joints on, depending on the
            robot's shape), on Pythons other than CPython 3.11 and later, and with
            DYNAMICS_NODE_SPECIALIZE=0.

        """
        specialization = self._evaluation.specialization
        if wait:
            return specialization.wait(with_payload_code)
        specialization.begin(with_payload_code)
        return self.is_specialized

    def mass_matrix(
        self, q: ArrayLike, *, out: Array | None = None, threads: int | None = None
    ) -> Array:
        """
        Return the joint-space mass matrix D(q).

        Parameters
        ----------
        q : array_like, shape (..., n)
            Joint positions, rad or m.
        out : numpy.ndarray, optional
            The result of an earlier call of this shape, to be overwritten: allocating large arrays
            takes longer than filling them.
        threads : int, optional
            Largest number of threads for a large batch; at least 1.

        Returns
        -------
        numpy.ndarray, shape (..., n, n)
            Symmetric, kg m² / kg m / kg.

        Raises
        ------
        ArgumentError
            If the last axis of q is not n.

        References
        ----------
        docs/mathematics.md, equation (15).

        """
        return self._evaluation.mass_matrix(q, out=out, threads=threads)

    def coriolis_matrix(self, q: ArrayLike, qd: ArrayLike, *, threads: int | None = None) -> Array:
        """
        Return the Coriolis matrix C(q, q̇) of Christoffel symbols: Ḋ = C + Cᵀ.

        Parameters
        ----------
        q, qd : array_like, shape (..., n)
            Joint positions (rad or m) and velocities; their batch axes broadcast.
        threads : int, optional
            Largest number of threads for a large batch; at least 1.

        Returns
        -------
        numpy.ndarray, shape (..., n, n)
            Effort unit per velocity unit: N m s/rad, N s/m or mixed.

        Raises
        ------
        ArgumentError
            If a last axis is not n or batch axes do not broadcast.

        References
        ----------
        docs/mathematics.md, equation (16).

        """
        return self._evaluation.coriolis_matrix(q, qd, threads=threads)

    def gravity_torque(
        self, q: ArrayLike, *, out: Array | None = None, threads: int | None = None
    ) -> Array:
        """
        Return the gravity torque G(q): the efforts that hold the robot still.

        Parameters
        ----------
        q : array_like, shape (..., n)
            Joint positions, rad or m.
        out : numpy.ndarray, optional
            The result of an earlier call of this shape, to be overwritten: allocating large arrays
            takes longer than filling them.
        threads : int, optional
            Largest number of threads for a large batch; at least 1.

        Returns
        -------
        numpy.ndarray, shape (..., n)
            N m or N.

        Raises
        ------
        ArgumentError
            If the last axis of q is not n.

        References
        ----------
        docs/mathematics.md, equation (17).

        """
        return self._evaluation.gravity_torque(q, out=out, threads=threads)

    def potential_energy(self, q: ArrayLike) -> Array:
        """
        Return the potential energy V(q) of the moving bodies.

        Parameters
        ----------
        q : array_like, shape (..., n)
            Joint positions, rad or m.

        Returns
        -------
        numpy.ndarray, shape (...)
            J, zero at the base frame's origin. Links fixed to the base do not count.

        Raises
        ------
        ArgumentError
            If the last axis of q is not n.

        References
        ----------
        docs/mathematics.md, equation (20).

        """
        return self._evaluation.potential_energy(q)

    def kinetic_energy(self, q: ArrayLike, qd: ArrayLike) -> Array:
        """
        Return the kinetic energy T = ½ q̇ᵀ D(q) q̇.

        Parameters
        ----------
        q, qd : array_like, shape (..., n)
            Joint positions (rad or m) and velocities; their batch axes broadcast.

        Returns
        -------
        numpy.ndarray, shape (...)
            J.

        Raises
        ------
        ArgumentError
            If a last axis is not n or batch axes do not broadcast.

        References
        ----------
        docs/mathematics.md, equation (20).

        """
        return self._evaluation.kinetic_energy(q, qd)

    def dynamics(
        self,
        q: ArrayLike,
        qd: ArrayLike,
        *,
        out: DynamicsTerms | None = None,
        threads: int | None = None,
    ) -> DynamicsTerms:
        """
        Return D, C and G in one pass.

        Parameters
        ----------
        q, qd : array_like, shape (..., n)
            Joint positions (rad or m) and velocities; their batch axes broadcast.
        out : DynamicsTerms, optional
            The result of an earlier call of this shape, to be overwritten: allocating large arrays
            takes longer than filling them.
        threads : int, optional
            Largest number of threads for a large batch; at least 1.

        Returns
        -------
        DynamicsTerms
            Unpacks as D, C, G.

        Raises
        ------
        ArgumentError
            If a last axis is not n or batch axes do not broadcast.

        References
        ----------
        docs/mathematics.md, equations (15) to (17).

        """
        return self._evaluation.dynamics(q, qd, out=out, threads=threads)

    def inverse_dynamics(
        self,
        q: ArrayLike,
        qd: ArrayLike,
        qdd: ArrayLike,
        *,
        out: Array | None = None,
        threads: int | None = None,
    ) -> Array:
        """
        Return the efforts of a motion, τ = D q̈ + C q̇ + G.

        Parameters
        ----------
        q, qd, qdd : array_like, shape (..., n)
            Joint positions (rad or m), velocities, accelerations; batch axes broadcast.
        out : numpy.ndarray, optional
            The result of an earlier call of this shape, to be overwritten: allocating large arrays
            takes longer than filling them.
        threads : int, optional
            Largest number of threads for a large batch; at least 1.

        Returns
        -------
        numpy.ndarray, shape (..., n)
            N m or N.

        Raises
        ------
        ArgumentError
            If a last axis is not n or batch axes do not broadcast.

        References
        ----------
        docs/mathematics.md, equations (22) and (23).

        """
        return self._evaluation.inverse_dynamics(q, qd, qdd, out=out, threads=threads)

    def forward_dynamics(
        self, q: ArrayLike, qd: ArrayLike, tau: ArrayLike, *, threads: int | None = None
    ) -> Array:
        """
        Return the accelerations caused by efforts, q̈ = D⁻¹ (τ - C q̇ - G).

        Parameters
        ----------
        q, qd : array_like, shape (..., n)
            Joint positions (rad or m) and velocities.
        tau : array_like, shape (..., n)
            Joint efforts, N m or N; batch axes broadcast.
        threads : int, optional
            Largest number of threads for a large batch; at least 1.

        Returns
        -------
        numpy.ndarray, shape (..., n)
            rad/s² or m/s².

        Raises
        ------
        ArgumentError
            If a last axis is not n or batch axes do not broadcast.
        SingularMassMatrixError
            If D is not positive definite beyond rounding: a joint moves no inertia.

        References
        ----------
        docs/mathematics.md, equation (25).

        """
        return self._evaluation.forward_dynamics(q, qd, tau, threads=threads)

    def regressor(
        self, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike, *, threads: int | None = None
    ) -> Array:
        """
        Return the regressor Y of a motion: its efforts are Y φ for the inertial parameters φ.

        `regressor(q, qd, qdd) @ inertial_parameters` is `inverse_dynamics(q, qd, qdd)` without
        the inertia of rotors. It depends on gravity, but not on the masses of the model.

        Parameters
        ----------
        q, qd, qdd : array_like, shape (..., n)
            Joint positions, velocities and accelerations. Batch axes broadcast.
        threads : int, optional
            Largest number of threads for a large batch; at least 1.

        Returns
        -------
        numpy.ndarray, shape (..., n, 10 N)
            Ten columns per moving body, in the order of `tree.moving_joint_names`: m, hx, hy,
            hz, then the second moments xx, xy, xz, yy, yz, zz, all in the frame of the body.

        Raises
        ------
        ArgumentError
            If a last axis is not n or batch axes do not broadcast.

        References
        ----------
        docs/mathematics.md, equation (36).

        """
        return self._evaluation.regressor(q, qd, qdd, threads=threads)

    def friction_torque(self, qd: ArrayLike) -> Array:
        """
        Return the efforts that overcome friction, viscous q̇ + coulomb tanh(q̇ / smoothing).

        Parameters
        ----------
        qd : array_like, shape (..., n)
            Joint velocities, rad/s or m/s.

        Returns
        -------
        numpy.ndarray, shape (..., n)
            N m or N, with the sign of q̇; to be added to `inverse_dynamics`.

        Raises
        ------
        ArgumentError
            If the last axis of qd is not n.

        References
        ----------
        docs/mathematics.md, equation (27).

        """
        batch_shape, [velocities] = self._evaluation.states(qd=qd)
        return self._friction.torque(velocities).reshape(*batch_shape, self._n)

    def jacobian(self, q: ArrayLike, link: str, point: ArrayLike = (0.0, 0.0, 0.0)) -> Array:
        """
        Return the Jacobian of a point of a link: its velocity is J(q) q̇.

        Parameters
        ----------
        q : array_like, shape (..., n)
            Joint positions, rad or m.
        link : str
            Any link of the URDF.
        point : array_like, shape (3,)
            In the link's frame, m.

        Returns
        -------
        numpy.ndarray, shape (..., 6, n)
            Along the axes of the base frame: three rows of the point's velocity, m/s, then three
            of the link's angular velocity, rad/s. Jᵀ maps a force and a moment at the point to
            joint efforts.

        Raises
        ------
        ArgumentError
            If the link is unknown, or a shape is wrong.

        References
        ----------
        docs/mathematics.md, equation (29).

        """
        check_link(self._tree.links, link)
        return self._evaluation.jacobian(q, self._tree.links[link], point)

    def link_pose(self, q: ArrayLike, link: str) -> Array:
        """
        Return the pose of a link: the transform from its frame to the base frame.

        Parameters
        ----------
        q : array_like, shape (..., n)
            Joint positions, rad or m.
        link : str
            Any link of the URDF.

        Returns
        -------
        numpy.ndarray, shape (..., 4, 4)
            Homogeneous transforms, m.

        Raises
        ------
        ArgumentError
            If the link is unknown, or the last axis of q is not n.

        References
        ----------
        docs/mathematics.md, section 4: A_k.

        """
        check_link(self._tree.links, link)
        return self._evaluation.link_pose(q, self._tree.links[link])

    def body_poses(self, q: ArrayLike) -> Array:
        """
        Return the poses of all moving bodies: the transforms from their frames to the base frame.

        Parameters
        ----------
        q : array_like, shape (..., n)
            Joint positions, rad or m.

        Returns
        -------
        numpy.ndarray, shape (..., N, 4, 4)
            Homogeneous transforms, m, in the order of `tree.moving_joint_names`.

        Raises
        ------
        ArgumentError
            If the last axis of q is not n.

        References
        ----------
        docs/mathematics.md, section 4: A_k.

        """
        return self._evaluation.body_poses(q)

    def trajectory_effort(
        self,
        time: ArrayLike,
        positions: ArrayLike,
        velocities: ArrayLike | None = None,
        accelerations: ArrayLike | None = None,
    ) -> Array:
        """
        Return the efforts along a trajectory: inverse dynamics at each of its points.

        Parameters
        ----------
        time : array_like, shape (N,)
            s; strictly increasing if velocities or accelerations are missing.
        positions : array_like, shape (N, n)
            Joint positions, rad or m.
        velocities, accelerations : array_like, shape (N, n), optional
            rad/s or m/s, rad/s² or m/s². A point without them is a row of NaN. Missing values
            come from a spline: see `complete_trajectory`, which also reports their source.

        Returns
        -------
        numpy.ndarray, shape (N, n)
            N m or N. `over_limit` compares them with limits.

        Raises
        ------
        ArgumentError
            If there is no point, shapes do not fit, a number is not finite, or times do not
            increase where a spline is needed.

        References
        ----------
        docs/mathematics.md, equations (22), (23), (30) and (31).

        """
        motion = complete_trajectory(time, positions, velocities, accelerations)
        if motion.positions.shape[1] != self._n:
            raise ArgumentError(
                f'positions: expected shape (N, {self._n}) for joints '
                f'{list(self.joint_names)}, got {motion.positions.shape}'
            )
        return self.inverse_dynamics(motion.positions, motion.velocities, motion.accelerations)

    def max_payload(
        self,
        q: ArrayLike,
        link: str,
        point: ArrayLike = (0.0, 0.0, 0.0),
        *,
        qd: ArrayLike | None = None,
        qdd: ArrayLike | None = None,
        effort_limits: ArrayLike | None = None,
    ) -> MaxPayload:
        """
        Return the largest point mass on a link within all effort limits.

        It takes the model's gravity vector, for any mounting. Every smaller mass is within the
        limits too. The mass replaces a payload of the model; friction is ignored. A trajectory is
        a batch: `least()` of the result is its largest payload.

        Parameters
        ----------
        q : array_like, shape (..., n)
            Joint positions, rad or m.
        link : str
            A link of the URDF.
        point : array_like, shape (3,)
            Position of the mass in the link's frame, m.
        qd, qdd : array_like, shape (..., n), optional
            Joint velocities and accelerations; zero if not given. Batch axes broadcast.
        effort_limits : array_like, shape (n,), optional
            N m or N; by default those of the URDF. NaN: the joint has no limit.

        Returns
        -------
        MaxPayload
            Unpacks as mass (...), kg, and joint (...), the index of the limiting joint. Over a
            limit without the mass: 0 and the joint with the largest excess. Without limit:
            infinite and -1.

        Raises
        ------
        ArgumentError
            If shapes do not fit, the link is unknown, the point is not finite or a limit is
            negative.

        References
        ----------
        docs/mathematics.md, equation (32).

        """
        zeros = np.zeros(self._n)
        unloaded = self if self._payload is None else self._with(payload=None)
        return max_payload(
            unloaded,
            q,
            link,
            point,
            zeros if qd is None else qd,
            zeros if qdd is None else qdd,
            self.effort_limits if effort_limits is None else effort_limits,
        )


def _install(model: RobotModel, code: RobotCode) -> None:
    # Machine code replaces methods of the instance. Arguments that it does not cover go to the
    # evaluation, not to the method: a function that refers to its model would never be freed.
    evaluation = model._evaluation
    for name, shapes in SHAPES.items():
        method = getattr(RobotModel, name)
        # Methods of a subclass, and functions assigned to the instance, stay.
        if getattr(type(model), name) is method and name not in vars(model):
            function = code.python_entry(
                name,
                shapes(len(model.joint_names)),
                getattr(evaluation, name),
                method.__doc__,
                DynamicsTerms,
                evaluation.packed.numbers,
            )
            setattr(model, name, function)
