"""The host of a run: machine, versions, commit."""

import os
from pathlib import Path
import platform
import subprocess

from .libraries import version_of
from .robots import ROOT

PACKAGES = ('numpy', 'numba', 'scipy', 'example-robot-data')


def describe():
    """
    Return machine, system and versions.

    Returns
    -------
    dict of str to str

    """
    facts = {
        'CPU': f'{_cpu()}, {os.cpu_count()} cores',
        'system': _system(),
        'Python': platform.python_version(),
        'commit': commit(),
    }
    if hasattr(os, 'getloadavg'):
        facts['load at the start'] = f'{os.getloadavg()[0]:.2f} (mean of one minute)'
    facts |= {name: version_of(name) or 'not installed' for name in PACKAGES}
    return facts


def commit():
    """
    Return the commit of this checkout, and whether the measured code differs from it.

    Returns
    -------
    str

    """
    try:
        sha = _git('rev-parse', '--short=12', 'HEAD')
        changed = _git('status', '--porcelain', '--', 'dynamics_node', 'benchmarks', 'config')
    except (OSError, subprocess.CalledProcessError):
        return 'unknown (no git here)'
    return sha + (', with changes that are not committed' if changed else '')


def _git(*arguments):
    return subprocess.run(
        ['git', *arguments], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout.strip()


def _cpu():
    try:
        for line in Path('/proc/cpuinfo').read_text().splitlines():
            if line.startswith('model name'):
                return line.partition(':')[2].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


def _system():
    try:
        name = platform.freedesktop_os_release()['PRETTY_NAME']
    except (OSError, KeyError):
        name = platform.system()
    return f'{name}, {platform.machine()}'
