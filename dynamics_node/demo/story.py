"""The sequence of the demo: fall, hold, push, hold; and its measurements."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

import numpy as np

from .client import Client
from .processes import DemoError
from .recording import Phase, Recording

FALL_TIME = 1.0  # [s] on the clock of the stamps, as all durations here
WATCH_TIME = 3.0
AT_REST = np.radians(0.2)  # [rad/s, for a prismatic joint m/s]
REST_TIME = 0.2  # [s] below that speed
REST_TIMEOUT = 20.0  # [s]
TRAVEL_TIMEOUT = 30.0  # [s]

MIN_FALL, MAX_DRIFT, MIN_PUSH = 20.0, 1.0, 3.0  # [deg]


@dataclass
class Outcome:
    """
    The measurements: displacements per joint in degrees (prismatic: mm), poses in rad and m.

    `fall` and the two drifts are the largest displacements within an interval, `pushed` is the
    displacement from rest to rest. `poses` are drawn as stick figures; `hold` [s] is the duration
    of `drift`.

    """

    recording: Recording
    hold: float = 10.0
    fall: np.ndarray = field(default_factory=lambda: np.zeros(0))
    drift: np.ndarray = field(default_factory=lambda: np.zeros(0))
    pushed: np.ndarray = field(default_factory=lambda: np.zeros(0))
    drift_after_push: np.ndarray = field(default_factory=lambda: np.zeros(0))
    push: str = ''
    poses: dict[str, np.ndarray] = field(default_factory=dict)

    def largest(self, displacement: np.ndarray) -> float:
        """Return the largest displacement of a revolute joint [deg]."""
        return float(np.max(displacement[self.recording.turning], initial=0.0))

    def failures(self) -> list[str]:
        """Return one sentence per failed expectation."""
        fall, pushed = self.largest(self.fall), self.largest(self.pushed)
        drifts = {'held': self.drift, 'held after the push': self.drift_after_push}
        failures = [
            f'{when}, it drifted {self.largest(drift):.2f} degrees; '
            f'expected less than {MAX_DRIFT:.0f}'
            for when, drift in drifts.items()
            if not self.largest(drift) < MAX_DRIFT
        ]
        if not fall > MIN_FALL:
            failures.insert(
                0,
                f'released without the node, it fell {fall:.1f} degrees; expected '
                f'more than {MIN_FALL:.0f}',
            )
        if not pushed > MIN_PUSH:
            failures.append(
                f'the push moved it {pushed:.1f} degrees; expected more than {MIN_PUSH:.0f}'
            )
        return failures


class Story:
    """Runs the sequence with a running robot and a running node."""

    def __init__(self, client: Client, hold: float, say: Callable[[str], None]) -> None:
        """Hold the arm for `hold` seconds before the push; `say` prints a line."""
        self._client = client
        self._recording = client.recording
        self._say = say
        self.outcome = Outcome(client.recording, hold)

    def run(self) -> Outcome:
        """Run all phases and return the measurements."""
        self.outcome.poses['start'] = self._recording.position
        self._fall()
        self._return_to_start()
        self._enable()
        self._hold()
        self._push()
        self._watch()
        self._disable()
        return self.outcome

    def _fall(self) -> None:
        """Release the brakes for a second while the output is off."""
        start = self._recording.position
        self._client.set_brakes(False)
        with self._phase('falls, node off') as phase:
            self._client.spin_for(FALL_TIME)
        self._client.set_brakes(True)
        self.outcome.fall = self._recording.displacement(start, phase.start, phase.end)
        self.outcome.poses['after the fall'] = self._recording.position
        self._print(
            'output off, brakes released', 'fell', self.outcome.fall, f'in {FALL_TIME:.0f} s'
        )

    def _return_to_start(self) -> None:
        """Move the robot back to its start pose."""
        goal = self.outcome.poses['start']
        with self._phase('back to the start'):
            self._client.reset()
            self._client.wait_for(
                lambda: bool(np.allclose(self._recording.position, goal, atol=1e-6)),
                TRAVEL_TIMEOUT,
                'the robot to be back at its start pose',
            )

    def _enable(self) -> None:
        """Turn the output on while the brakes are engaged."""
        with self._phase('ramps up'):
            self._client.enable(True)
            self._client.wait_for_state('ACTIVE', 5.0)

    def _hold(self) -> None:
        """Release the brakes while the output is on."""
        start = self._recording.position
        self._client.set_brakes(False)
        with self._phase('held by the node') as phase:
            self._client.spin_for(self.outcome.hold)
        self.outcome.drift = self._recording.displacement(start, phase.start, phase.end)
        self.outcome.poses['held'] = self._recording.position
        self._print(
            'output on, brakes released',
            'drifted',
            self.outcome.drift,
            f'in {self.outcome.hold:.0f} s',
        )

    def _push(self) -> None:
        """Push the arm, and wait until friction has stopped it."""
        start = self._recording.position
        with self._phase('pushed') as phase:
            self.outcome.push = self._client.push()
            self._client.spin_for(0.5)
            self._client.wait_for(self._rested(), REST_TIMEOUT, 'the pushed arm to come to rest')
        self.outcome.pushed = np.abs(self._recording.natural(self._recording.position - start))
        self._print(
            self.outcome.push,
            'moved',
            self.outcome.pushed,
            f'and came to rest after {phase.end - phase.start:.1f} s',
        )

    def _watch(self) -> None:
        """Measure the drift at the pose after the push."""
        start = self._recording.position
        with self._phase('held there') as phase:
            self._client.spin_for(WATCH_TIME)
        self.outcome.drift_after_push = self._recording.displacement(start, phase.start, phase.end)
        self.outcome.poses['after the push'] = self._recording.position
        self._print(
            'left alone there', 'drifted', self.outcome.drift_after_push, f'in {WATCH_TIME:.0f} s'
        )

    def _disable(self) -> None:
        """Engage the brakes, then turn the output off."""
        with self._phase('ramps down'):
            self._client.set_brakes(True)
            self._client.enable(False)
            self._client.wait_for_state('READY', 5.0)

    def _rested(self) -> Callable[[], bool]:
        """Return a condition: slower than AT_REST for REST_TIME."""
        since = self._recording.now

        def rested() -> bool:
            nonlocal since
            if self._recording.speed > AT_REST:
                since = self._recording.now
            self._fail_on_fault()
            return self._recording.now - since > REST_TIME

        return rested

    def _fail_on_fault(self) -> None:
        """Raise if the node has stopped its output."""
        state = self._client.state
        if state is not None and state.name == 'FAULT':
            raise DemoError(f'the node reports FAULT: {state.reason}')

    @contextmanager
    def _phase(self, name: str) -> Iterator[Phase]:
        """Add a phase to the recording."""
        now = self._recording.now
        phase = Phase(name, now, now)
        self._recording.phases.append(phase)
        yield phase
        phase.end = self._recording.now

    def _print(self, when: str, verb: str, displacement: np.ndarray, rest: str) -> None:
        """Print one line of results."""
        self._say(f'{when}: {verb} {self.outcome.largest(displacement):.2f} degrees {rest}')
