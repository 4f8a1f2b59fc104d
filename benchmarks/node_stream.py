"""A stream of joint states to one process, and the commands that come back, matched one by one."""

from array import array
import bisect
import time

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSProfile, QoSReliabilityPolicy
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

# Time after the last state in which its command may still come, s.
LATE = 0.05


class Stream:
    """
    Feeds one process and notes when which command comes back.

    A Float64MultiArray has no stamp. So every state of a slice has a position of its own, the
    command that belongs to it is known, and one number of it, which grows along the slice,
    tells which state it answers.

    Attributes
    ----------
    sent, lost : int
        States of all slices since they were set to zero, and those without an answer.

    """

    def __init__(self, node, namespace, names, positions, answers):
        """
        Create publisher and subscription.

        Parameters
        ----------
        node : rclpy.node.Node
            Of the driver.
        namespace : str
            Of the process.
        names : sequence of str
            Joint names.
        positions : numpy.ndarray, shape (count, n)
            The states of a slice, rad or m.
        answers : numpy.ndarray, shape (count, n)
            The commands that belong to them; one column grows strictly.

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
            raise ValueError('expected a column of answers that grows strictly, got none')
        self._tolerance = 0.1 * steps[self._column]
        self._keys = answers[:, self._column].tolist()
        self._publisher = node.create_publisher(
            JointState,
            f'{namespace}/joint_states',
            QoSProfile(depth=1, reliability=QoSReliabilityPolicy.RELIABLE),
        )
        # In a node of its own, so that the executor that is measured with it has little to do.
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
            self._heard,
            QoSProfile(depth=10, reliability=QoSReliabilityPolicy.RELIABLE),
        )
        self.sent = self.lost = 0

    def is_matched(self):
        """Tell whether both directions have found each other."""
        return bool(
            self._publisher.get_subscription_count() and self._subscription.get_publisher_count()
        )

    def send(self, index=0):
        """Publish one state of the slice, without waiting for its command."""
        self._publisher.publish(self._stamped(index))

    def drain(self):
        """Forget the commands that have come."""
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
            How many.

        Returns
        -------
        list of float
            From publish to the callback with the command, s, of every state that was answered.

        """
        self.drain()
        sent: list[float] = []
        begin = time.perf_counter() + 0.002
        for index in range(count):
            self._receive_until(begin + index / rate)
            message = self._stamped(index)
            sent.append(time.perf_counter())
            self._publisher.publish(message)
        self._receive_until(time.perf_counter() + LATE)
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
        """Take publisher and subscription away from the node again."""
        node.destroy_publisher(self._publisher)
        self._executor.shutdown()
        self._node.destroy_node()

    def _stamped(self, index):
        # As a robot's: a state from long ago, or the same one again, is no news to the node.
        message = self._messages[index]
        message.header.stamp = self._clock.now().to_msg()
        return message

    def _receive_until(self, end):
        while (left := end - time.perf_counter()) > 0.0:
            self._executor.spin_once(timeout_sec=left)

    def _heard(self, message):
        self._received.append((time.perf_counter(), message.data[self._column]))

    def _index(self, key):
        # The nearest of the known answers, if it is one of them at all: on the start ramp, for
        # example, commands answer to no state of the slice.
        right = bisect.bisect_left(self._keys, key - self._tolerance)
        if right < len(self._keys) and abs(self._keys[right] - key) <= self._tolerance:
            return right
        return None
