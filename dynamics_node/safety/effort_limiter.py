"""The one place where an effort becomes a command: scaled, limited, checked last."""

import math

import numpy as np

from ..errors import DynamicsError

# Part of the effort limit that makes no difference to an arm.
NEGLIGIBLE = 0.01


class InvalidEffortError(DynamicsError):
    """An effort is not finite or does not have one value per joint: it is never published."""


class EffortLimiter:
    """
    Turns model efforts into commands that are safe to publish.

    In this order: scale by the joint's gain and clamp to the effort limit (`target`); then, after
    the caller has applied its ramp, limit the step since the last command, clamp once more, and
    check last that every value is finite (`step`). The ramp comes before the rate limit, so that
    the rate limit holds for what is really published.

    Attributes
    ----------
    names : tuple of str
        Of the m joints.
    is_saturated : bool
        Whether any joint was clamped by the last `target`.
    is_held_back : bool
        Whether any joint could not reach its target within the last `step`.
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
        self._last = self._before = [0.0] * m
        self._wanted = [0.0] * m
        self.is_saturated = self.is_held_back = False
        self.saturations = [0] * m
        self.rate_limited = 0

    def saturation(self):
        """Return in words which joints were clamped by the last call: wanted and limit."""
        return '; '.join(
            f'{name}: {wanted:.6g} limited to {limit:.6g}'
            for name, wanted, limit in zip(self.names, self._wanted, self._limits, strict=True)
            if abs(wanted) > limit
        )

    @property
    def last(self):
        """The last command, shape (m,), a copy."""
        return np.array(self._last)

    def describe_last(self):
        """Return the last command in words: a joint and its effort each."""
        return ', '.join(
            f'{name}: {effort:.6g}' for name, effort in zip(self.names, self._last, strict=True)
        )

    def reset(self):
        """Take zero for the last command."""
        self._last = self._before = [0.0] * len(self._limits)

    def resume(self, efforts):
        """Take efforts that are in force, shape (m,), N m or N, for the last command."""
        self._last = self._before = np.array(efforts, dtype=float).tolist()

    def carry_on_from(self, other):
        """Take over last command and counts from the limiter that this one replaces."""
        self._last = self._before = other.last.tolist()
        self.saturations = other.saturations
        self.rate_limited = other.rate_limited

    def target(self, effort):
        """
        Return where a model effort wants the command to be: scaled and clamped.

        Parameters
        ----------
        effort : numpy.ndarray, shape (m,)
            N m or N.

        Returns
        -------
        list of float
            m values within the effort limits; NaN where the effort is NaN.

        Raises
        ------
        InvalidEffortError
            If the effort has another length.

        """
        if effort.shape != (len(self._last),):
            raise InvalidEffortError(
                f'expected {len(self._last)} efforts, got shape {effort.shape}'
            )
        self.is_saturated = False
        target = []
        for i, (value, scale, limit) in enumerate(
            zip(effort.tolist(), self._scale, self._limits, strict=True)
        ):
            self._wanted[i] = value = value * scale
            if not abs(value) <= limit:
                if abs(value) > limit:
                    self.is_saturated = True
                    self.saturations[i] += 1
                value = _clip(value, -limit, limit)
            target.append(value)
        return target

    def step(self, target, dt, least_steps=None):
        """
        Return the next command on the way to a target.

        Parameters
        ----------
        target : sequence of float
            m values, N m or N.
        dt : float
            Time that the step may count, s.
        least_steps : sequence of float, optional
            Steps that are allowed whatever the rate limits say, N m or N: a stop has to end.

        Returns
        -------
        numpy.ndarray, shape (m,)
            Finite, at most one step from the last command, and within the limits, or on the way
            there if the last command was beyond them.

        Raises
        ------
        InvalidEffortError
            If a value is not finite; the last command stays what it was.

        """
        time = max(dt, 0.0)
        least = least_steps or [0.0] * len(self._last)
        command = []
        is_held_back = False
        for value, last, rate, limit, at_least in zip(
            target, self._last, self._rate_limits, self._limits, least, strict=True
        ):
            step = max(rate * time, at_least)
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
        self._before, self._last = self._last, command
        self.is_held_back = is_held_back
        self.rate_limited += is_held_back
        return np.array(command)

    def is_negligible(self, efforts):
        """Tell whether m efforts are within NEGLIGIBLE of the limits."""
        return all(
            abs(effort) <= NEGLIGIBLE * limit
            for effort, limit in zip(efforts.tolist(), self._limits, strict=True)
        )

    def withdraw(self):
        """Take the last command back, because it was not published."""
        self._last = self._before


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
