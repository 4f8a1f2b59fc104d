"""
The demo: a simulated arm falls, and the node holds it; all displacements are measured.

Two processes communicate over DDS: `simulated_robot` (MuJoCo) and the node. Exit code 0 means
that the arm fell without the node, and stood still with it at two poses.

"""

import argparse
import os
from pathlib import Path
import signal
import sys

import numpy as np
import rclpy
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args
from rich.console import Console

from .client import Client
from .console_output import print_logs, print_mass_matrix, print_outcome
from .missing_values import filled_in_limits, joints_without_limit
from .mujoco_arm import MujocoArm
from .plot import draw
from .processes import arm7_path, DemoError, Processes, read_robot
from .recording import Recording
from .robot_text import robot_name, RobotRefusedError
from .story import Outcome, Story
from .viewer import check_display

# [s] A busy desktop computer may delay the simulation by more than the node's default, 0.1 s.
STATE_TIMEOUT = 0.5
# Relative to the largest entry: MuJoCo rounds orientations, as quaternions, and inertias, in
# principal axes.
MASS_MATRIX_TOLERANCE = 1e-6


def main(args: list[str] | None = None) -> int:
    """Run the demo and return its exit code."""
    options = _options(remove_ros_args(sys.argv if args is None else args)[1:])
    console = Console(highlight=False, width=None if sys.stdout.isatty() else 100)
    isolate()
    # Terminated or without its terminal, the demo still ends its processes. A shell that starts
    # it in the background would let it and its processes ignore SIGINT.
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.default_int_handler)
    try:
        return _run(options, console)
    except (DemoError, RobotRefusedError, OSError) as error:
        console.print(f'demo failed: {error}', style='bold red', markup=False)
        return 1
    except KeyboardInterrupt:
        console.print('interrupted')
        return 130


def _options(arguments: list[str]) -> argparse.Namespace:
    """Return the command line's options."""
    parser = argparse.ArgumentParser(description=(__doc__ or '').strip().splitlines()[0])
    parser.add_argument('--robot', type=Path, help='a URDF file (default: arm7.urdf)')
    parser.add_argument(
        '--params-file',
        type=Path,
        metavar='FILE',
        help="parameters of the node; its joints must be the URDF's, in its order",
    )
    parser.add_argument('--view', action='store_true', help='watch in the MuJoCo viewer')
    parser.add_argument(
        '--hold',
        type=float,
        default=10.0,
        metavar='SECONDS',
        help='duration of the hold before the push (default: 10)',
    )
    parser.add_argument('--output', type=Path, default=Path('demo.png'), help='the figure')
    return parser.parse_args(arguments)


def isolate() -> None:
    """Keep the demo away from real robots, unless the user has chosen a domain."""
    os.environ.setdefault('ROS_DOMAIN_ID', str(1 + os.getpid() % 100))
    os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')


def _run(options: argparse.Namespace, console: Console) -> int:
    """Run the demo, print and draw its measurements."""
    if options.view:
        check_display()
    outcome, arm, name = perform(
        options.robot or arm7_path(), options.hold, options.view, console, options.params_file
    )
    print_outcome(console, outcome)
    draw(outcome, arm, name, options.output)
    console.print(f'figure: {options.output}', markup=False)
    return _verdict(outcome, console)


def perform(
    path: Path, hold: float, view: bool, console: Console, params_file: Path | None = None
) -> tuple[Outcome, MujocoArm, str]:
    """
    Run the sequence with the robot of a URDF file.

    Parameters
    ----------
    path : Path
        The URDF file.
    hold : float
        Duration of the hold before the push, s.
    view : bool
        Whether to open MuJoCo's viewer.
    console : Console
        Receives the printed lines.
    params_file : Path, optional
        Parameters of the node.

    Returns
    -------
    outcome : Outcome
        Joint states and measurements.
    arm : MujocoArm
        The same robot, for further computations.
    name : str
        Its name in the URDF.

    Raises
    ------
    DemoError
        If a process ends or a response does not come; the logs are printed.
    RobotRefusedError
        If the robot cannot be simulated.

    """
    text = read_robot(path)
    arm, name = MujocoArm(text), robot_name(text)
    console.print(
        f'[bold]{name}[/bold], driven joints: {len(arm.driven)}, simulated '
        f'by MuJoCo, held by dynamics_node (domain {os.environ["ROS_DOMAIN_ID"]})'
    )
    with Processes() as processes:
        try:
            _start(processes, path, arm, view, console, params_file)
            return _run_story(processes, arm, hold, console), arm, name
        except DemoError:
            print_logs(console, processes.tails())
            raise


