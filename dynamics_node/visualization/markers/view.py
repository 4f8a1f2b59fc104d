"""`RobotView`: one robot as it is shown, with the newest state and the newest gravity torque."""

import numpy as np

from .. import Picture
from ...dynamics import JointSelection, RobotModel
from ...errors import DynamicsError
from ...ros.parameters.model_settings import tensor

# A gravity torque that is older than this is not shown any more, s.
TORQUE_TIMEOUT = 1.0


class RobotView:
    """
    Draws one robot at its newest joint state.

    Without settings, the masses are drawn: gravity, payload and torques are known to the
    dynamics node alone.

    Attributes
    ----------
    model : RobotModel
        With payload and gravity of the settings; without settings no gravity is drawn.
    joint_names : tuple of str
        The m joints whose torques are drawn; none without settings.
    has_new_state : bool
        Whether a joint state has come since `shapes` was called.

    """

    def __init__(self, source):
        """
        Read a robot description.

        Parameters
        ----------
        source : str or bytes
            A path, or the text as bytes.

        Raises
        ------
        DynamicsError
            If the description is refused, or no joint of it can be moved.

        """
        self._described = RobotModel.from_urdf(source, (0.0, 0.0, 0.0), compile=False)
        names = self._described.joint_names
        if not names:
            raise DynamicsError('the robot has no joint that can be moved')
        self._index = {name: i for i, name in enumerate(names)}
        self._position = self._described.neutral_position.copy()
        self._effort = np.full(len(names), np.nan)
        self._torque, self._torque_time = {}, -np.inf
        self.has_new_state = False
        self.model = self._described
        self.joint_names: tuple[str, ...] = ()
        self._picture = Picture(self.model.tree, self.joint_names)
        self.configure(None)

    def configure(self, settings):
        """
        Take the settings of the dynamics node.

        Parameters
        ----------
        settings : dict of str to Any or None
            Its parameters `joints`, `gravity`, `effort_limits` and `payload.*`; None while they
            are unknown.

        Raises
        ------
        DynamicsError
            If they do not belong to this robot; then the robot is shown without settings.

        """
        try:
            self._show(*(self._fitted(settings) if settings else (self._described, (), ())))
        except DynamicsError:
            self._show(self._described, (), ())
            raise

    def _fitted(self, settings):
        selection = JointSelection(self._described, settings['joints'])
        limits = settings['effort_limits'] or self._described.effort_limits[selection.index]
        if len(limits) != len(selection.names):
            raise DynamicsError(
                f'effort_limits: expected {len(selection.names)} numbers for '
                f'{", ".join(selection.names)}, got {len(limits)}'
            )
        model = self._described.with_gravity(settings['gravity']).with_payload(
            settings['payload.link'],
            settings['payload.mass'],
            settings['payload.com'],
            tensor(settings['payload.inertia']),
        )
        return model, selection.names, limits

    def _show(self, model, joint_names, limits):
        # Gravity may change many times a second, and a picture does not depend on it.
        if joint_names != self.joint_names:
            self._picture = Picture(model.tree, joint_names)
        self.model, self.joint_names = model, joint_names
        self._limits = np.array(limits, dtype=float)
        self._selected = [self._index[name] for name in joint_names]

    def take_state(self, names, position, effort):
        """
        Take a joint state; other joints stay where they were, at first in neutral position.

        Parameters
        ----------
        names : sequence of str
            In any order; joints of other robots are passed over.
        position : sequence of float
            As many as names, otherwise the whole state is ignored; rad or m.
        effort : sequence of float
            As many as names, N m or N; otherwise no efforts are shown.

        """
        if len(position) != len(names):
            return
        if len(effort) != len(names):
            effort = [np.nan] * len(names)
        for name, q, tau in zip(names, position, effort, strict=True):
            i = self._index.get(name)
            if i is not None and np.isfinite(q):
                self._position[i] = q
                self._effort[i] = tau if np.isfinite(tau) else np.nan
                self.has_new_state = True

    def take_torque(self, names, gravity_torque, now):
        """
        Take the gravity torque that the dynamics node has computed.

        Parameters
        ----------
        names : sequence of str
        gravity_torque : sequence of float
            As many as names, N m or N.
        now : float
            Steady clock, s.

        """
        self._torque = dict(zip(names, gravity_torque, strict=False))
        self._torque_time = now

    def shapes(self, now):
        """
        Return what the robot looks like at the newest state.

        Parameters
        ----------
        now : float
            Steady clock, s.

        Returns
        -------
        list of Shape
            In the base frame. Torques and efforts are among them only while the gravity torque
            is finite, names all of `joint_names` and is not older than TORQUE_TIMEOUT.

        """
        self.has_new_state = False
        torque = np.array([self._torque.get(name, np.nan) for name in self.joint_names])
        is_known = now - self._torque_time <= TORQUE_TIMEOUT and bool(np.isfinite(torque).all())
        return self._picture.shapes(
            self.model,
            self._position,
            torque if is_known else None,
            self._effort[self._selected],
            self._limits,
        )
