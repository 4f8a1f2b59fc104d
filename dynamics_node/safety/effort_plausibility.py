"""Whether the measured effort of an arm at rest can be a torque."""

import numpy as np

# Slower than this is at rest, rad/s or m/s: sensors' noise, not motion.
AT_REST = 0.02
# A hand or a tool seldom leans on an arm so long without moving it, s.
REST = 2.0
# Effort and gravity torque may differ by this part of the larger one. Payloads that nobody told
# of and contacts stay below it; motor currents, zeros and efforts without gravity do not.
LIKELY = 0.5
# Nothing can be said where the arm hardly weighs on its joints: part of the effort limit, or
# N m and N for a joint that has none.
SMALL_PART, SMALL = 0.03, 0.1


class EffortAtRest:
    """
    Compares measured efforts with the gravity torque while the arm stands still.

    Attributes
    ----------
    names : tuple of str
        Of the m joints.
    doubt : str
        Why the efforts can hardly be torques, with both numbers; '' if nothing is wrong, or
        nothing has been found out yet.

    """

    def __init__(self, names, limits):
        """
        Know nothing yet.

        Parameters
        ----------
        names : sequence of str
            Of m joints.
        limits : array_like, shape (m,)
            Effort limits, N m or N; NaN where there is none.

        """
        self.names = tuple(names)
        limits = np.asarray(limits, dtype=float)
        self._small = np.where(np.isfinite(limits), SMALL_PART * limits, SMALL)
        self.doubt = ''
        self.forget()

    def forget(self):
        """Begin to watch anew; what was found out stays."""
        self._begin = None

    def update(self, time, velocity, effort, gravity_torque):
        """
        Take a state.

        Parameters
        ----------
        time : float
            s.
        velocity, effort, gravity_torque : numpy.ndarray, shape (m,)
            Measured velocity (rad/s or m/s) and effort, and the model's G, N m or N; finite.

        Returns
        -------
        bool
            Whether a judgment has just been made; see `doubt`.

        """
        if np.abs(velocity).max() > AT_REST:
            self.forget()
            return False
        if self._begin is None:
            self._begin, self._count = time, 0
            self._sums = np.zeros((2, len(self.names)))
        self._sums += effort, gravity_torque
        self._count += 1
        if time - self._begin < REST:
            return False
        measured, expected = self._sums / self._count + 0.0  # which makes no zero negative
        self.forget()
        return self._judge(measured, expected)

    def _judge(self, measured, expected):
        # The joint that carries most says it best.
        joint = int(np.argmax(np.abs(expected) / self._small))
        effort, torque = measured[joint], expected[joint]
        if abs(torque) < self._small[joint]:
            return False
        is_likely = abs(effort - torque) <= LIKELY * max(abs(effort), abs(torque))
        self.doubt = (
            ''
            if is_likely
            else (
                f'{self.names[joint]} reports {effort:.4g} at rest, where the model says that '
                f'{torque:.4g} holds it'
            )
        )
        return True
