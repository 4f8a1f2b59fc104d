"""
The cost of the node beyond a bare rclpy relay: latency, processor time, services, start.

    python -m benchmarks.node_latency
    python -m benchmarks.node_latency --no-raw-states

The node and the relay run in separate processes, at the same time, and receive states in turn in
short slices, so that other load of the machine affects both. All ratios come from the same run. A
latency is the time from publishing the state to the callback that receives the command, so it
contains two executors: that of the process and that of the subscriber.

"""

from contextlib import ExitStack
from dataclasses import dataclass
import os
import statistics
import sys
import time

from dynamics_interfaces.msg import OutputState
from dynamics_interfaces.srv import ComputeTrajectoryEffort, GetMassMatrix
from dynamics_node import RobotModel
import numpy as np
from rclpy.qos import QoSDurabilityPolicy, QoSProfile
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool, Trigger
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from .node_processes import node, relay, ROOT
from .node_stream import Stream

ROBOT = ROOT / 'config' / 'robots' / 'arm7.urdf'
RATES = (100, 500, 1000)
SLICES = 9  # per rate and process
# Duration of a slice, s: shorter than the state timeout.
SLICE = 0.4
BURSTS = 15  # of service calls, per kind
CALLS = 25  # per burst
STARTS = 4
POINTS = 10_000  # of a trajectory
TRAJECTORIES = 5  # calls with it
# Timeout of all waits, s.
PATIENCE = 30.0


@dataclass(frozen=True)
class Row:
    """
    One measured quantity.

    Attributes
    ----------
    name : str
    rate : float or None
        Rate of the joint states, Hz.
    unit : str
    node, relay : float
    ratio : float
        For a start: the difference, s.
    spread : tuple of float
        First and third quartile of the ratio (or difference) over the slices.

    """

    name: str
    rate: float | None
    unit: str
    node: float
    relay: float
    ratio: float
    spread: tuple[float, float]


class Driver:
    """The node that sends to both processes and receives from both."""

    def __init__(self):
        import rclpy
        from rclpy.executors import SingleThreadedExecutor

        rclpy.init(args=[])
        self.node = rclpy.create_node('driver', start_parameter_services=False)
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.node)

    def until(self, condition, action=lambda: None, processes=()):
        """Spin until a condition holds, with an action every 10 ms."""
        end = time.monotonic() + PATIENCE
        due = time.monotonic()
        while not condition():
            for process in processes:
                if not process.is_running():
                    raise RuntimeError(f'a process has ended:\n{process.problem()}')
            if time.monotonic() > end:
                raise RuntimeError(
                    f'not within {PATIENCE:g} s: {condition}\n'
                    + '\n'.join(process.problem() for process in processes)
                )
            if time.monotonic() >= due:
                action()
                due = time.monotonic() + 0.01
            self.executor.spin_once(timeout_sec=0.002)

    def call(self, client, request, action=lambda: None):
        """Return the response of a service."""
        self.until(client.service_is_ready, action)
        future = client.call_async(request)
        self.until(future.done, action)
        return future.result()

    def close(self):
        """Shut ROS down."""
        import rclpy

        self.executor.shutdown()
        self.node.destroy_node()
        rclpy.try_shutdown()


def measure_all(
    rates=RATES,
    slices=SLICES,
    starts=STARTS,
    bursts=BURSTS,
    trajectories=TRAJECTORIES,
    arguments=(),
):
    """
    Run all measurements.

    Parameters
    ----------
    rates : sequence of float
        Rates of the joint states, Hz.
    slices, starts, bursts, trajectories : int
        Repetitions; 0 omits a part.
    arguments : sequence of str
        Further arguments of the node's command line.

    Returns
    -------
    list of Row

    Raises
    ------
    RuntimeError
        If a process ends or does not answer; with its output.

    """
    # A separate domain, unless the environment names one.
    os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    os.environ.setdefault('ROS_DOMAIN_ID', str(os.getpid() % 100 + 1))
    driver = Driver()
    try:
        return (
            measure_streams(driver, rates, slices, arguments)
            + measure_services(driver, bursts, arguments)
            + measure_trajectories(driver, trajectories, arguments)
            + measure_starts(driver, starts, arguments)
        )
    finally:
        driver.close()


