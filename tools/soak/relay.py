"""
The line as a process: robot/joint_states in, joint_states out, with a fault if one is asked for.

Run as `python -m soak.relay`. The parameter `fault` is what `soak.line` knows. With a finite
`clock_offset`, s, the stamps are moved by it, and /clock says the same time.

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

from .faulty_link import Line, shifted, stamp_of


class Relay(Node):
    """Passes joint states on, as bytes while nothing is wrong with them."""

    def __init__(self):
        """Connect both sides."""
        super().__init__('relay')
        self._line = Line(self.declare_parameter('seed', 0).value)
        self.declare_parameter('fault', self._line.fault)
        self.declare_parameter('clock_offset', math.nan)
        self.add_on_set_parameters_callback(self._set)
        self._offset = None
        self._sent = 0
        self._states = self.create_publisher(JointState, 'joint_states', 10)
        self._clock_publisher = self.create_publisher(Clock, '/clock', 1)
        self.create_subscription(
            JointState, 'robot/joint_states', self._received, qos_profile_sensor_data, raw=True
        )
        self.create_service(Trigger, '~/sent', self._say_sent)

    def _received(self, data):
        if self._offset is not None:
            data = shifted(data, self._offset)
            clock = Clock()
            clock.clock.sec, clock.clock.nanosec = divmod(stamp_of(data), 1_000_000_000)
            self._clock_publisher.publish(clock)
        items = (
            [data]
            if self._line.fault == 'none'
            else self._line.out(deserialize_message(data, JointState))
        )
        for item in items:
            self._states.publish(item)
            self._sent += 1

    def _set(self, parameters):
        for parameter in parameters:
            try:
                if parameter.name == 'fault':
                    self._line.switch(parameter.value)
                elif parameter.name == 'clock_offset':
                    is_wanted = math.isfinite(parameter.value)
                    self._offset = round(parameter.value * 1e9) if is_wanted else None
            except ValueError as error:
                return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _say_sent(self, request, response):
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
