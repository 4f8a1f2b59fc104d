"""The one place where an effort becomes a command: scaled, limited, checked last."""

import numpy as np

from ..errors import DynamicsError


class InvalidEffortError(DynamicsError):
    """An effort is not finite or does not have one value per joint: it is never published."""


class EffortLimiter:
    """
    Turns model efforts into commands that are safe to publish.

    In this order: scale by the joint's gain, clamp to the effort limit, blend in by the ramp,
    limit the step since the last command, and check last that every value is finite. The ramp
    comes before the rate limit, so that the rate limit holds for what is really published.

    Attributes
    ----------
    saturated : numpy.ndarray of bool, shape (m,)
        Which joints were clamped by the last call.
    saturations : int
        Commands with at least one clamped joint.

    """

    def __init__(self, limits, rate_limits, scale):
        """
        Make a limiter whose last command is zero.

        Parameters
        ----------
        limits : numpy.ndarray, shape (m,)
            Largest effort, N m or N, > 0.
        rate_limits : numpy.ndarray, shape (m,)
            Largest change of effort, N m/s or N/s, > 0.
        scale : numpy.ndarray, shape (m,)
            Gain on the model's effort.

        """
        self._limits = np.array(limits, dtype=float)
        self._rate_limits = np.array(rate_limits, dtype=float)
        self._scale = np.array(scale, dtype=float)
        self._last = np.zeros(self._limits.size)
        self.saturated = np.zeros(self._limits.size, dtype=bool)
        self.saturations = 0

    @property
    def last(self):
        """The last command, shape (m,), a copy."""
        return self._last.copy()

    def reset(self):
        """Take zero for the last command."""
        self._last[:] = 0.0

    def carry_on_from(self, other):
        """Take over last command and count from the limiter that this one replaces."""
        self._last[:] = other.last
        self.saturations = other.saturations

    def command(self, effort, ramp, dt, start=0.0):
        """
        Return the command for a model effort.

        Parameters
        ----------
        effort : numpy.ndarray, shape (m,)
            N m or N.
        ramp : float
            Factor from 0 to 1.
        dt : float
            Time since the last command, s.
        start : numpy.ndarray, shape (m,), or 0
            The command at ramp 0, N m or N.

        Returns
        -------
        numpy.ndarray, shape (m,)
            Finite, one step from the last command, and within the limits, or on the way there
            if the last command was beyond them.

        Raises
        ------
        InvalidEffortError
            If the effort has another length or a value that is not finite.

        """
        effort = np.asarray(effort, dtype=float)
        if effort.shape != self._last.shape:
            raise InvalidEffortError(f'expected {self._last.size} efforts, got shape '
                                     f'{effort.shape}')
        with np.errstate(all='ignore'):  # an overflow is clamped below, a NaN refused at the end
            scaled = effort * self._scale
        self.saturated = np.abs(scaled) > self._limits
        self.saturations += bool(self.saturated.any())
        clamped = np.clip(scaled, -self._limits, self._limits)
        return self._step_to(ramp * clamped + (1.0 - ramp) * start, dt)

    def fade(self, start, ramp, dt):
        """
        Return the command on the way from an earlier command to zero.

        Parameters
        ----------
        start : numpy.ndarray, shape (m,)
            The command that was in force when the stop began, N m or N.
        ramp : float
            Factor from 1 to 0.
        dt : float
            Time since the last command, s.

        Returns
        -------
        numpy.ndarray, shape (m,)

        """
        return self._step_to(ramp * start, dt)

    def _step_to(self, target, dt):
        step = self._rate_limits * max(dt, 0.0)
        command = np.clip(target, self._last - step, self._last + step)
        # Rounding of last + step must not carry a command over its limit; a limit that was
        # lowered below the last command is approached at the rate limit.
        bound = np.maximum(self._limits, np.abs(self._last))
        command = np.clip(command, -bound, bound)
        if not np.isfinite(command).all():
            raise InvalidEffortError(f'expected finite efforts, got {command.tolist()}')
        self._last[:] = command
        return command
