"""
The faulty link as a process, from robot/joint_states to joint_states: `python -m soak.relay`.

The parameter `fault` is a key of `faulty_link.FAULTS`. A finite `clock_offset`, s, shifts all
stamps, and /clock with them.

"""

import math
import signal
import sys

from rcl_interfaces.msg import SetParametersResult
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.serialization import deserialize_message
from rclpy.signals import SignalHandlerOptions
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from .faulty_link import FaultyLink, shifted, stamp_of


class Relay(Node):
    """Forwards joint states, serialized while the link has no fault."""

    def __init__(self):
        super().__init__('relay')
        self._link = FaultyLink(self.declare_parameter('seed', 0).value)
        self.declare_parameter('fault', self._link.fault)
        self.declare_parameter('clock_offset', math.nan)
        self.add_on_set_parameters_callback(self._set)
        self._offset = None
        self._sent = 0
        self._states = self.create_publisher(JointState, 'joint_states', 10)
        self._clock_publisher = self.create_publisher(Clock, '/clock', 1)
        self.create_subscription(
            JointState, 'robot/joint_states', self._received, qos_profile_sensor_data, raw=True
        )
        self.create_service(Trigger, '~/sent', self._on_sent)

    def _received(self, data):
        if self._offset is not None:
            data = shifted(data, self._offset)
            clock = Clock()
            clock.clock.sec, clock.clock.nanosec = divmod(stamp_of(data), 1_000_000_000)
            self._clock_publisher.publish(clock)
        items = (
            [data]
            if self._link.fault == 'none'
            else self._link.out(deserialize_message(data, JointState))
        )
        for item in items:
            self._states.publish(item)
            self._sent += 1

    def _set(self, parameters):
        for parameter in parameters:
            try:
                if parameter.name == 'fault':
                    self._link.switch(parameter.value)
                elif parameter.name == 'clock_offset':
                    is_wanted = math.isfinite(parameter.value)
                    self._offset = round(parameter.value * 1e9) if is_wanted else None
            except ValueError as error:
                return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _on_sent(self, request, response):
        response.success, response.message = True, str(self._sent)
        return response


def main():
    """Run until SIGINT or SIGTERM."""
    stopped = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda number, frame: stopped.append(number))
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    try:
        executor = SingleThreadedExecutor()
        executor.add_node(Relay())
        while not stopped:
            executor.spin_once(0.1)
    finally:
        rclpy.try_shutdown()
    return 0


if __name__ == '__main__':
    sys.exit(main())
