"""A stream of joint states to one process, each matched with its command."""

from array import array
import bisect
import time

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSProfile, QoSReliabilityPolicy
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

# Timeout of the command of the last state, s.
ANSWER_TIMEOUT = 0.05


class Stream:
    """
    Sends joint states to one process and records the times of its commands.

    A Float64MultiArray has no stamp. So each state of a slice has another position and a known
    command, and one component of the commands grows along the slice and identifies the state.

    Attributes
    ----------
    sent, lost : int
        States since the last reset to zero, and those without an answer.

    """

    def __init__(self, node, namespace, names, positions, answers):
        """
        Create publisher and subscription.

        Parameters
        ----------
        node : rclpy.node.Node
            Node of the driver.
        namespace : str
            Namespace of the process.
        names : sequence of str
            Joint names.
        positions : numpy.ndarray, shape (count, n)
            The states of a slice, rad or m.
        answers : numpy.ndarray, shape (count, n)
            Their commands; one column increases strictly.

        """
        self._messages = [
            JointState(
                name=list(names), position=array('d', row), velocity=array('d', [0.0] * len(row))
            )
            for row in positions
        ]
        self._clock = node.get_clock()
        steps = (answers[1:] - answers[:-1]).min(axis=0)
        self._column = int(steps.argmax())
        if steps[self._column] <= 0.0:
            raise ValueError('expected a strictly increasing column of answers, got none')
        self._tolerance = 0.1 * steps[self._column]
        self._keys = answers[:, self._column].tolist()
        self._publisher = node.create_publisher(
            JointState,
            f'{namespace}/joint_states',
            QoSProfile(depth=1, reliability=QoSReliabilityPolicy.RELIABLE),
        )
        # A separate node: its executor, part of the measurement, has little to do.
        self._node = rclpy.create_node(
            'commands',
            context=node.context,
            namespace=namespace,
            start_parameter_services=False,
            use_global_arguments=False,
        )
        self._executor = SingleThreadedExecutor(context=node.context)
        self._executor.add_node(self._node)
        self._received: list[tuple[float, float]] = []
        self._subscription = self._node.create_subscription(
            Float64MultiArray,
            f'{namespace}/forward_effort_controller/commands',
            self._on_command,
            QoSProfile(depth=10, reliability=QoSReliabilityPolicy.RELIABLE),
        )
        self.sent = self.lost = 0

    def is_matched(self):
        """Return whether publisher and subscription are matched."""
        return bool(
            self._publisher.get_subscription_count() and self._subscription.get_publisher_count()
        )

    def send(self, index=0):
        """Publish one state of the slice."""
        self._publisher.publish(self._stamped(index))

    def drain(self):
        """Discard received commands."""
        for _ in range(20):  # more than its queue holds
            self._executor.spin_once(timeout_sec=0.0)
        self._received.clear()

    def run(self, rate, count):
        """
        Send states at a fixed rate.

        Parameters
        ----------
        rate : float
            Hz.
        count : int
            Number of states.

        Returns
        -------
        list of float
            Time from publish to the callback of the command, s, of each answered state.

        """
        self.drain()
        sent: list[float] = []
        begin = time.perf_counter() + 0.002
        for index in range(count):
            self._receive_until(begin + index / rate)
            message = self._stamped(index)
            sent.append(time.perf_counter())
            self._publisher.publish(message)
        self._receive_until(time.perf_counter() + ANSWER_TIMEOUT)
        latencies: dict[int, float] = {}
        for now, key in self._received:
            index = self._index(key)
            if index is not None:
                latencies.setdefault(index, now - sent[index])
        answered = list(latencies.values())
        self.sent += count
        self.lost += count - len(answered)
        return answered

    def close(self, node):
        """Destroy publisher and subscription."""
        node.destroy_publisher(self._publisher)
        self._executor.shutdown()
        self._node.destroy_node()

    def _stamped(self, index):
        # A current stamp: the node ignores old and repeated states.
        message = self._messages[index]
        message.header.stamp = self._clock.now().to_msg()
        return message

    def _receive_until(self, end):
        while (left := end - time.perf_counter()) > 0.0:
            self._executor.spin_once(timeout_sec=left)

    def _on_command(self, message):
        self._received.append((time.perf_counter(), message.data[self._column]))

    def _index(self, key):
        # The nearest known answer; commands of the start ramp, for example, match none.
        right = bisect.bisect_left(self._keys, key - self._tolerance)
        if right < len(self._keys) and abs(self._keys[right] - key) <= self._tolerance:
            return right
        return None
