"""Checks of an arm's driver: own gravity compensation, and efforts that are no torques."""

from collections.abc import Iterable, Sequence
import re

import numpy as np
from numpy.typing import ArrayLike, NDArray

# Package of the ros2_control hardware plugin → arm. docs/arms.md has the sources.
SELF_COMPENSATING = {
    'franka_gz_ros2_control': 'a simulated Franka arm',
    'franka_hardware': 'a Franka arm',
    'franka_ign_ros2_control': 'a simulated Franka arm',
    'iiwa_hardware': 'a KUKA LBR iiwa',
    'kuka_sunrise_fri_driver': 'a KUKA LBR iiwa',
    'lbr_ros2_control': 'a KUKA LBR iiwa',
    'trossen_arm_hardware': 'a Trossen arm',
    'ur_robot_driver': 'a Universal Robots arm',
    'ur_robot_driver_cb2': 'a Universal Robots arm',
}
# Largest velocity of an arm at rest, rad/s or m/s: noise of the sensors.
AT_REST = 0.02
# Duration of a rest before it is judged, s: a person seldom leans on an arm for so long without
# moving it.
REST = 2.0
# Largest plausible difference between effort and gravity torque, relative to the larger one.
# Unknown payloads and contacts stay below it; motor currents, zeros and efforts without gravity
# do not.
LIKELY = 0.5
# Smallest gravity torque that is judged, relative to the effort limit.
SMALL_PART = 0.03
# The same for a joint without effort limit, N m or N.
SMALL = 0.1


def self_compensating(plugins: Iterable[str]) -> list[str]:
    """
    Return the hardware plugins of arms that compensate gravity themselves.

    Parameters
    ----------
    plugins : iterable of str
        As in the URDF: 'package/Class' or 'package::Class'.

    Returns
    -------
    list of str
        'plugin (arm)' each; empty if there is none.

    """
    return [
        f'{plugin} ({SELF_COMPENSATING[package]})'
        for plugin in plugins
        if (package := re.split('/|::', plugin, maxsplit=1)[0]) in SELF_COMPENSATING
    ]


class EffortPlausibility:
    """
    Compares the measured efforts of an arm at rest with the gravity torque.

    Attributes
    ----------
    names : tuple of str
        Names of the m joints.
    warning : str
        Why the efforts are probably no torques, with both numbers; '' if they are plausible or
        not yet judged.

    """

    def __init__(self, names: Sequence[str], limits: ArrayLike) -> None:
        """
        Start without a judgment.

        Parameters
        ----------
        names : sequence of str
            Names of the m joints.
        limits : array_like, shape (m,)
            Effort limits, N m or N; NaN for a joint without limit.

        """
        self.names = tuple(names)
        limits = np.asarray(limits, dtype=float)
        self._small = np.where(np.isfinite(limits), SMALL_PART * limits, SMALL)
        self.warning = ''
        self.forget()

    def forget(self) -> None:
        """Begin a new rest; `warning` stays."""
        self._begin: float | None = None
        self._count = 0
        self._sums = np.zeros((2, len(self.names)))

    def update(
        self,
        time: float,
        velocity: NDArray[np.float64],
        effort: NDArray[np.float64],
        gravity_torque: NDArray[np.float64],
    ) -> bool:
        """
        Add a state.

        Parameters
        ----------
        time : float
            s.
        velocity : numpy.ndarray, shape (m,)
            Measured, rad/s or m/s; finite.
        effort : numpy.ndarray, shape (m,)
            Measured, N m or N; finite.
        gravity_torque : numpy.ndarray, shape (m,)
            G of the model, N m or N; finite.

        Returns
        -------
        bool
            Whether this state ends a rest and `warning` is up to date.

        """
        if np.abs(velocity).max() > AT_REST:
            self.forget()
            return False
        if self._begin is None:
            self._begin = time
        self._sums += effort, gravity_torque
        self._count += 1
        if time - self._begin < REST:
            return False
        measured, expected = self._sums / self._count + 0.0  # + 0.0 turns -0.0 into 0.0
        self.forget()
        return self._judge(measured, expected)

    def _judge(self, measured: NDArray[np.float64], expected: NDArray[np.float64]) -> bool:
        # The joint with the largest gravity torque shows a difference best.
        joint = int(np.argmax(np.abs(expected) / self._small))
        effort, torque = measured[joint], expected[joint]
        if abs(torque) < self._small[joint]:
            return False
        is_likely = abs(effort - torque) <= LIKELY * max(abs(effort), abs(torque))
        self.warning = (
            ''
            if is_likely
            else (
                f'{self.names[joint]} reports {effort:.4g} at rest, where the model says that '
                f'{torque:.4g} holds it'
            )
        )
        return True
