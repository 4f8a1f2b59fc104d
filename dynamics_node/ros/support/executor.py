"""The executor of rclpy that runs the callbacks of the node."""

from __future__ import annotations

import time
from typing import Any

from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import Empty
from std_srvs.srv import Trigger

EXECUTORS = ('rclpy', 'events')
# Longest duration of the self-test of an executor, s.
TEST_WITHIN = 5.0
# Duration of the wait without events in the self-test, s.
IDLE = 0.2
# Largest share of processor time in that wait.
BUSY_SHARE = 0.5


class UnsoundExecutorError(RuntimeError):
    """The chosen executor does not work on this computer as the node needs it."""


def make_executor(choice: str) -> Executor:
    """
    Return an executor of rclpy.

    Parameters
    ----------
    choice : str
        One of EXECUTORS.

    Returns
    -------
    rclpy.executors.Executor

    Raises
    ------
    UnsoundExecutorError
        If rclpy has no events executor, or its self-test fails.

    """
    if choice == 'rclpy':
        return SingleThreadedExecutor()
    try:
        from rclpy.experimental import EventsExecutor
    except ImportError as error:
        raise UnsoundExecutorError(
            f'--executor events: this rclpy has none ({error}); use --executor rclpy'
        ) from error
    problem = _self_test(EventsExecutor)
    if problem:
        raise UnsoundExecutorError(
            f'--executor events: its self-test failed ({problem}); use --executor rclpy'
        )
    return EventsExecutor()


def _self_test(kind):
    # Returns the first problem, '' if there is none. Tests a timer, a message, a service that
    # answers late, and a wait without load.
    executor = kind()
    probe = _Probe()
    try:
        executor.add_node(probe)
        end = time.monotonic() + TEST_WITHIN
        while probe.missing() and time.monotonic() < end:
            executor.spin_once(timeout_sec=0.05)
            probe.go_on()
        if probe.missing():
            return f'no {" and no ".join(probe.missing())} within {TEST_WITHIN:g} s'
        probe.rest()
        begin, computing = time.monotonic(), time.process_time()
        executor.spin_once(timeout_sec=IDLE)
        while time.monotonic() - begin < IDLE:
            executor.spin_once(timeout_sec=IDLE)
        if time.process_time() - computing > BUSY_SHARE * IDLE:
            return 'it uses the processor while it waits'
    except Exception as error:
        return f'{type(error).__name__}: {error}'
    finally:
        executor.shutdown()
        probe.destroy_node()
    return ''


class _Probe(Node):
    """A node of its own name with a timer, a topic and a service, as the node has them."""

    def __init__(self) -> None:
        super().__init__(
            '_dynamics_node_executor_test',
            use_global_arguments=False,
            start_parameter_services=False,
        )
        self._done = {'timer': False, 'message': False, 'late answer': False}
        self._timer = self.create_timer(0.01, self._ticked)
        self._publisher = self.create_publisher(Empty, '~/probe', 1)
        self.create_subscription(Empty, '~/probe', self._received, 1)
        self.create_service(
            Trigger, '~/late', self._answer, callback_group=ReentrantCallbackGroup()
        )
        self._client = self.create_client(Trigger, '~/late')
        self._call: Any = None
        self._late: Future = Future()

    def missing(self) -> list[str]:
        """Return the names of the parts that have not worked yet."""
        if self._call is not None and self._call.done():
            self._done['late answer'] = True
        return [name for name, is_done in self._done.items() if not is_done]

    def go_on(self) -> None:
        """Publish a message, and call the service as soon as it is ready."""
        self._publisher.publish(Empty())
        if self._call is None and self._client.service_is_ready():
            self._call = self._client.call_async(Trigger.Request())

    def rest(self) -> None:
        """Stop the timer, so that no event remains."""
        self._timer.cancel()

    def _ticked(self):
        self._done['timer'] = True
        if self._call is not None and not self._late.done():
            self._late.set_result(True)

    def _received(self, _):
        self._done['message'] = True

    async def _answer(self, request, response):
        response.success = await self._late
        return response
