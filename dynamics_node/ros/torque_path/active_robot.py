"""The robot in force: model, chosen joints and measured state, replaced together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..parameters.model_settings import configured
from ...dynamics import Compensation, JointSelection, RobotModel
from ...errors import DynamicsError
from ...model import build_tree
from ...safety import JointStateBuffer, MotionLimits
from ...urdf import read_urdf

# Maximum number of joints listed in a message about position limits.
_MAX_LISTED = 8
# Relative tolerance of a position computed to be at its limit.
_ROUNDING = 1e-9


def read_robot(source: str | bytes, values: Mapping[str, Any]) -> ActiveRobot:
    """
    Read a robot from a description.

    Parameters
    ----------
    source : str or bytes
        Path or text of the URDF.
    values : mapping of str to Any
        Of the parameters: `joints`, and `machine_code`; if that is false, the model never starts
        a compiler.

    Returns
    -------
    ActiveRobot
        Not configured yet.

    Raises
    ------
    DynamicsError
        If the description is refused, or has no movable joint.

    """
    tree = build_tree(read_urdf(source))
    if not tree.joint_names:
        raise DynamicsError('the robot has no joint that can be moved')
    return ActiveRobot(RobotModel(tree, compile=values['machine_code']), values['joints'])


class StateUnavailableError(DynamicsError):
    """A request needs the newest measured state, and no fresh one exists."""


class ActiveRobot:
    """
    One robot as the node uses it.

    Attributes
    ----------
    model : RobotModel
        Configured by the parameters; replaced when they change.
    selection : JointSelection
        The parameter `joints`.
    buffer : JointStateBuffer
        Measured states of all joints of the model.
    has_all_in_order : bool
        Whether the chosen joints are all joints of the model, in its order, so that no selection
        is needed.
    refused_since : str
        Reason for which a newer description was refused; '' if none was.
    state_publishers : int
        Number of nodes that publish its joint states; 0 while unknown.

    """

    def __init__(self, model: RobotModel, joints: Sequence[str]) -> None:
        """
        Start without measured states.

        Parameters
        ----------
        model : RobotModel
        joints : sequence of str
            The parameter `joints`; empty for all.

        Raises
        ------
        ArgumentError
            If a joint is unknown, fixed, a mimic joint or named twice.

        """
        self.model = model
        self.selection = JointSelection(model, joints)
        self.buffer = JointStateBuffer(
            model.joint_names, self.selection.names, model.neutral_position, self.motion_limits(())
        )
        self.refused_since = ''
        # Arguments and result of the last call of `configured`.
        self._configured_for: tuple | None = None
        self._configured_model = model
        self.state_publishers = 0
        self.has_all_in_order = self.selection.names == tuple(model.joint_names)

    def configure(
        self, values: Mapping[str, Any], before: Mapping[str, Any] | None = None
    ) -> None:
        """
        Apply the parameters to the model.

        Parameters
        ----------
        values : mapping of str to Any
            Of the parameters.
        before : mapping of str to Any, optional
            Parameters of the present model.

        Raises
        ------
        DynamicsError
            See `model_settings.configured`.

        """
        self.model = self.configured(values, before)

    def configured(
        self, values: Mapping[str, Any], before: Mapping[str, Any] | None = None
    ) -> RobotModel:
        """
        Return the model that `configure` would set; the last result is cached.

        Parameters
        ----------
        values, before : mapping of str to Any
            See `configure`.

        Returns
        -------
        RobotModel

        Raises
        ------
        DynamicsError
            See `model_settings.configured`.

        """
        arguments = (self.model, values, before)
        if arguments != self._configured_for:
            self._configured_model = configured(self, values, before)
            self._configured_for = arguments
        return self._configured_model

    @property
    def joint_names(self) -> tuple[str, ...]:
        """The chosen joints, in the order of answers and commands."""
        return self.selection.names

    def compensation(self, values: Mapping[str, Any]) -> Compensation:
        """Return the `Compensation` with the terms that the parameters select."""
        return Compensation(
            self.model,
            None if self.has_all_in_order else self.selection.index,
            values['compensate.gravity'],
            values['compensate.coriolis'],
            values['compensate.friction'],
        )

    def motion_limits(self, velocity_limits: Sequence[float]) -> MotionLimits:
        """
        Return the position and velocity limits of the joints.

        Parameters
        ----------
        velocity_limits : sequence of float
            The parameter, of the chosen joints, rad/s or m/s; empty for those of the URDF.

        Returns
        -------
        MotionLimits

        """
        model = self.model
        allowed = np.array(model.velocity_limits)
        if velocity_limits:
            allowed[self.selection.index] = velocity_limits
        return MotionLimits(
            model.joint_names,
            model.velocity_limits,
            model.position_limits,
            model.is_continuous,
            allowed,
        )

    def measured_position(self, now: float, timeout: float) -> NDArray[np.float64]:
        """
        Return the newest measured positions of all joints.

        Parameters
        ----------
        now : float
            Steady clock, s.
        timeout : float
            Age that is still fresh, s.

        Returns
        -------
        numpy.ndarray, shape (n,)
            rad or m.

        Raises
        ------
        StateUnavailableError
            If a chosen joint is not fresh; the message names it and the remedy.

        """
        stale = self.buffer.stale_joints(now, timeout)
        if stale:
            shared = (
                f'; {self.state_publishers} nodes publish joint_states: if an arm and its '
                'gripper have a broadcaster each, set allow_several_state_publishers at '
                'the start'
                if self.state_publishers > 1
                else ''
            )
            raise StateUnavailableError(
                f'no joint state within {timeout:g} s for {", ".join(stale)}: publish '
                f'joint_states, or give positions in the request{shared}'
            )
        return self.buffer.position

    def beyond_limits(self, index: NDArray[np.intp], positions: NDArray[np.float64]) -> str:
        """
        Describe the positions of a request that are beyond the position limits.

        Parameters
        ----------
        index : numpy.ndarray of int, shape (m,)
            Model indices of the joints in the request.
        positions : numpy.ndarray, shape (m,) or (N, m)
            Of one state or of N, rad or m.

        Returns
        -------
        str
            To append to a message: the furthest position of each such joint, at most
            _MAX_LISTED joints; '' if there is none.

        """
        lower, upper = self.model.position_limits[index].T
        # A position computed to be at the limit may differ by rounding.
        slack = _ROUNDING * np.maximum(1.0, np.abs(positions))
        excess = np.atleast_2d(np.maximum(lower - positions, positions - upper) - slack)
        furthest = np.atleast_2d(positions)[excess.argmax(axis=0), np.arange(len(index))]
        beyond = np.flatnonzero(excess.max(axis=0) > 0.0)
        listed = [
            f'{self.model.joint_names[index[i]]} at {furthest[i]:.6g} (limits {lower[i]:g} '
            f'to {upper[i]:g})'
            for i in beyond[:_MAX_LISTED]
        ]
        more = f' and {len(beyond) - len(listed)} more' if len(beyond) > len(listed) else ''
        return f'; beyond the position limits: {", ".join(listed)}{more}' if listed else ''

    def unseen_others(self, index: NDArray[np.intp], now: float, timeout: float) -> str:
        """
        Describe the joints outside a request that have no fresh position.

        Parameters
        ----------
        index : numpy.ndarray of int, shape (m,)
            Model indices of the joints in the request.
        now : float
            Steady clock, s.
        timeout : float
            Age that is still fresh, s.

        Returns
        -------
        str
            To append to a message; '' if there is none.

        """
        stale = self.stale_others(index, now, timeout)
        return (
            '; taken where last measured, or neutral if never: ' + ', '.join(stale)
            if stale
            else ''
        )

    def stale_others(self, index: NDArray[np.intp], now: float, timeout: float) -> list[str]:
        """Return the names of the joints that `unseen_others` describes."""
        others = np.setdiff1d(np.arange(len(self.model.joint_names)), index)
        return self.buffer.stale_joints(now, timeout, others.tolist())

    def effort_limits(self, given: Sequence[float]) -> NDArray[np.float64]:
        """
        Return the effort limits of the chosen joints.

        Parameters
        ----------
        given : sequence of float
            The parameter `effort_limits`; empty for the URDF's.

        Returns
        -------
        numpy.ndarray, shape (m,)
            N m or N; NaN where neither has a limit.

        """
        return np.array(given) if given else self.model.effort_limits[self.selection.index]

    def over_limits(
        self,
        values: Mapping[str, Any],
        model: RobotModel | None = None,
        before: Mapping[str, Any] | None = None,
    ) -> str:
        """
        Describe the chosen joints that cannot hold the robot at the newest state.

        Parameters
        ----------
        values : mapping of str to Any
            Of the parameters.
        model : RobotModel, optional
            Instead of the one in force.
        before : mapping of str to Any, optional
            Parameters of the model in force: a joint that was over its limit with them, on the
            same side, does not count.

        Returns
        -------
        str
            Joint, gravity torque (scaled and with the offset) and limit each; '' if there is
            none, or no state. A torque that is not finite is above every limit.

        """
        if not self.buffer.is_complete:
            return ''
        G = self._holding_effort(model or self.model, values)
        limits = self.effort_limits(values['effort_limits'])
        is_over = (np.abs(G) > limits) | ~np.isfinite(G)
        if before is not None:
            was = self._holding_effort(self.model, before)
            is_over &= ~((np.abs(was) > limits) & (np.sign(was) == np.sign(G)))
        return '; '.join(
            f'{self.joint_names[i]}: {G[i]:.6g}, limit {limits[i]:.6g}'
            for i in np.flatnonzero(is_over)
        )

    def _holding_effort(self, model: RobotModel, values: Mapping[str, Any]) -> NDArray[np.float64]:
        # As the limiter receives it: G with gain and offset.
        G = model.gravity_torque(self.buffer.position)[self.selection.index]
        return G * (values['effort_scale'] or 1.0) + (values['effort_offset'] or 0.0)

    def unlimited_joints(self, given: Sequence[float]) -> list[str]:
        """
        Return the names of the chosen joints without an effort limit.

        Parameters
        ----------
        given : sequence of float
            The parameter `effort_limits`; empty for the URDF's.

        """
        return [
            name
            for name, limit in zip(self.joint_names, self.effort_limits(given), strict=True)
            if np.isnan(limit)
        ]

    def above_urdf(self, values: Mapping[str, Any]) -> str:
        """
        Describe the limits of the parameters that are above those of the URDF.

        Parameters
        ----------
        values : mapping of str to Any
            Of the parameters.

        Returns
        -------
        str
            Parameter, joint and both numbers each; '' if there is none.

        """
        index = self.selection.index
        limits_of_urdf = {
            'effort_limits': self.model.effort_limits[index],
            'velocity_limits': self.model.velocity_limits[index],
        }
        return '; '.join(
            f'{parameter} of {name}: {given:g}, in the URDF {limit:g}'
            for parameter, limits in limits_of_urdf.items()
            for name, given, limit in zip(
                self.joint_names, values[parameter], limits, strict=False
            )
            if given > limit
        )

    def joints_without_velocity_limit(self, given: Sequence[float] = ()) -> list[str]:
        """
        Return the names of the chosen joints without a velocity limit.

        Parameters
        ----------
        given : sequence of float
            The parameter `velocity_limits`; empty for those of the URDF.

        Returns
        -------
        list of str

        """
        if given:
            return []
        limits = self.model.velocity_limits[self.selection.index]
        return [
            name for name, limit in zip(self.joint_names, limits, strict=True) if np.isnan(limit)
        ]

    def is_mass_matrix_positive_definite(self) -> bool:
        """Return whether D of the chosen joints is positive definite at the newest state."""
        index = self.selection.index
        D = self.model.mass_matrix(self.buffer.position)[np.ix_(index, index)]
        if not np.isfinite(D).all():
            return False
        return bool(np.linalg.eigvalsh(D)[0] > 0.0)
