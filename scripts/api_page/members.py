"""The public names of the library, and the public members of its classes."""

from dataclasses import dataclass
import functools
import importlib
import inspect

LIBRARY = 'dynamics_node'

# Packages with public names, with a sentence each. All work without ROS.
PACKAGES = {
    'dynamics': 'More of the dynamics: what the node needs beside `RobotModel`.',
    'inertia': '4x4 pseudo-inertia matrices of rigid bodies.',
    'report': 'The [model report](report.md) as a library.',
    'urdf': 'URDF text in, checked plain data out.',
    'model': 'The tree of moving bodies, which `RobotModel.tree` returns.',
    'safety': 'The path from a joint state to a command, as plain classes without a clock.',
}


@dataclass(frozen=True)
class Name:
    """A public name: where it is imported from, and the object."""

    package: str
    name: str
    value: object


def library_names():
    """
    Return the public names of the library.

    Returns
    -------
    list of Name
        Classes first, then functions, then exceptions; without the version.

    """
    return sorted(_names(LIBRARY), key=_order)


def package_names(folder):
    """
    Return the public names of one of PACKAGES that are not already names of the library.

    Parameters
    ----------
    folder : str

    Returns
    -------
    list of Name

    """
    known = [entry.value for entry in library_names()]
    names = _names(f'{LIBRARY}.{folder}')
    return sorted((entry for entry in names if entry.value not in known), key=_order)


def public_members(kind):
    """
    Return the public properties and methods of a class, in the order of its source.

    Parameters
    ----------
    kind : type

    Returns
    -------
    properties, methods : dict of str: object
        Inherited ones too, if their class belongs to this library.

    """
    properties, methods = {}, {}
    for base in kind.__mro__:
        if not base.__module__.startswith(LIBRARY):
            continue
        for name, value in vars(base).items():
            if name.startswith('_') or name in properties | methods:
                continue
            if isinstance(value, property | functools.cached_property):
                properties[name] = value
            elif inspect.isfunction(value) or isinstance(value, classmethod | staticmethod):
                methods[name] = value
    return properties, methods


def _names(package):
    module = importlib.import_module(package)
    return [
        Name(package, name, getattr(module, name))
        for name in module.__all__
        if not name.startswith('_')
    ]


def _order(entry):
    """Classes, functions, exceptions; the model before all others."""
    is_class = inspect.isclass(entry.value)
    is_error = is_class and issubclass(entry.value, BaseException)
    return (entry.name != 'RobotModel', is_error, not is_class, entry.name.lower())
