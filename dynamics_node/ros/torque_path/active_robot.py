"""The robot in force: model, chosen joints and measured state, replaced as one."""

import numpy as np

from ..parameters.model_settings import configured
from ...dynamics import Compensation, JointSelection, RobotModel
from ...errors import DynamicsError
from ...model import build_tree
from ...safety import JointStateBuffer, MotionLimits
from ...urdf import read_urdf


def read_robot(source, values):
    """
    Make the robot of a description.

    Parameters
    ----------
    source : str or bytes
        Path or text of the URDF.
    values : dict of str to Any
        Of the parameters: `joints`, and `machine_code`, without which the model never starts a
        compiler.

    Returns
    -------
    ActiveRobot
        Not configured yet.

    Raises
    ------
    DynamicsError
        If the description is refused, or has no joint that can be moved.

    """
    tree = build_tree(read_urdf(source))
    if not tree.joint_names:
        raise DynamicsError('the robot has no joint that can be moved')
    return ActiveRobot(RobotModel(tree, compile=values['machine_code']), values['joints'])


# Maximum number of joints that a message lists as beyond their position limits.
_MOST_SHOWN = 8
_ROUNDING = 1e-9


class StateUnavailableError(DynamicsError):
    """The newest measured state was requested, and it is too old or missing."""


