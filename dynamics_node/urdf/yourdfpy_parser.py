"""yourdfpy's parser, without the mesh library that yourdfpy loads for its scenes."""

import builtins
import functools
import importlib
import importlib.util
from pathlib import Path
import sys
from types import ModuleType

# Names of our own, so that nobody who imports yourdfpy or trimesh ever meets these copies.
_PARSER = f'{__package__}._yourdfpy'
_TRIMESH = f'{__package__}._trimesh'


@functools.cache
def urdf_class():
    """
    Return the class `yourdfpy.URDF`.

    Importing yourdfpy takes more than a second, nearly all of it trimesh, networkx and scipy for
    scenes that dynamics never builds. Unless they are there already, this loads only the file
    with the parser, and of trimesh only the transformations.

    Returns
    -------
    type
        For reading descriptions; it cannot build scenes.

    """
    if 'yourdfpy' not in sys.modules:
        try:
            return _parser_alone().URDF
        except (ImportError, AttributeError, OSError):
            # Another version of yourdfpy, made up differently: the whole of it will do.
            sys.modules.pop(_PARSER, None)
    from yourdfpy import URDF

    return URDF


def _parser_alone():
    trimesh = _transformations_alone()

    def import_module(name, *arguments, **options):
        if name in ('trimesh', 'trimesh.transformations'):
            return trimesh
        return builtins.__import__(name, *arguments, **options)

    spec = importlib.util.spec_from_file_location(_PARSER, _folder('yourdfpy') / 'urdf.py')
    if spec is None or spec.loader is None:
        raise ImportError(f'expected a file urdf.py in {_folder("yourdfpy")}')
    module = importlib.util.module_from_spec(spec)
    # Only this module's import statements, and no table that others see.
    module.__dict__['__builtins__'] = {**vars(builtins), '__import__': import_module}
    sys.modules[_PARSER] = module
    spec.loader.exec_module(module)
    return module


def _transformations_alone():
    # A package with trimesh's folder, but without running its __init__.
    package = ModuleType(_TRIMESH)
    package.__path__ = [str(_folder('trimesh'))]
    # Types that yourdfpy names in annotations.
    package.Trimesh = package.Scene = object  # type: ignore[attr-defined]
    sys.modules[_TRIMESH] = package
    importlib.import_module(f'{_TRIMESH}.transformations')
    return package


def _folder(name):
    spec = importlib.util.find_spec(name)
    if spec is None or spec.origin is None:
        raise ImportError(f'expected the package {name} to be installed')
    return Path(spec.origin).parent
