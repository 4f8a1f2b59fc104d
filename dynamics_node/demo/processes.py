"""The child processes of the demo, each with a log, and the URDF files that it starts with."""

import os
from pathlib import Path
import signal
import subprocess
import sys
import tempfile
from types import TracebackType

from ament_index_python.packages import get_package_share_directory, PackageNotFoundError

from .robot_text import RobotRefusedError

END_TIMEOUT = 5.0  # [s] after SIGINT; the node takes up to 3 s to ramp down
TAIL = 15  # lines of each log printed after a failure


class DemoError(RuntimeError):
    """The demo failed; the message states the reason in one sentence."""


class Processes:
    """A context that starts Python modules as processes, and ends them at its exit."""

    def __init__(self) -> None:
        self._running: dict[str, subprocess.Popen] = {}
        self._folder = tempfile.TemporaryDirectory(prefix='dynamics_node_demo_')

    def __enter__(self) -> 'Processes':
        """Enter the context."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """End all processes, the last started first, and delete their logs."""
        for name in reversed(list(self._running)):
            self._end(self._running[name])
        self._folder.cleanup()

    def start(self, name: str, module: str, *arguments: str) -> None:
        """Start `python -m module arguments` under a name."""
        with self._log(name).open('wb') as log:
            # A separate session: Ctrl-C in the terminal reaches the demo alone, which then ends
            # the processes in the right order.
            self._running[name] = subprocess.Popen(
                [sys.executable, '-m', module, *arguments],
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=subprocess.STDOUT,
                start_new_session=True,
                env=self.environment(),
            )

    def environment(self) -> dict[str, str]:
        """Return the environment of the processes: unbuffered, so that their logs are current."""
        return dict(os.environ, PYTHONUNBUFFERED='1')

    def check(self) -> None:
        """Raise DemoError if a process has ended by itself."""
        for name, process in self._running.items():
            if process.poll() is not None:
                raise DemoError(
                    f'{name} ended by itself with exit code {process.returncode}; its log is above'
                )

    def tails(self) -> dict[str, list[str]]:
        """Return the last lines of each log."""
        return {name: self.lines(name)[-TAIL:] for name in self._running}

    def lines(self, name: str) -> list[str]:
        """Return the lines that a process has printed so far."""
        return self._log(name).read_text(encoding='utf-8', errors='replace').splitlines()

    def _log(self, name: str) -> Path:
        """Return the path of a process's log."""
        return Path(self._folder.name) / f'{name}.log'

    @staticmethod
    def _end(process: subprocess.Popen) -> None:
        """End a process as Ctrl-C does; kill it after END_TIMEOUT."""
        if process.poll() is None:
            process.send_signal(signal.SIGINT)
        try:
            process.wait(END_TIMEOUT)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


ARM7 = Path('config') / 'robots' / 'arm7.urdf'


def arm7_path() -> Path:
    """Return the path of arm7.urdf."""
    try:
        installed = Path(get_package_share_directory('dynamics_node')) / ARM7
    except PackageNotFoundError:
        installed = None
    if installed is not None and installed.is_file():
        return installed
    return Path(__file__).resolve().parents[2] / ARM7


def read_robot(path: Path) -> str:
    """Return the text of a URDF file."""
    try:
        return path.read_text(encoding='utf-8')
    except (OSError, UnicodeDecodeError) as error:
        raise RobotRefusedError(f'cannot read the robot description {path}: {error}') from error
