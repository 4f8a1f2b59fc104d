"""The joint states of a run, and its phases."""

from dataclasses import dataclass

import numpy as np
from sensor_msgs.msg import JointState


@dataclass
class Phase:
    """A named interval, in s since the first joint state."""

    name: str
    start: float
    end: float


class Recording:
    """
    Joint states in the order of `names`, by the time of their stamps.

    `turning` marks the revolute joints: displacements are judged on those, in degrees.

    """

    def __init__(self, names: list[str], turning: list[bool]) -> None:
        """Record the joints `names`; messages may contain others, in any order."""
        self.names = names
        self.turning = np.array(turning)
        self.phases: list[Phase] = []
        self._rows: list[int] | None = None
        self._messages: list[JointState] = []

    def __len__(self) -> int:
        """Return the number of joint states."""
        return len(self._messages)

    def add(self, message: JointState) -> None:
        """Add a joint state."""
        if self._rows is None:
            self._rows = [message.name.index(name) for name in self.names]
        self._messages.append(message)

    @property
    def now(self) -> float:
        """Return the time of the newest state [s]."""
        return self._time(self._messages[-1])

    @property
    def position(self) -> np.ndarray:
        """Return the newest position, shape (n,) [rad or m]."""
        return np.array(self._messages[-1].position)[self._rows]

    @property
    def speed(self) -> float:
        """Return the largest newest joint speed [rad/s or m/s]."""
        return float(np.max(np.abs(np.array(self._messages[-1].velocity)[self._rows])))

    def times(self) -> np.ndarray:
        """Return the time of every state, shape (k,) [s]."""
        return np.array([self._time(message) for message in self._messages])

    def positions(self) -> np.ndarray:
        """Return every position, shape (k, n) [rad or m]."""
        return np.array([message.position for message in self._messages])[:, self._rows]

    def efforts(self) -> np.ndarray:
        """Return every effort, shape (k, n) [N m or N]."""
        return np.array([message.effort for message in self._messages])[:, self._rows]

    def displacement(self, reference: np.ndarray, start: float, end: float) -> np.ndarray:
        """
        Return the largest displacement of each joint from a reference within an interval.

        Shape (n,), in degrees for a revolute joint and in mm for a prismatic one.

        """
        times = self.times()
        part = self.positions()[(times >= start) & (times <= end)]
        return np.max(np.abs(self.natural(part - reference)), axis=0, initial=0.0)

    def natural(self, way: np.ndarray) -> np.ndarray:
        """Return displacements (..., n) in degrees and mm instead of rad and m."""
        return way * np.where(self.turning, np.degrees(1.0), 1000.0)

    def _time(self, message: JointState) -> float:
        """Return a message's time since the first one [s]."""
        first, stamp = self._messages[0].header.stamp, message.header.stamp
        return stamp.sec - first.sec + (stamp.nanosec - first.nanosec) * 1e-9