def measure():
    """Return the rows of `measure_all` for the report: column title → text."""
    return [
        {
            'what': row.name,
            'joint states': f'{row.rate:g} Hz' if row.rate else '',
            'node': f'{row.node:.3g} {row.unit}',
            'bare rclpy': f'{row.relay:.3g} {row.unit}',
            'ratio': _ratio_text(row),
            'quartiles': _quartiles_text(row),
        }
        for row in measure_all()
    ]


def _ratio_text(row):
    return f'+{row.ratio:.2f} s' if row.unit == 's' else f'{row.ratio:.2f}'


def _quartiles_text(row):
    return f'{row.spread[0]:.2f} to {row.spread[1]:.2f}'


def measure_streams(driver, rates, slices, arguments=()):
    """Return the rows of latency and processor time of joint states."""
    if not slices:
        return []
    robot = RobotModel.from_urdf(ROBOT)
    count = int(max(rates) * SLICE)
    states = _states(robot, count)
    rows = []
    with node(ROBOT, *arguments) as ours, relay('states') as bare:
        streams = [
            Stream(driver.node, '/ours', robot.joint_names, states, robot.gravity_torque(states)),
            Stream(driver.node, '/relay', robot.joint_names, states, states),
        ]
        processes = [ours, bare]
        for stream in streams:
            driver.until(stream.is_matched, streams[0].send, processes)
        keep_on = _Enabler(driver, streams[0])
        for rate in rates:
            latencies: list[list] = [[], []]
            cpu: list[list] = [[], []]
            for index in range(slices):
                # In both orders: the first one has no advantage.
                for which in (0, 1) if index % 2 else (1, 0):
                    if which == 0:
                        keep_on()
                    before = processes[which].cpu()
                    answered = streams[which].run(rate, int(rate * SLICE))
                    latencies[which].append(answered)
                    cpu[which].append((processes[which].cpu() - before) / len(answered))
            rows += _stream_rows(rate, latencies, cpu)
            rows.append(_answered(rate, streams))
        for stream in streams:
            stream.close(driver.node)
    return rows


class _Enabler:
    """Enables the node's output, so that it answers with commands."""

    def __init__(self, driver, stream):
        self._driver, self._stream = driver, stream
        self._state = None
        driver.node.create_subscription(
            OutputState,
            '/ours/dynamics_node/state',
            self._on_state,
            QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL),
        )
        self._client = driver.node.create_client(SetBool, '/ours/dynamics_node/enable')

    def __call__(self):
        for _ in range(3):  # receive a fault of the pause
            self._driver.executor.spin_once(timeout_sec=0.0)
        end = time.monotonic() + PATIENCE
        while self._state != 'ACTIVE':
            answer = self._driver.call(self._client, SetBool.Request(data=True), self._stream.send)
            if time.monotonic() > end:
                raise RuntimeError(f'not ACTIVE within {PATIENCE:g} s: {answer.message}')
            if answer.success:
                self._driver.until(lambda: self._state in ('ACTIVE', 'FAULT'), self._stream.send)
        self._stream.send()
        time.sleep(0.02)

    def _on_state(self, message):
        self._state = message.name


def _states(robot, count):
    # The second joint moves slowly: each state of a slice has another position, and no step
    # exceeds a rate limit.
    states = np.tile(
        np.clip(np.full(len(robot.joint_names), 0.3), *robot.position_limits.T), (count, 1)
    )
    states[:, 1] += np.linspace(0.0, 0.2, count)
    return states


def _stream_rows(rate, latencies, cpu):
    ours, bare = ([latency for part in parts for latency in part] for parts in latencies)
    rows = []
    for percent in (50, 90, 99):
        each = [[np.percentile(part, percent) for part in parts] for parts in latencies]
        a, b = np.percentile(ours, percent), np.percentile(bare, percent)
        ratios = [x / y for x, y in zip(*each, strict=True)]
        rows.append(
            Row(
                f'latency p{percent}',
                rate,
                'ms',
                a * 1e3,
                b * 1e3,
                statistics.median(ratios) if percent == 50 else a / b,
                _quartiles(ratios),
            )
        )
    ratios = [x / y for x, y in zip(*cpu, strict=True)]
    rows.append(
        Row(
            'CPU per command',
            rate,
            'ms',
            statistics.median(cpu[0]) * 1e3,
            statistics.median(cpu[1]) * 1e3,
            statistics.median(ratios),
            _quartiles(ratios),
        )
    )
    return rows


