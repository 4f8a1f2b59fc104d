"""
One file per library, with NAME, PACKAGE, NOTE and `calls(robot)`.

A file imports its library at the top. A library without which it cannot be imported is reported as
missing, with the reason.

"""

from importlib import import_module
from importlib.metadata import PackageNotFoundError, version

# In the order of the report.
FILES = (
    'payload',
    'general',
    'pinocchio',
    'mujoco',
    'drake',
    'kdl',
    'roboticstoolbox',
    'frax',
    'textbook',
)


def load(names=FILES):
    """
    Import the libraries that are installed.

    Parameters
    ----------
    names : sequence of str
        Files of this folder.

    Returns
    -------
    loaded : dict of str to module
    missing : dict of str to str
        Name → reason of the failed import.

    """
    loaded, missing = {}, {}
    for name in names:
        try:
            loaded[name] = import_module(f'.{name}', __name__)
        except ImportError as error:
            missing[name] = ' '.join(str(error).split())
    return loaded, missing


def version_of(package):
    """
    Return the version of an installed package, or None.

    Parameters
    ----------
    package : str

    Returns
    -------
    str or None

    """
    try:
        return version(package)
    except PackageNotFoundError:
        return None
