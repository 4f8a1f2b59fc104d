"""MuJoCo's viewer of the simulated robot: floor, sky, light, and a camera that frames the arm."""

import os
import sys
from typing import Any

import mujoco
import numpy as np

from .mujoco_arm import MujocoArm
from .poses import random_poses
from .robot_text import RobotRefusedError

SAMPLES = 200  # poses that the size of the scene is taken from
FLOOR, PEDESTAL = 'viewer floor', 'viewer pedestal'
AZIMUTH, ELEVATION = 125.0, -15.0  # [deg]


def check_display() -> None:
    """Raise RobotRefusedError if there is no display for the viewer."""
    on_linux = sys.platform.startswith('linux')
    if on_linux and not (os.environ.get('DISPLAY') or os.environ.get('WAYLAND_DISPLAY')):
        raise RobotRefusedError(
            'the viewer needs a display, and neither DISPLAY nor WAYLAND_DISPLAY is set; run '
            'without VIEW=1 or --view'
        )


def open_viewer(arm: MujocoArm) -> Any:
    """
    Return a passive viewer of a running simulation, with sync() and close().

    The arm has been built with `add_scenery`.

    Raises
    ------
    RobotRefusedError
        If there is no display.

    """
    check_display()
    from mujoco import viewer  # imports GLFW, which complains where there is no display

    size = arrange_scenery(arm)
    handle = viewer.launch_passive(arm.model, arm.data, show_left_ui=False, show_right_ui=False)
    with handle.lock():
        aim(handle.cam, size)
    return handle


def aim(camera: mujoco.MjvCamera, size: float) -> None:
    """Let a camera see all of an arm that reaches `size` [m] from its base."""
    camera.type = mujoco.mjtCamera.mjCAMERA_FREE
    camera.lookat[:] = 0.0, 0.0, 0.25 * size
    camera.distance, camera.azimuth, camera.elevation = 2.0 * size, AZIMUTH, ELEVATION


def add_scenery(spec: mujoco.MjSpec) -> None:
    """Add sky, light, floor and pedestal to a model; none of them touches the arm."""
    spec.visual.headlight.ambient = [0.35, 0.35, 0.35]
    spec.visual.headlight.diffuse = [0.35, 0.35, 0.35]
    spec.visual.headlight.specular = [0.1, 0.1, 0.1]
    _add_texture(spec, 'sky', mujoco.mjtTexture.mjTEXTURE_SKYBOX, [0.62, 0.75, 0.9], [1, 1, 1])
    _add_texture(
        spec, 'tiles', mujoco.mjtTexture.mjTEXTURE_2D, [0.78, 0.8, 0.83], [0.86, 0.88, 0.9]
    )
    material = spec.add_material(name='floor', texrepeat=[1.0, 1.0], texuniform=True)
    material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = 'tiles'
    spec.worldbody.add_light(
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        pos=[1.0, -2.0, 4.0],
        dir=[-0.3, 0.5, -1.0],
        diffuse=[0.5, 0.5, 0.5],
    )
    untouchable = {'contype': 0, 'conaffinity': 0, 'mass': 0.0}
    spec.worldbody.add_geom(
        name=FLOOR,
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[0.0, 0.0, 1.0],
        material='floor',
        **untouchable,
    )
    spec.worldbody.add_geom(
        name=PEDESTAL,
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        size=[0.1, 0.1, 0.0],
        rgba=[0.45, 0.47, 0.5, 1.0],
        **untouchable,
    )


def arrange_scenery(arm: MujocoArm) -> float:
    """Put the floor below all poses and the pedestal under the base; return the reach [m]."""
    points = np.vstack([arm.skeleton(pose) for pose in random_poses(arm, SAMPLES)])
    reach = max(float(np.linalg.norm(points, axis=1).max()), 0.01)
    depth = -min(float(points[:, 2].min()), 0.0) + 0.02 * reach
    model = arm.model
    model.geom(FLOOR).pos[2] = -depth
    model.geom(PEDESTAL).pos[2] = -depth / 2
    model.geom(PEDESTAL).size[:2] = 0.08 * reach, depth / 2
    return reach


def _add_texture(
    spec: mujoco.MjSpec, name: str, kind: int, one: list[float], other: list[float]
) -> None:
    is_sky = kind == mujoco.mjtTexture.mjTEXTURE_SKYBOX
    builtin = mujoco.mjtBuiltin
    spec.add_texture(
        name=name,
        type=kind,
        builtin=builtin.mjBUILTIN_GRADIENT if is_sky else builtin.mjBUILTIN_CHECKER,
        rgb1=one,
        rgb2=other,
        width=256,
        height=256 * 6 if is_sky else 256,
    )
