"""A recording of joint states: checked columns, whatever file they came from."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Recording:
    """
    Joint states over time, cleaned: times increase strictly and positions are finite.

    Attributes
    ----------
    source : str
        Path of the file or folder, for messages.
    joint_names : tuple of str
        The n joints of the columns below.
    time : numpy.ndarray, shape (S,)
        s since the first sample, strictly increasing.
    position : numpy.ndarray, shape (S, n)
        rad or m.
    velocity, effort : numpy.ndarray, shape (S, n)
        rad/s or m/s, and whatever the driver calls effort; NaN where the recording has none.
    segments : tuple of slice
        Parts of the samples without a gap between them, in order.
    description : str or None
        Text of the URDF, if the recording contains one.
    notes : tuple of str
        What was mapped, dropped or split, one sentence each with its count.

    """

    source: str
    joint_names: tuple[str, ...]
    time: Array
    position: Array
    velocity: Array
    effort: Array
    segments: tuple[slice, ...]
    description: str | None = None
    notes: tuple[str, ...] = ()

    @property
    def rate(self) -> float:
        """Median rate of the samples, Hz."""
        return float(1.0 / np.median(np.diff(self.time)))

    @property
    def duration(self) -> float:
        """Time that the segments cover, s."""
        return float(
            sum(self.time[part.stop - 1] - self.time[part.start] for part in self.segments)
        )