def _answered(rate, streams):
    # Both ends keep only the newest message: states that come too fast are skipped.
    shares = [1.0 - stream.lost / stream.sent for stream in streams]
    for stream in streams:
        stream.lost = stream.sent = 0
    ratio = shares[0] / shares[1] if shares[1] else float('nan')
    ours, relay = shares
    return Row('states answered', rate, '', ours, relay, ratio, (ratio, ratio))


def measure_services(driver, bursts, arguments=()):
    """Return the rows of get_mass_matrix, relative to std_srvs/Trigger."""
    if not bursts:
        return []
    robot = RobotModel.from_urdf(ROBOT)
    with node(ROBOT, *arguments) as ours, relay('trigger') as bare, ExitStack() as stack:
        mass = driver.node.create_client(GetMassMatrix, '/ours/dynamics_node/get_mass_matrix')
        trigger = driver.node.create_client(Trigger, '/relay/relay/trigger')
        states = driver.node.create_publisher(JointState, '/ours/joint_states', 1)
        for client in (mass, trigger):
            stack.callback(driver.node.destroy_client, client)
        stack.callback(driver.node.destroy_publisher, states)
        measured = JointState(
            name=list(robot.joint_names), position=robot.neutral_position.tolist()
        )
        for ready in (
            mass.service_is_ready,
            trigger.service_is_ready,
            states.get_subscription_count,
        ):
            driver.until(ready, processes=[ours, bare])

        def warm(client, request):
            # Needs a fresh state; fills the caches of both processes.
            end = time.monotonic() + PATIENCE
            while True:
                states.publish(measured)
                time.sleep(0.02)
                answers = [driver.call(client, request) for _ in range(3)]
                if answers[-1].success:
                    return
                if time.monotonic() > end:
                    raise RuntimeError(f'expected success, got: {answers[-1].message}')

        requests = [
            ('get_mass_matrix {}', mass, GetMassMatrix.Request()),
            (
                'get_mass_matrix with position',
                mass,
                GetMassMatrix.Request(position=robot.neutral_position.tolist()),
            ),
            ('Trigger', trigger, Trigger.Request()),
        ]
        times: list[list] = [[] for _ in requests]
        for burst in range(bursts):
            for step in range(len(requests)):
                which = (burst + step) % len(requests)
                _, client, request = requests[which]
                warm(client, request)
                times[which].append(_burst(driver, client, request))
    rows = []
    for (name, _, _), parts in zip(requests[:-1], times[:-1], strict=True):
        ratios = [
            statistics.median(x) / statistics.median(y)
            for x, y in zip(parts, times[-1], strict=True)
        ]
        rows.append(
            Row(
                f'{name} p50',
                None,
                'ms',
                _median_ms(parts),
                _median_ms(times[-1]),
                statistics.median(ratios),
                _quartiles(ratios),
            )
        )
    return rows


def _burst(driver, client, request):
    times = []
    for _ in range(CALLS):
        begin = time.perf_counter()
        future = client.call_async(request)
        while not future.done():  # rclpy's own function takes longer with every call
            driver.executor.spin_once()
        times.append(time.perf_counter() - begin)
    return times


