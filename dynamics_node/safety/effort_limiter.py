"""The one place where an effort becomes a command: scaled, limited, checked last."""

import math

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
    names : tuple of str
        Of the m joints.
    is_saturated : bool
        Whether any joint was clamped by the last call.
    saturations : list of int
        Commands in which each of the m joints was clamped.
    rate_limited : int
        Commands with at least one joint that could not follow within its rate limit.

    """

    def __init__(self, limits, rate_limits, scale, names=()):
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
        names : sequence of str, optional
            Of the m joints, for people.

        """
        # Lists, not arrays: for the few joints of a robot plain numbers are several times as
        # fast as numpy, and every command waits for this.
        self._limits = np.array(limits, dtype=float).tolist()
        self._rate_limits = np.array(rate_limits, dtype=float).tolist()
        self._scale = np.array(scale, dtype=float).tolist()
        m = len(self._limits)
        self.names = tuple(names) or tuple(f'joint {i}' for i in range(m))
        self._last = [0.0] * m
        self._wanted = [0.0] * m
        self.is_saturated = False
        self.saturations = [0] * m
        self.rate_limited = 0

    def saturation(self):
        """Return in words which joints were clamped by the last call: wanted and limit."""
        return '; '.join(f'{name}: {wanted:.6g} limited to {limit:.6g}'
                         for name, wanted, limit in zip(self.names, self._wanted, self._limits,
                                                        strict=True) if abs(wanted) > limit)

    @property
    def last(self):
        """The last command, shape (m,), a copy."""
        return np.array(self._last)

    def describe_last(self):
        """Return the last command in words: a joint and its effort each."""
        return ', '.join(f'{name}: {effort:.6g}' for name, effort in zip(
            self.names, self._last, strict=True))

    def reset(self):
        """Take zero for the last command."""
        self._last = [0.0] * len(self._limits)

    def carry_on_from(self, other):
        """Take over last command and counts from the limiter that this one replaces."""
        self._last = other.last.tolist()
        self.saturations = other.saturations
        self.rate_limited = other.rate_limited

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
        if effort.shape != (len(self._last),):
            raise InvalidEffortError(f'expected {len(self._last)} efforts, got shape '
                                     f'{effort.shape}')
        self.is_saturated = False
        target = []
        for i, (value, scale, limit) in enumerate(zip(
                effort.tolist(), self._scale, self._limits, strict=True)):
            self._wanted[i] = value = value * scale
            if not abs(value) <= limit:
                if abs(value) > limit:
                    self.is_saturated = True
                    self.saturations[i] += 1
                value = _clip(value, -limit, limit)
            target.append(value)
        if ramp != 1.0:
            start = np.broadcast_to(start, effort.shape).tolist()
            target = [ramp * value + (1.0 - ramp) * first for value, first in zip(target, start)]
        return self._step_to(target, dt)

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
        return self._step_to([ramp * value for value in np.asarray(start).tolist()], dt)

    def _step_to(self, target, dt):
        time = max(dt, 0.0)
        command = []
        is_held_back = False
        for value, last, rate, limit in zip(target, self._last, self._rate_limits, self._limits,
                                            strict=True):
            step = rate * time
            if not last - step <= value <= last + step:
                is_held_back = True
                value = _clip(value, last - step, last + step)
            if not abs(value) <= limit:
                # Rounding of last + step must not carry a command over its limit; a limit that
                # was lowered below the last command is approached at the rate limit.
                bound = max(limit, abs(last))
                value = _clip(value, -bound, bound)
            command.append(value)
        if not all(map(math.isfinite, command)):
            raise InvalidEffortError(f'expected finite efforts, got {command}')
        self._last = command
        self.rate_limited += is_held_back
        return np.array(command)


def _clip(value, low, high):
    # Every comparison with NaN is False, so that a NaN in any of the three ends as NaN, which
    # is refused, and never as one of the bounds.
    if low <= value <= high:
        return value
    if value < low <= high:
        return low
    if value > high >= low:
        return high
    return math.nan