class ActiveRobot:
    """
    One robot as the node uses it.

    Attributes
    ----------
    model : RobotModel
        As the parameters say; replaced when they change.
    selection : JointSelection
        The parameter `joints`.
    buffer : JointStateBuffer
        Measured states of all joints of the model.
    has_all_in_order : bool
        Whether the chosen joints are those of the model in its order, so that nothing has to
        be picked out.
    refused_since : str
        Why a newer description was refused; '' if none was.
    state_publishers : int
        How many nodes publish its joint states; 0 while that is not known.

    """

    def __init__(self, model, joints):
        """
        Create a robot without measured state.

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
        self._asked: tuple | None = None
        self._answer = model
        self.state_publishers = 0
        self.has_all_in_order = self.selection.names == tuple(model.joint_names)

    def configure(self, values, before=None):
        """
        Apply the parameters to the model.

        Parameters
        ----------
        values : dict of str to Any
            Of the parameters.
        before : dict of str to Any, optional
            Those that the model was made with.

        Raises
        ------
        DynamicsError
            See `model_settings.configured`.

        """
        self.model = self.configured(values, before)

    def configured(self, values, before=None):
        """
        Return the model that `configure` would set; the last result is cached.

        Parameters
        ----------
        values, before : dict of str to Any
            See `configure`.

        Returns
        -------
        RobotModel

        Raises
        ------
        DynamicsError
            See `model_settings.configured`.

        """
        question = (self.model, values, before)
        if question != self._asked:
            self._answer = configured(self, values, before)
            self._asked = question
        return self._answer

    @property
    def joint_names(self):
        """The chosen joints, in the order of answers and commands."""
        return self.selection.names

    def compensation(self, values):
        """Return the `Compensation` that the parameters ask for."""
        return Compensation(
            self.model,
            None if self.has_all_in_order else self.selection.index,
            values['compensate.gravity'],
            values['compensate.coriolis'],
            values['compensate.friction'],
        )

    def motion_limits(self, velocity_limits):
        """
        Return the motion limits of the joints.

        Parameters
        ----------
        velocity_limits : sequence of float
            The parameter, of the chosen joints; empty for those of the URDF.

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

    def measured_position(self, now, timeout):
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
            If a chosen joint is not fresh; says which and what to do.

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

    def beyond_limits(self, index, positions):
        """
        Return which positions in a request are beyond the position limits.

        Parameters
        ----------
        index : numpy.ndarray of int, shape (m,)
            Places of the joints in the request.
        positions : numpy.ndarray, shape (m,) or (N, m)
            Of one state or of N, rad or m.

        Returns
        -------
        str
            To append to a message: of each such joint the position furthest beyond, at most
            eight joints; '' if there is none.

        """
        lower, upper = self.model.position_limits[index].T
        # A position that was computed to be at the limit may differ by rounding.
        slack = _ROUNDING * np.maximum(1.0, np.abs(positions))
        excess = np.atleast_2d(np.maximum(lower - positions, positions - upper) - slack)
        furthest = np.atleast_2d(positions)[excess.argmax(axis=0), np.arange(len(index))]
        beyond = np.flatnonzero(excess.max(axis=0) > 0.0)
        shown = [
            f'{self.model.joint_names[index[i]]} at {furthest[i]:.6g} (limits {lower[i]:g} '
            f'to {upper[i]:g})'
            for i in beyond[:_MOST_SHOWN]
        ]
        more = f' and {len(beyond) - len(shown)} more' if len(beyond) > len(shown) else ''
        return f'; beyond the position limits: {", ".join(shown)}{more}' if shown else ''

    def unseen_others(self, index, now, timeout):
        """
        Return which of the other joints have no fresh position.

        Parameters
        ----------
        index : numpy.ndarray of int
            Places of the joints in the request.
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

    def stale_others(self, index, now, timeout):
        """Return the names of the joints in the text of `unseen_others`, a list of str."""
        others = np.setdiff1d(np.arange(len(self.model.joint_names)), index)
        return self.buffer.stale_joints(now, timeout, others.tolist())

    def effort_limits(self, given):
        """
        Return the effort limits of the chosen joints.

        Parameters
        ----------
        given : sequence of float
            The parameter `effort_limits`; empty for the URDF's.

        Returns
        -------
        numpy.ndarray, shape (m,)
            N m or N; NaN where neither states one.

        """
        return np.array(given) if given else self.model.effort_limits[self.selection.index]

    def over_limits(self, values, model=None, before=None):
        """
        Return which chosen joints cannot hold the robot still at the newest state.

        Parameters
        ----------
        values : dict of str to Any
            Of the parameters.
        model : RobotModel, optional
            Instead of the one in force.
        before : dict of str to Any, optional
            Parameters of the model in force: a joint that stays at its limit, on the same side,
            does not count.

        Returns
        -------
        str
            Joint, gravity torque and limit each; '' if there is none, or no state. A torque
            that is no number counts as one above every limit.

        """
        if not self.buffer.is_complete:
            return ''
        G = self._scaled_gravity_torque(model or self.model, values)
        limits = self.effort_limits(values['effort_limits'])
        is_over = (np.abs(G) > limits) | ~np.isfinite(G)
        if before is not None:
            was = self._scaled_gravity_torque(self.model, before)
            is_over &= ~((np.abs(was) > limits) & (np.sign(was) == np.sign(G)))
        return '; '.join(
            f'{self.joint_names[i]}: {G[i]:.6g}, limit {limits[i]:.6g}'
            for i in np.flatnonzero(is_over)
        )

    def _scaled_gravity_torque(self, model, values):
        G = model.gravity_torque(self.buffer.position)[self.selection.index]
        return G * (values['effort_scale'] or 1.0)

    def unlimited_joints(self, given):
        """Return the names of the chosen joints that have no effort limit, a list of str."""
        return [
            name
            for name, limit in zip(self.joint_names, self.effort_limits(given), strict=True)
            if np.isnan(limit)
        ]

    def above_urdf(self, values):
        """
        Return which limits of the parameters are above those of the URDF.

        Parameters
        ----------
        values : dict of str to Any
            Of the parameters.

        Returns
        -------
        str
            Parameter, joint and both numbers each; '' if there is none.

        """
        index = self.selection.index
        stated = {
            'effort_limits': self.model.effort_limits[index],
            'velocity_limits': self.model.velocity_limits[index],
        }
        return '; '.join(
            f'{parameter} of {name}: {given:g}, in the URDF {limit:g}'
            for parameter, limits in stated.items()
            for name, given, limit in zip(
                self.joint_names, values[parameter], limits, strict=False
            )
            if given > limit
        )

    def joints_without_velocity_limit(self, given=()):
        """
        Return the names of the chosen joints whose speed has no limit.

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

    def is_mass_matrix_positive_definite(self):
        """Tell whether D of the chosen joints is positive definite at the newest state."""
        index = self.selection.index
        D = self.model.mass_matrix(self.buffer.position)[np.ix_(index, index)]
        if not np.isfinite(D).all():
            return False
        return bool(np.linalg.eigvalsh(D)[0] > 0.0)