def _start(
    processes: Processes,
    path: Path,
    arm: MujocoArm,
    view: bool,
    console: Console,
    params_file: Path | None,
) -> None:
    """Start the simulated robot and the node."""
    processes.start(
        'simulated_robot',
        'dynamics_node.demo.simulated_robot',
        *(['--view'] if view else []),
        '--ros-args',
        '-p',
        f'robot_description_file:={path.resolve()}',
    )
    parameters = ['--ros-args', '-p', f'state_timeout:={STATE_TIMEOUT}']
    missing = joints_without_limit(arm)
    if params_file is not None:
        parameters += ['--params-file', str(params_file.resolve(strict=True))]
    elif missing:
        limits = ', '.join(f'{limit:.1f}' for limit in filled_in_limits(arm))
        parameters += ['-p', f'effort_limits:=[{limits}]']
        console.print(
            f'The URDF states no effort limit for {", ".join(missing)}, and the node '
            'enables nothing without one: it gets twice the largest gravity torque '
            f'that MuJoCo finds, effort_limits = ({limits}) N m or N.'
        )
    processes.start('dynamics_node', 'dynamics_node.ros.main', *parameters)


def _run_story(processes: Processes, arm: MujocoArm, hold: float, console: Console) -> Outcome:
    """Connect, print the mass matrix, and run the sequence."""
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    try:
        turning = [joint.turns for joint in arm.driven]
        client = Client(Recording(arm.driven_names, turning), processes.check)
        client.wait_until_ready()
        response = client.mass_matrix()
        size = len(response.joint_names)
        matrix = np.array(response.mass_matrix).reshape(size, size)
        print_mass_matrix(console, response.joint_names, matrix)
        _compare_mass_matrix(response.joint_names, response.position, matrix, arm, console)
        _pass_on_warnings(processes, console)
        _note_friction(arm, console)
        story = Story(client, hold, lambda line: console.print(f'• {line}', markup=False))
        return story.run()
    finally:
        rclpy.try_shutdown()


def _compare_mass_matrix(
    names: list[str], position: list[float], matrix: np.ndarray, arm: MujocoArm, console: Console
) -> None:
    """Compare the service's matrix, shape (n, n), with MuJoCo's at the same position."""
    order = [arm.driven_names.index(name) for name in names]
    driven = np.zeros(len(order))
    driven[order] = position
    expected = arm.mass_matrix(driven)[np.ix_(order, order)]
    error = float(np.abs(matrix - expected).max() / np.abs(expected).max())
    if not error < MASS_MATRIX_TOLERANCE:
        raise DemoError(
            'the mass matrix of the service is not that of MuJoCo: they differ by '
            f'{error:.2g} of its largest entry'
        )
    console.print(f'MuJoCo has the same: it differs by {error:.1g} of the largest entry')


def _note_friction(arm: MujocoArm, console: Console) -> None:
    """Print joints with dry friction, which helps to hold the robot without any torque."""
    sticky = [
        f'{joint.name} {friction:g}'
        for joint, friction in zip(arm.joints, arm.friction())
        if friction > 0.0
    ]
    if sticky:
        console.print(
            f'note: the URDF states dry friction, {", ".join(sticky)} N m or N: it '
            'helps to hold still',
            markup=False,
        )


def _pass_on_warnings(processes: Processes, console: Console) -> None:
    """Print the warnings of the simulated robot: values that it has added to the URDF."""
    for line in processes.lines('simulated_robot'):
        if '[WARN]' in line:
            console.print(f'note: {line.split("]: ", 1)[-1]}', markup=False)


def _verdict(outcome: Outcome, console: Console) -> int:
    """Print the result, and return the exit code."""
    failures = outcome.failures()
    for failure in failures:
        console.print(f'demo failed: {failure}', style='bold red', markup=False)
    if not failures:
        console.print('It falls without the node and stands still with it.', style='bold green')
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
