"""Runs Python to its end in a separate process."""

import os
import subprocess
import sys


def run_python(*arguments, **options):
    """Return the completed process of `python arguments`, with its output as text."""
    options = {'capture_output': True, 'text': True, 'check': False, **options}
    return subprocess.run([sys.executable, *map(str, arguments)], **options)


def run_tool(module, *arguments, **options):
    """Run a module of `tools/`; the process imports what the tests can import."""
    environment = {**os.environ, 'PYTHONPATH': os.pathsep.join(sys.path)}
    return run_python('-m', module, *arguments, env=environment, **options)
