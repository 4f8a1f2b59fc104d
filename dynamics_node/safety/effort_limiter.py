"""From an effort to a command: scaled, offset, limited, and checked at the end."""

from collections.abc import Sequence
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import InvalidEffortError

# Effort without a noticeable effect on an arm, relative to the effort limit.
NEGLIGIBLE = 0.01


class EffortLimiter:
    """
    Turns model efforts into commands that are safe to publish.

    `target` scales an effort by the joint's gain, adds the joint's offset and clamps the sum to
    the effort limit. The caller applies its ramps. `step` then limits the change since the last
    command, clamps once more, and finally checks that every value is finite. The ramps come before
    the rate limit, so that the rate limit holds for the published commands.

    Attributes
    ----------
    names : tuple of str
        Names of the m joints.
    is_saturated : bool
        Whether the last `target` clamped any joint.
    is_held_back : bool
        Whether the last `step` ended before the target for any joint.
    saturations : list of int
        Number of commands in which each of the m joints was clamped.
    rate_limited : int
        Number of commands with at least one joint at its rate limit.

    """

    def __init__(
        self,
        limits: ArrayLike,
        rate_limits: ArrayLike,
        scale: ArrayLike,
        names: Sequence[str] = (),
        offset: ArrayLike | None = None,
    ) -> None:
        """
        Start with a last command of zero.

        Parameters
        ----------
        limits : array_like, shape (m,)
            Largest effort, N m or N, > 0.
        rate_limits : array_like, shape (m,)
            Largest change of effort, N m/s or N/s, > 0.
        scale : array_like, shape (m,)
            Gain on the model's effort.
        names : sequence of str, optional
            Names of the m joints, for messages.
        offset : array_like, shape (m,), optional
            Bias that is added to the scaled effort, N m or N; by default zero.

        """
        # Lists instead of arrays: for the few joints of a robot, plain numbers are several times
        # faster than numpy, and every command waits for this.
        self._limits: list[float] = np.array(limits, dtype=float).tolist()
        self._rate_limits: list[float] = np.array(rate_limits, dtype=float).tolist()
        self._scale: list[float] = np.array(scale, dtype=float).tolist()
        m = len(self._limits)
        self._offset: list[float] = (
            [0.0] * m if offset is None else np.array(offset, dtype=float).tolist()
        )
        self.names = tuple(names) or tuple(f'joint {i}' for i in range(m))
        self._last: list[float] = [0.0] * m
        self._before = self._last
        self._wanted = [0.0] * m
        self.is_saturated = self.is_held_back = False
        self.saturations = [0] * m
        self.rate_limited = 0

    def saturation(self) -> str:
        """Return the joints that the last `target` clamped, as text: wanted effort and limit."""
        return '; '.join(
            f'{name}: {wanted:.6g} limited to {limit:.6g}'
            for name, wanted, limit in zip(self.names, self._wanted, self._limits, strict=True)
            if abs(wanted) > limit
        )

    @property
    def last(self) -> NDArray[np.float64]:
        """The last command, N m or N; shape (m,), a copy."""
        return np.array(self._last)

    def describe_last(self) -> str:
        """Return the last command as text: each joint and its effort."""
        return ', '.join(
            f'{name}: {effort:.6g}' for name, effort in zip(self.names, self._last, strict=True)
        )

    def reset(self) -> None:
        """Set the last command to zero."""
        self._last = self._before = [0.0] * len(self._limits)

    def resume(self, efforts: ArrayLike) -> None:
        """Set the last command to the efforts in force, shape (m,), N m or N."""
        self._last = self._before = np.array(efforts, dtype=float).tolist()

    def carry_on_from(self, other: 'EffortLimiter') -> None:
        """Copy last command and counts from the limiter that this one replaces."""
        self._last = self._before = other.last.tolist()
        self.saturations = other.saturations
        self.rate_limited = other.rate_limited

    def target(self, effort: NDArray[np.float64]) -> list[float]:
        """
        Return a model effort scaled, with the offset, and clamped.

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
        for i, (value, scale, offset, limit) in enumerate(
            zip(effort.tolist(), self._scale, self._offset, self._limits, strict=True)
        ):
            self._wanted[i] = value = value * scale + offset
            if not abs(value) <= limit:
                if abs(value) > limit:
                    self.is_saturated = True
                    self.saturations[i] += 1
                value = _clip(value, -limit, limit)
            target.append(value)
        return target

    def step(
        self, target: Sequence[float], dt: float, least_steps: Sequence[float] | None = None
    ) -> NDArray[np.float64]:
        """
        Return the next command on the way to a target.

        Parameters
        ----------
        target : sequence of float
            m values, N m or N.
        dt : float
            Time of the step for the rate limits, s.
        least_steps : sequence of float, optional
            Steps that are allowed beyond the rate limits, N m or N: a stop has to end.

        Returns
        -------
        numpy.ndarray, shape (m,)
            N m or N; finite, at most one step from the last command, and within the limits, or
            on the way there if the last command was beyond them.

        Raises
        ------
        InvalidEffortError
            If a value is not finite; the last command is then unchanged.

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
                # Rounding of last + step must not exceed the limit; a limit lowered below the
                # last command is approached at the rate limit.
                bound = max(limit, abs(last))
                value = _clip(value, -bound, bound)
            command.append(value)
        if not all(map(math.isfinite, command)):
            raise InvalidEffortError(f'expected finite efforts, got {command}')
        self._before, self._last = self._last, command
        self.is_held_back = is_held_back
        self.rate_limited += is_held_back
        return np.array(command)

    def is_negligible(self, efforts: NDArray[np.float64]) -> bool:
        """Tell whether m efforts, N m or N, are within NEGLIGIBLE of the limits."""
        return all(
            abs(effort) <= NEGLIGIBLE * limit
            for effort, limit in zip(efforts.tolist(), self._limits, strict=True)
        )

    def withdraw(self) -> None:
        """Undo the last command, because it was not published."""
        self._last = self._before


def _clip(value: float, low: float, high: float) -> float:
    # Comparisons with NaN are False: a NaN in any argument gives NaN, which is refused, and
    # never a bound.
    if low <= value <= high:
        return value
    if value < low <= high:
        return low
    if value > high >= low:
        return high
    return math.nan
