"""`Rig`: robot, relay and node as processes, and an operator of the arm."""

import functools
import signal
import time

from dynamics_node.demo.mujoco_arm import MujocoArm
import numpy as np
from support.robots import ARM7

from .arm_client import ArmClient
from .processes import RigProcesses

# Timeout of imports, compilation and discovery on a slow machine, s.
START_TIMEOUT = 90.0
# From zero to the effort limit, s: the node's default rate limits.
FULL_EFFORT_TIME = 0.1
# Largest displacement at which the arm is not brought back to its start pose, rad.
NEAR = 0.3
# Largest speed of an arm at rest, rad/s.
AT_REST = 0.01
# Attempts to enable: a busy machine may cause a stop during the start ramp.
ATTEMPTS = 5
COMMAND_TOPIC = '/forward_effort_controller/commands'


class Rig:
    """
    The simulated arm behind a faulty link, held by the node.

    Attributes
    ----------
    client : ArmClient
    processes : RigProcesses
    arm : MujocoArm
        For its joints and start pose; not the running simulation.

    """

    def __init__(self, rate=500.0, seed=0, urdf=ARM7, **parameters):
        """
        Start all processes, and wait until the node has a model and states.

        Parameters
        ----------
        rate : float
            Rate of the joint states, Hz.
        seed : int
            Seed of the relay's random faults.
        urdf : pathlib.Path
        **parameters
            Parameters of the node.

        """
        self.urdf_text = urdf.read_text()
        self.arm = MujocoArm(self.urdf_text)
        self.processes = RigProcesses()
        self._seed, self._robot_options = (
            seed,
            ('-p', f'robot_description_file:={urdf}', '-p', f'rate:={rate}'),
        )
        self._parameters = parameters
        self._special = {}
        self.start_missing()
        limits = np.array([joint.effort for joint in self.arm.driven])
        self.client = ArmClient(self.arm.driven_names, limits, limits / FULL_EFFORT_TIME)
        try:
            self.until(lambda: self.client.output == 'READY' and self.client.truth, START_TIMEOUT)
        except BaseException:
            self.close()
            raise
        self.start_pose = self.client.state[0]

    def start_missing(self):
        """Start those of robot, relay and node that do not run."""
        if not self.processes.is_running('robot'):
            self.processes.start(
                'robot',
                'dynamics_node.demo.simulated_robot',
                '--ros-args',
                '-r',
                'joint_states:=robot/joint_states',
                *self._robot_options,
            )
        if not self.processes.is_running('relay'):
            self.processes.start('relay', 'soak.relay', '--ros-args', '-p', f'seed:={self._seed}')
        if not self.processes.is_running('node'):
            arguments = [
                item
                for name, value in {**self._parameters, **self._special}.items()
                for item in ('-p', f'{name}:={value}')
            ]
            self.processes.start('node', 'dynamics_node.ros.main', '--ros-args', *arguments)

    def use_node(self, **special):
        """Use a node with these parameters besides the rig's; start a new one if they differ."""
        is_running = self.processes.is_running('node')
        if is_running and special == self._special:
            return
        if is_running:
            self.processes.end('node')
        self.check_log('node')
        self.until_gone(self.client.node.count_publishers, COMMAND_TOPIC)
        self.client.forget_node()
        self._special = special
        self.start_missing()
        self.until(lambda: self.client.output == 'READY', START_TIMEOUT)

    def until_gone(self, count, topic):
        """Wait until the graph no longer contains an ended process."""
        self.until(lambda: count(topic) == 0, START_TIMEOUT)

    def check_log(self, name):
        """Raise if a process has printed a traceback."""
        lines = self.processes.lines(name)
        assert not any('Traceback' in line for line in lines), '\n'.join(lines[-60:])

    def until(self, condition, timeout=20.0):
        """Spin until a condition holds; return its value."""
        return self.client.until(condition, timeout=timeout)

    def during(self, seconds):
        """Spin for a duration."""
        self.client.during(seconds)

    def catch(self):
        """Engage the brakes; bring the arm back if it is far from its start pose."""
        self.until(functools.partial(self.client.set_brakes, True))
        if self.distance > NEAR:
            self.until(self.client.reset)
            self.until(functools.partial(self.client.set_brakes, True))

    def float(self):
        """Bring the arm to floating, without brakes and faults, from any state."""
        self.client.settle()
        if self.client.output == 'ACTIVE':
            return
        self.start_missing()
        self.client.set_fault('none')
        self.catch()
        for _ in range(ATTEMPTS):
            self.enable()
            self.until(lambda: self.client.output in ('ACTIVE', 'FAULT'))
            if self.client.output == 'ACTIVE':
                self.release()
                return
        raise AssertionError(f'not ACTIVE after {ATTEMPTS} attempts: {self.explain()}')

    def release(self):
        """Release the brakes of an arm that is held."""
        # Before its efforts arrive, the arm would begin to fall.
        self.until(lambda: self.client.is_held)
        assert self.client.set_brakes(False)
        self.during(0.03)
        self.until(lambda: self.client.speed < AT_REST)

    @property
    def distance(self):
        """Largest displacement of any joint from the start pose, rad or m."""
        return np.abs(self.client.state[0] - self.start_pose).max()

    def enable(self, timeout=30.0):
        """Enable the output, repeatedly: other publishers take time to disappear."""
        end = time.monotonic() + timeout
        while True:
            changes = len(self.client.outputs)
            answer = self.client.enable(True)
            if answer.success:
                break
            assert time.monotonic() < end, answer.message
            self.during(0.1)
        self.until(lambda: len(self.client.outputs) > changes or self.client.output == 'ACTIVE')

    def explain(self):
        """Return output state, gaps of the states and log, for an error message."""
        times = [time for time, _ in self.client.truth][-1000:]
        gap = np.diff(times).max(initial=0.0)
        output = self.client.outputs[-1] if self.client.outputs else None
        return '\n'.join(
            [
                f'{output.name}: {output.reason}' if output else 'no state of the output',
                f'longest gap between the last {len(times)} states of the robot: {gap:.3f} s',
                *self.processes.lines('node')[-10:],
            ]
        )

    def until_fault(self, timeout=10.0):
        """Wait until a stop has ended in FAULT, catch the arm, and return the reason."""
        self.until(lambda: self.client.output == 'FAULT', timeout)
        self.client.set_brakes(True)
        return self.client.outputs[-1].reason

    def close(self):
        """End all processes; raise if one has printed a traceback."""
        self.client.close()
        names = ('robot', 'relay', 'node')
        for name in names:
            if self.processes.is_running(name):
                self.processes.send(name, signal.SIGCONT)
        try:
            for name in reversed(names):
                if self.processes.is_running(name):
                    self.processes.end(name)
                self.check_log(name)
        finally:
            self.processes.__exit__(None, None, None)
