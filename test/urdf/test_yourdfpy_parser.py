"""The parser without its mesh library: reads the same, and nobody else notices."""

from pathlib import Path
import subprocess
import sys

from dynamics_node.urdf import yourdfpy_parser
import numpy as np
import pytest
from support.robots import ARM7, PENDULUM, public_robot

ROOT = Path(__file__).parents[2]
BOX = (
    '<robot name="box"><link name="base"><visual><geometry><box size="1 2 3"/></geometry>'
    '</visual></link></robot>'
)


def run(code):
    """Run code in a fresh Python."""
    return subprocess.run(
        [sys.executable, '-c', code], capture_output=True, text=True, cwd=ROOT, check=False
    )


def test_reading_a_robot_loads_no_mesh_library():
    done = run(
        'import sys; from dynamics_node.urdf import read_urdf\n'
        f'read_urdf({str(ARM7)!r})\n'
        'print(sorted({"trimesh", "networkx", "scipy", "yourdfpy"} & set(sys.modules)))'
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == '[]\n'


def test_whoever_imports_yourdfpy_afterwards_gets_the_whole_of_it():
    done = run(
        'import io; from dynamics_node.urdf import read_urdf\n'
        f'read_urdf({str(ARM7)!r})\n'
        'import trimesh, yourdfpy\n'
        f'robot = yourdfpy.URDF.load(io.BytesIO({BOX.encode()!r}))\n'
        'assert isinstance(robot.scene, trimesh.Scene)\n'
        'print(robot.scene.extents.tolist())'
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == '[1.0, 2.0, 3.0]\n'


def test_a_program_that_has_yourdfpy_already_uses_that_one():
    done = run(
        'import sys, yourdfpy\n'
        'from dynamics_node.urdf.yourdfpy_parser import urdf_class\n'
        'assert urdf_class() is yourdfpy.URDF'
    )
    assert done.returncode == 0, done.stderr


def test_a_yourdfpy_that_is_made_up_differently_is_loaded_whole(monkeypatch):
    def missing(name):
        raise ImportError(name)

    import yourdfpy

    monkeypatch.delitem(sys.modules, 'yourdfpy')
    monkeypatch.setattr(yourdfpy_parser, '_folder', missing)
    assert yourdfpy_parser.urdf_class.__wrapped__().__name__ == yourdfpy.URDF.__name__


# Among them mimic joints and meshes.
PUBLIC = (
    'panda_description/urdf/panda.urdf',
    'ur_description/urdf/ur5_robot.urdf',
    'baxter_description/urdf/baxter.urdf',
    'tiago_description/robots/tiago.urdf',
    'icub_description/robots/icub.urdf',
    'g1_description/urdf/g1_29dof_rev_1_0.urdf',
)


@pytest.mark.parametrize('name', ['arm7', 'pendulum', *PUBLIC])
def test_both_read_the_same(name):
    import yourdfpy

    path = {'arm7': ARM7, 'pendulum': PENDULUM}.get(name) or public_robot(name)
    alone = yourdfpy_parser._parser_alone().URDF
    assert alone is not yourdfpy.URDF
    with np.printoptions(floatmode='unique', threshold=sys.maxsize):
        read = [
            repr(parser.load(str(path), build_scene_graph=False, load_meshes=False).robot)
            for parser in (alone, yourdfpy.URDF)
        ]
    assert read[0] == read[1]
    assert len(read[0]) > 500
