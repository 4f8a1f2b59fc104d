"""`RobotView`: one robot at its newest state, with the newest gravity torque."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from .. import Picture, Shape
from ...dynamics import JointSelection, RobotModel
from ...errors import DynamicsError
from ...ros.parameters.model_settings import tensor

# Largest age of a drawn gravity torque, s.
TORQUE_TIMEOUT = 1.0


class RobotView:
    """
    Draws one robot at its newest joint state.

    Without settings only the masses are drawn: only the dynamics node knows gravity, payload and
    torques.

    Attributes
    ----------
    model : RobotModel
        With payload and gravity of the settings; without settings no gravity is drawn.
    joint_names : tuple of str
        The m joints whose torques are drawn; none without settings.
    has_new_state : bool
        Whether a joint state has been received since the last call of `shapes`.

    """

    def __init__(self, source: str | bytes) -> None:
        """
        Read a robot description.

        Parameters
        ----------
        source : str or bytes
            A path, or the text as bytes.

        Raises
        ------
        DynamicsError
            If the description is invalid, or has no movable joint.

        """
        self._described = RobotModel.from_urdf(source, (0.0, 0.0, 0.0), compile=False)
        names = self._described.joint_names
        if not names:
            raise DynamicsError('the robot has no joint that can be moved')
        self._index = {name: i for i, name in enumerate(names)}
        self._position = self._described.neutral_position.copy()
        self._effort = np.full(len(names), np.nan)
        self._torque: dict[str, float] = {}
        self._torque_time = -np.inf
        self.has_new_state = False
        self.model = self._described
        self.joint_names: tuple[str, ...] = ()
        self._picture = Picture(self.model.tree, self.joint_names)
        self.configure(None)

    def configure(self, settings: dict[str, Any] | None) -> None:
        """
        Apply the settings of the dynamics node.

        Parameters
        ----------
        settings : dict of str to Any or None
            Its parameters `joints`, `gravity`, `effort_limits` and `payload.*`; None while they
            are unknown.

        Raises
        ------
        DynamicsError
            If they do not fit this robot, which is then drawn without settings.

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
        # A picture does not depend on gravity, which may change many times a second.
        if joint_names != self.joint_names:
            self._picture = Picture(model.tree, joint_names)
        self.model, self.joint_names = model, joint_names
        self._limits = np.array(limits, dtype=float)
        self._selected = [self._index[name] for name in joint_names]

    def take_state(
        self, names: Sequence[str], position: Sequence[float], effort: Sequence[float]
    ) -> None:
        """
        Apply a joint state; other joints keep their position, initially the neutral one.

        Parameters
        ----------
        names : sequence of str
            In any order; joints of other robots are ignored.
        position : sequence of float
            One per name, otherwise the state is ignored; rad or m.
        effort : sequence of float
            One per name, N m or N; otherwise no efforts are drawn.

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

    def take_torque(
        self, names: Sequence[str], gravity_torque: Sequence[float], now: float
    ) -> None:
        """
        Apply the gravity torque computed by the dynamics node.

        Parameters
        ----------
        names : sequence of str
        gravity_torque : sequence of float
            One per name, N m or N.
        now : float
            Steady clock, s.

        """
        self._torque = dict(zip(names, gravity_torque, strict=False))
        self._torque_time = now

    def shapes(self, now: float) -> list[Shape]:
        """
        Return the shapes of the newest state.

        Parameters
        ----------
        now : float
            Steady clock, s.

        Returns
        -------
        list of Shape
            In the base frame; with torques and efforts only while the gravity torque is finite,
            contains all of `joint_names` and is not older than TORQUE_TIMEOUT.

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
