"""`RobotModel`: the dynamics of one robot, for one state or many."""

import inspect

import numpy as np

from .arguments import check_link, gravity_vector, per_joint
from .batch import Evaluation, SHAPES
from .effort_limits import max_payload
from .friction import make_friction, SMOOTHING_VELOCITY
from .payload import loaded_inertia, make_payload
from .terms import DynamicsTerms
from .trajectory import complete_trajectory
from ..codegen import make_callable
from ..codegen.manager import Specialization
from ..errors import ArgumentError
from ..kernels.packing import pack
from ..model import build_tree
from ..urdf import read_urdf

STANDARD_GRAVITY = (0.0, 0.0, -9.81)


class RobotModel:
    """
    A robot with a fixed base: D(q) q̈ + C(q, q̇) q̇ + G(q) = τ.

    What it describes never changes: another gravity, payload, rotor inertia or friction makes
    another model at once (`with_gravity`, `with_payload`...). Friction is no part of the
    equation above; `friction_torque` says what to add. Every method takes arrays with leading
    batch axes and may be called from several threads. NaN in an argument gives NaN in all that
    depends on it.

    Large batches are computed by as many threads as the process may use, or by `threads`.

    A robot that is used often gets machine code of its own, compiled by another process and kept
    on disk; until it is ready, and for large robots, a general kernel answers. The two agree to
    rounding. See `specialize`.

    Revolute joints count in rad, rad/s, N m; prismatic ones in m, m/s, N. The base frame is the
    root link's frame.

    """

    def __init__(
        self,
        tree,
        gravity=STANDARD_GRAVITY,
        *,
        payload=None,
        rotor_inertia=0.0,
        friction=None,
        specialization=None,
    ):
        """
        Make the model of a kinematic tree; most users want `from_urdf`.

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
            See `with_friction`; by default what the tree says.
        specialization : Specialization, optional
            That of another model of the same tree, without payload and rotor inertia.

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
        self._specialization = specialization or Specialization(*pack(tree, self._gravity))
        if self._inertia is not tree.inertia or self._rotor_inertia.any():
            packed = pack(tree, self._gravity, self._inertia, self._rotor_inertia)
            specialization = self._specialization.for_any_inertia
        else:
            packed = pack(tree, self._gravity)
            specialization = self._specialization
        self._evaluation = Evaluation(packed, tree.joint_names, specialization)
        specialization.attach(self)

    @classmethod
    def from_urdf(cls, source, gravity=STANDARD_GRAVITY):
        """
        Make the model of a URDF.

        Parameters
        ----------
        source : str, bytes or os.PathLike
            A path or the URDF text itself. Meshes are never opened.
        gravity : array_like, shape (3,)
            Gravity acceleration in the root link's frame, m/s², points down.

        Returns
        -------
        RobotModel

        Raises
        ------
        RobotDescriptionError
            If the URDF cannot be used; lists every problem at once.
        ArgumentError
            If gravity is not three finite numbers.

        """
        return cls(build_tree(read_urdf(source)), gravity)

    def __getstate__(self):
        # Machine code stays where it is: its addresses mean nothing in another process.
        return {name: value for name, value in vars(self).items() if not inspect.isbuiltin(value)}

    def __setstate__(self, state):
        vars(self).update(state)
        self._evaluation.specialization.attach(self)

    def __repr__(self):
        return (
            f'RobotModel({self._n} joints, {self.moving_mass:.6g} kg moving, '
            f'gravity {self._gravity.tolist()} m/s^2)'
        )

    @property
    def joint_names(self):
        """Names of the n independent joints in the order of the URDF: the order of q."""
        return self._tree.joint_names

    @property
    def tree(self):
        """The tree of moving bodies, a `KinematicTree`."""
        return self._tree

    @property
    def gravity(self):
        """Gravity acceleration in the base frame, m/s², shape (3,), read-only."""
        return self._gravity

    @property
    def payload(self):
        """What a link carries besides, a `Payload`, or None; see `with_payload`."""
        return self._payload

    @property
    def rotor_inertia(self):
        """Inertia of the rotors on the diagonal of D, kg m² or kg, shape (n,), read-only."""
        return self._rotor_inertia

    @property
    def friction(self):
        """Friction of the joints, a `Friction`; see `with_friction`."""
        return self._friction

    @property
    def link_names(self):
        """Names of all links, the root link first."""
        return tuple(self._tree.links)

    @property
    def tip_link(self):
        """Name of the link at the end of the arm: of a tool or a hand, not of a finger."""
        return self._tree.tip_link

    @property
    def warnings(self):
        """What was accepted in the description but looks wrong, one sentence each."""
        return self._tree.warnings

    @property
    def moving_mass(self):
        """Mass of everything that joints move, with the payload, kg."""
        return float(self._inertia[:, 3, 3].sum())

    @property
    def position_limits(self):
        """Lower and upper position limits, shape (n, 2), rad or m; infinite if none."""
        return self._tree.limits[:, :2]

    @property
    def velocity_limits(self):
        """Velocity limits, shape (n,), rad/s or m/s; NaN if the URDF states none."""
        return self._tree.limits[:, 2]

    @property
    def effort_limits(self):
        """Effort limits, shape (n,), N m or N; NaN if the URDF states none."""
        return self._tree.limits[:, 3]

    @property
    def is_continuous(self):
        """Joints that turn without end, bool, shape (n,): revolute, with no position limit."""
        independent = self._tree.is_independent
        turns = np.empty(self._n, dtype=bool)
        turns[self._tree.q_index[independent]] = ~self._tree.is_prismatic[independent]
        return turns & np.isinf(self._tree.limits[:, :2]).all(axis=1)

    @property
    def neutral_position(self):
        """Zero, or the nearest position within the limits; shape (n,), rad or m."""
        return np.clip(np.zeros(self._n), self._tree.limits[:, 0], self._tree.limits[:, 1])

    def with_gravity(self, gravity):
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

    def with_payload(self, link, mass, com=(0.0, 0.0, 0.0), inertia=None):
        """
        Return the same robot with a payload on a link, in place of the one that it carries.

        Parameters
        ----------
        link : str
            Any link of the URDF; on one that no joint moves a payload has no effect.
        mass : float
            kg; 0 for the robot without payload, to the last bit as it was before.
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
            If no real body has this mass and inertia; with every violated condition.

        References
        ----------
        docs/mathematics.md, equation (5).

        """
        return self._with(payload=make_payload(self._tree.links, link, mass, com, inertia))

    def with_rotor_inertia(self, rotor_inertia):
        """
        Return the same robot with the inertia of its motors' rotors.

        Parameters
        ----------
        rotor_inertia : array_like, shape (n,), or float
            As the joint feels it, so times the square of the gear ratio; kg m² or kg.

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

    def with_friction(self, viscous=None, coulomb=None, smoothing_velocity=None):
        """
        Return the same robot with other friction; what is not given stays.

        Parameters
        ----------
        viscous : array_like, shape (n,), or float, optional
            N m s/rad or N s/m.
        coulomb : array_like, shape (n,), or float, optional
            Dry friction, N m or N.
        smoothing_velocity : array_like, shape (n,), or float, optional
            rad/s or m/s, > 0: through zero, dry friction changes its sign as tanh does.

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

    def _with(self, **changes):
        arguments = {
            'gravity': self._gravity,
            'payload': self._payload,
            'rotor_inertia': self._rotor_inertia,
            'friction': self._friction,
            'specialization': self._specialization,
            **changes,
        }
        return type(self)(self._tree, **arguments)

    @property
    def is_specialized(self):
        """Whether machine code of this robot's own is in use."""
        return self._evaluation.specialization.code is not None

    def specialize(self, wait=True, loads=False):
        """
        Ask for machine code of this robot's own, without waiting until it is used often.

        Parameters
        ----------
        wait : bool
            True: return when it is in use, after some seconds if it was never compiled on this
            machine. False: return at once, and have another process compile it.
        loads : bool
            True: ask for the machine code that serves this robot under every payload and rotor
            inertia too, so that the first of them finds it. A robot has it beside its own,
            because its own, which knows that many numbers are zero, is faster.

        Returns
        -------
        bool
            Whether this model's is in use. It never is for robots of which one quantity takes
            more than 15 000 operations (somewhere between 16 and 30 joints, depending on the
            robot's shape), on Pythons other than CPython 3.11 and later, and with
            DYNAMICS_NODE_SPECIALIZE=0.

        """
        specialization = self._evaluation.specialization
        if wait:
            return specialization.wait(loads)
        specialization.begin(loads)
        return self.is_specialized

    def _use(self, code):
        # Machine code takes the place of methods. What it does not take, it hands to the
        # evaluation, not to the method: a function that refers to its model would never be freed.
        for name, shapes in SHAPES.items():
            # A method of a subclass, or that somebody has put in its place, stays.
            if getattr(type(self), name) is getattr(RobotModel, name) and name not in vars(self):
                fallback = getattr(self._evaluation, name)
                setattr(
                    self,
                    name,
                    make_callable(
                        code.loaded,
                        name,
                        shapes(self._n),
                        fallback,
                        getattr(RobotModel, name).__doc__,
                        DynamicsTerms,
                        self._evaluation.packed[1],
                    ),
                )

    def mass_matrix(self, q, *, out=None, threads=None):
        """
        Return the joint-space mass matrix D(q).

        Parameters
        ----------
        q : array_like, shape (..., n)
            Joint positions, rad or m.
        out : numpy.ndarray, optional
            Where to put the answer: what an earlier call of this shape has returned. Large
            arrays take longer to make than to fill.
        threads : int, optional
            At most so many for a large batch; at least 1.

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

    def coriolis_matrix(self, q, qd, *, threads=None):
        """
        Return the Coriolis matrix C(q, q̇) of Christoffel symbols: Ḋ = C + Cᵀ.

        Parameters
        ----------
        q, qd : array_like, shape (..., n)
            Joint positions (rad or m) and velocities; their batch axes broadcast.
        threads : int, optional
            At most so many for a large batch; at least 1.

        Returns
        -------
        numpy.ndarray, shape (..., n, n)
            Effort unit per velocity unit: N m s/rad, N s/m or mixed.

        Raises
        ------
        ArgumentError
            If a last axis is not n or batch axes do not fit.

        References
        ----------
        docs/mathematics.md, equation (16).

        """
        return self._evaluation.coriolis_matrix(q, qd, threads=threads)

    def gravity_torque(self, q, *, out=None, threads=None):
        """
        Return the gravity torque G(q): the efforts that hold the robot still.

        Parameters
        ----------
        q : array_like, shape (..., n)
            Joint positions, rad or m.
        out : numpy.ndarray, optional
            Where to put the answer: what an earlier call of this shape has returned. Large
            arrays take longer to make than to fill.
        threads : int, optional
            At most so many for a large batch; at least 1.

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

    def potential_energy(self, q):
        """
        Return the potential energy V(q) of what joints move.

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

    def kinetic_energy(self, q, qd):
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
            If a last axis is not n or batch axes do not fit.

        References
        ----------
        docs/mathematics.md, equation (20).

        """
        return self._evaluation.kinetic_energy(q, qd)

    def dynamics(self, q, qd, *, out=None, threads=None):
        """
        Return D, C and G in one pass.

        Parameters
        ----------
        q, qd : array_like, shape (..., n)
            Joint positions (rad or m) and velocities; their batch axes broadcast.
        out : DynamicsTerms, optional
            Where to put the answer: what an earlier call of this shape has returned. Large
            arrays take longer to make than to fill.
        threads : int, optional
            At most so many for a large batch; at least 1.

        Returns
        -------
        DynamicsTerms
            Unpacks as D, C, G.

        Raises
        ------
        ArgumentError
            If a last axis is not n or batch axes do not fit.

        References
        ----------
        docs/mathematics.md, equations (15) to (17).

        """
        return self._evaluation.dynamics(q, qd, out=out, threads=threads)

    def inverse_dynamics(self, q, qd, qdd, *, out=None, threads=None):
        """
        Return the efforts of a motion, τ = D q̈ + C q̇ + G.

        Parameters
        ----------
        q, qd, qdd : array_like, shape (..., n)
            Joint positions (rad or m), velocities, accelerations; batch axes broadcast.
        out : numpy.ndarray, optional
            Where to put the answer: what an earlier call of this shape has returned. Large
            arrays take longer to make than to fill.
        threads : int, optional
            At most so many for a large batch; at least 1.

        Returns
        -------
        numpy.ndarray, shape (..., n)
            N m or N.

        Raises
        ------
        ArgumentError
            If a last axis is not n or batch axes do not fit.

        References
        ----------
        docs/mathematics.md, equations (22) and (23).

        """
        return self._evaluation.inverse_dynamics(q, qd, qdd, out=out, threads=threads)

    def forward_dynamics(self, q, qd, tau, *, threads=None):
        """
        Return the accelerations that efforts cause, q̈ = D⁻¹ (τ - C q̇ - G).

        Parameters
        ----------
        q, qd : array_like, shape (..., n)
            Joint positions (rad or m) and velocities.
        tau : array_like, shape (..., n)
            Joint efforts, N m or N; batch axes broadcast.
        threads : int, optional
            At most so many for a large batch; at least 1.

        Returns
        -------
        numpy.ndarray, shape (..., n)
            rad/s² or m/s².

        Raises
        ------
        ArgumentError
            If a last axis is not n or batch axes do not fit.
        SingularMassMatrixError
            If D is not positive definite beyond rounding: a joint moves nothing that has
            inertia.

        References
        ----------
        docs/mathematics.md, equation (25).

        """
        return self._evaluation.forward_dynamics(q, qd, tau, threads=threads)

    def friction_torque(self, qd):
        """
        Return the efforts that friction takes, viscous q̇ + coulomb tanh(q̇ / smoothing).

        Parameters
        ----------
        qd : array_like, shape (..., n)
            Joint velocities, rad/s or m/s.

        Returns
        -------
        numpy.ndarray, shape (..., n)
            N m or N, of the sign of q̇: what a motor has to add to `inverse_dynamics`.

        Raises
        ------
        ArgumentError
            If the last axis of qd is not n.

        References
        ----------
        docs/mathematics.md, equation (27).

        """
        lead, [qd] = self._evaluation.states(qd=qd)
        return self._friction.torque(qd).reshape(*lead, self._n)

    def jacobian(self, q, link, point=(0.0, 0.0, 0.0)):
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
            of the link's angular velocity, rad/s. Jᵀ takes a force and a moment at the point to
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

    def link_pose(self, q, link):
        """
        Return where a link is: the transform from its frame to the base frame.

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

    def body_poses(self, q):
        """
        Return where all moving bodies are: the transforms from their frames to the base frame.

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

    def trajectory_effort(self, time, positions, velocities=None, accelerations=None):
        """
        Return the efforts along a trajectory: inverse dynamics at each of its points.

        Parameters
        ----------
        time : array_like, shape (N,)
            s; strictly increasing if velocities or accelerations are missing.
        positions : array_like, shape (N, n)
            Joint positions, rad or m.
        velocities, accelerations : array_like, shape (N, n), optional
            rad/s or m/s, rad/s² or m/s². A point without them is a row of NaN. What is missing
            is obtained by a spline: see `complete_trajectory`, which also says what it was.

        Returns
        -------
        numpy.ndarray, shape (N, n)
            N m or N. `over_limit` tells which of them are too much.

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
        self, q, link, point=(0.0, 0.0, 0.0), *, qd=None, qdd=None, effort_limits=None
    ):
        """
        Return the largest point mass that a link may carry within all effort limits.

        Along the real gravity vector, whatever the mounting. Every mass from zero up to this one
        is within the limits too. It takes the place of a payload that the model has, which does
        not count, nor does friction. A trajectory is a batch: `least()` of the answer is its
        largest payload.

        Parameters
        ----------
        q : array_like, shape (..., n)
            Joint positions, rad or m.
        link : str
            A link of the URDF.
        point : array_like, shape (3,)
            Where the mass is, in the link's frame, m.
        qd, qdd : array_like, shape (..., n), optional
            Joint velocities and accelerations; zero if not given. Batch axes broadcast.
        effort_limits : array_like, shape (n,), optional
            N m or N, those of the URDF if not given. NaN: the joint has no limit.

        Returns
        -------
        MaxPayload
            Unpacks as mass (...), kg, and joint (...), the index of the joint that allows no
            more. Over a limit already: 0 and the joint that is most so. No limit in the way:
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
        rest = np.zeros(self._n)
        unloaded = self if self._payload is None else self._with(payload=None)
        return max_payload(
            unloaded,
            q,
            link,
            point,
            rest if qd is None else qd,
            rest if qdd is None else qdd,
            self.effort_limits if effort_limits is None else effort_limits,
        )