def measure_trajectories(driver, rounds, arguments=()):
    """Return the row of a long trajectory, relative to a service that only returns it."""
    if not rounds:
        return []
    robot = RobotModel.from_urdf(ROBOT)
    request = ComputeTrajectoryEffort.Request(trajectory=_trajectory(robot))
    with node(ROBOT, *arguments) as ours, relay('trajectory') as bare, ExitStack() as stack:
        clients = [
            driver.node.create_client(ComputeTrajectoryEffort, name)
            for name in (
                '/ours/dynamics_node/compute_trajectory_effort',
                '/relay/relay/trajectory',
            )
        ]
        for client in clients:
            stack.callback(driver.node.destroy_client, client)
            driver.until(client.service_is_ready, processes=[ours, bare])
        times: list[list] = [[], []]
        for index in range(rounds + 1):
            # In both orders: the first one has no advantage.
            for which in (0, 1) if index % 2 else (1, 0):
                begin = time.perf_counter()
                answer = driver.call(clients[which], request)
                times[which].append(time.perf_counter() - begin)
                if not answer.success:
                    raise RuntimeError(f'expected success, got: {answer.message}')
    # The first call fills the caches.
    a, b = (part[1:] for part in times)
    ratios = [x / y for x, y in zip(a, b, strict=True)]
    return [
        Row(
            f'trajectory of {POINTS:,} points'.replace(',', ' '),
            None,
            'ms',
            statistics.median(a) * 1e3,
            statistics.median(b) * 1e3,
            statistics.median(ratios),
            _quartiles(ratios),
        )
    ]


def _trajectory(robot):
    # All joints swing; the node computes velocities and accelerations.
    n = len(robot.joint_names)
    angle = np.linspace(0.0, 20.0, POINTS)[:, None] + np.arange(n)
    trajectory = JointTrajectory(joint_names=robot.joint_names)
    for i, row in enumerate(0.02 * np.sin(angle)):
        point = JointTrajectoryPoint(positions=row.tolist())
        point.time_from_start.sec, thousandths = divmod(i, 1000)
        point.time_from_start.nanosec = thousandths * 1_000_000
        trajectory.points.append(point)
    return trajectory


def measure_starts(driver, starts, arguments=()):
    """Return the row of the time from process start to the first gravity torque."""
    if not starts:
        return []
    robot = RobotModel.from_urdf(ROBOT)
    measured = JointState(name=list(robot.joint_names), position=robot.neutral_position.tolist())
    states = driver.node.create_publisher(JointState, '/start/joint_states', 1)
    ours, bare = [], []
    # The first start fills the caches of the disk and of compiled kernels.
    for index in range(starts + 1):
        pair = [
            _start(
                driver,
                lambda: node(ROBOT, *arguments, namespace='/start'),
                '/start/dynamics_node/gravity_torque',
                lambda: states.publish(measured),
            ),
            _start(
                driver,
                lambda: relay('torque', namespace='/start'),
                '/start/relay/gravity_torque',
                lambda: states.publish(measured),
            ),
        ]
        if index:
            ours.append(pair[0])
            bare.append(pair[1])
    driver.node.destroy_publisher(states)
    differences = [a - b for a, b in zip(ours, bare, strict=True)]
    return [
        Row(
            'start to first torque, beyond rclpy',
            None,
            's',
            statistics.median(ours),
            statistics.median(bare),
            statistics.median(differences),
            _quartiles(differences),
        )
    ]


def _start(driver, start, topic, publish):
    received: list = []
    subscription = driver.node.create_subscription(JointState, topic, received.append, 1)
    begin = time.perf_counter()
    with start() as process:
        driver.until(lambda: received, publish, [process])
        elapsed = time.perf_counter() - begin
    driver.node.destroy_subscription(subscription)
    return elapsed


def _median_ms(parts):
    return statistics.median(value for part in parts for value in part) * 1e3


def _quartiles(values):
    low, _, high = np.percentile(values, (25, 50, 75))
    return float(low), float(high)


def table(rows):
    """
    Return rows as a markdown table.

    Parameters
    ----------
    rows : sequence of Row

    Returns
    -------
    str

    """
    lines = [
        '| what | joint states | node | bare rclpy | ratio | quartiles |',
        '|---|---|---|---|---|---|',
    ]
    for row in rows:
        rate = f'{row.rate:g} Hz' if row.rate else ''
        lines.append(
            f'| {row.name} | {rate} | {row.node:.3g} {row.unit} | {row.relay:.3g} '
            f'{row.unit} | {_ratio_text(row)} | {_quartiles_text(row)} |'
        )
    return '\n'.join(lines)


def main():
    """Print the table; arguments are passed to the node."""
    begin = time.monotonic()
    rows = measure_all(arguments=sys.argv[1:])
    print(table(rows))
    print(f'measured in {time.monotonic() - begin:.0f} s', file=sys.stderr)


if __name__ == '__main__':
    main()
