"""The main loop: efforts in force and exit code after failures and signals."""

import time
from types import SimpleNamespace

from dynamics_node.ros import main
from dynamics_node.safety import (
    EffortLimiter,
    JointStateBuffer,
    MotionLimits,
    OutputSettings,
    TorquePath,
)
import numpy as np
import pytest

EFFORT = np.array([5.0])


class Output:
    """A command output that records its commands."""

    def __init__(self, stop_ramp=0.2):
        settings = OutputSettings(100.0, 0.0, stop_ramp, 'ramp_to_zero')
        self.path = TorquePath(settings)
        self.path.use(JointStateBuffer(('a',), ('a',), np.zeros(1)))
        model = SimpleNamespace(torques=lambda q, qd: (EFFORT, EFFORT), needs_velocity=False)
        self.path.configure(
            time.monotonic(),
            settings,
            model,
            EffortLimiter(np.array([10.0]), np.array([1e6]), np.ones(1), ('a',)),
            MotionLimits.none(('a',)),
        )
        self.sent = []
        self.is_broken = False

    def drive(self):
        """Send the whole effort."""
        self.path.enable(time.monotonic())
        self.send(self.path.process_joint_state(time.monotonic(), ['a'], [0.0], (), 0, 1))
        while not np.array_equal(self.sent[-1], EFFORT):
            time.sleep(0.001)
            self.send(self.path.process_joint_state(time.monotonic(), ['a'], [0.0], (), 0, 1))

    def send(self, command):
        if command is not None:
            if self.is_broken:
                raise RuntimeError('context is not valid')
            self.sent.append(command)
            self.path.published(time.monotonic())

    def tick(self):
        self.send(self.path.tick(time.monotonic()))

    def flush(self, timeout):
        pass


class Executor:
    """An executor that does nothing, or fails."""

    def __init__(self, fails):
        self.fails = fails
        self.spun = 0

    def spin_once(self, timeout=None):
        self.spun += 1
        time.sleep(0.001)
        if self.fails(self.spun):
            raise RuntimeError('wait set is broken')

    add_node = remove_node = lambda self, node: None


def signaled(name='', count=0):
    """Return signals of a process."""
    return SimpleNamespace(name=name, count=count, call=lambda wake: None)


def loop(fails, signals=None, **options):
    """Return a loop with an output that sends its whole effort, the output and the log."""
    output, log = Output(**options), []
    output.drive()
    node = SimpleNamespace(
        output=output,
        path=output.path,
        logger=SimpleNamespace(error=log.append, fatal=log.append, warning=log.append),
        create_guard_condition=lambda _: SimpleNamespace(trigger=None),
        destroy_node=lambda: None,
    )
    signals = signals or signaled()
    return main._Loop(node, Executor(fails), signals), output, log


@pytest.fixture(autouse=True)
def quiet(monkeypatch):
    monkeypatch.setattr(main, '_load_scipy', lambda: None)
    monkeypatch.setattr(main, '_freeze_startup_objects', lambda: None)


def test_an_executor_that_keeps_failing_stops_the_output_and_ends_with_an_error():
    unit, output, log = loop(lambda spun: True)
    assert unit.run() == 1
    efforts = np.array(output.sent)[:, 0]
    assert efforts[-1] == 0.0
    begin = int(np.argmax(efforts == 5.0))
    assert len(efforts) - begin > 10  # by the ramp
    assert (np.diff(efforts[begin:]) <= 0.0).all()
    assert sum('error in rclpy' in text for text in log) == 1
    assert any('the executor keeps failing' in text for text in log)


def test_occasional_errors_do_not_end_the_process():
    signals = signaled()
    unit, output, log = loop(lambda spun: spun % 2, signals)

    def fails(spun):
        if spun > 800:
            signals.name, signals.count = 'SIGTERM', 1
        return spun % 2

    unit._executor.fails = fails
    assert unit.run() == 0
    assert output.sent[-1] == 0.0
    assert unit._executor.spun > 800
    assert not any('keeps failing' in text for text in log)


def test_a_remaining_effort_is_reported_by_the_exit_code():
    unit, output, log = loop(lambda spun: False, signaled('SIGTERM', 1))
    output.is_broken = True
    assert unit.run() == 1
    assert any('the last efforts may stay in force: a: ' in text for text in log)


def test_efforts_of_a_lost_controller_are_reported_by_the_exit_code():
    unit, output, log = loop(lambda spun: False, signaled('SIGTERM', 1))
    output.path.lose_controller(time.monotonic(), '/c is inactive')
    assert unit.run() == 1
    assert any('the last efforts may stay in force: a: 5' in text for text in log)
