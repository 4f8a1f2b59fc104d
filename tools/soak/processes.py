"""`RigProcesses`: processes that receive signals and are measured."""

import os
from pathlib import Path
import signal

from dynamics_node.demo.processes import Processes


class RigProcesses(Processes):
    """Starts, signals, measures and ends processes by name."""

    def environment(self):
        """Return an environment in which Python finds this package."""
        environment = super().environment()
        folders = [str(Path(__file__).parents[1]), environment.get('PYTHONPATH', '')]
        return dict(environment, PYTHONPATH=os.pathsep.join(filter(None, folders)))

    def send(self, name, number):
        """Send a signal."""
        self._running[name].send_signal(number)

    def is_running(self, name):
        """Return whether a process was started and has not ended."""
        return name in self._running and self._running[name].poll() is None

    def end(self, name, number=signal.SIGINT, timeout=10.0):
        """Send a signal and wait for the end; return the exit code."""
        process = self._running[name]
        process.send_signal(number)
        return process.wait(timeout)

    def vitals(self, name):
        """
        Return the resources of a process.

        Returns
        -------
        dict
            'memory': resident, MB; 'files': open ones; 'threads'.

        """
        folder = Path('/proc') / str(self._running[name].pid)
        fields = dict(line.split(':', 1) for line in (folder / 'status').read_text().splitlines())
        return {
            'memory': int(fields['VmRSS'].split()[0]) / 1024,
            'files': len(list((folder / 'fd').iterdir())),
            'threads': int(fields['Threads']),
        }

    def __exit__(self, *error):
        """Continue stopped processes, and end all."""
        for process in self._running.values():
            if process.poll() is None:
                process.send_signal(signal.SIGCONT)
        super().__exit__(*error)
