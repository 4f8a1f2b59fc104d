"""Offscreen pictures of an arm by MuJoCo, with a transparent background."""

import os
from pathlib import Path

# Before the import of mujoco, which chooses its OpenGL.
os.environ.setdefault('MUJOCO_GL', 'egl')

from dynamics_node.demo.robot_text import mujoco_text
import mujoco
import numpy as np

# Factor of the rendered size, averaged for smooth edges.
OVERSAMPLING = 3
PLATE_RADIUS, PLATE_HEIGHT = 0.16, 0.03  # m, of the base plate


class NoOpenGLError(RuntimeError):
    """No offscreen OpenGL; the message names the package to install."""


class ArmRenderer:
    """Renders a robot from one camera, as RGBA with a transparent background."""

    def __init__(self, path, width, height, lookat, distance, azimuth=90.0, elevation=-12.0):
        """
        Open the renderer.

        Parameters
        ----------
        path : Path
            URDF file; its visual shapes are drawn, meshes are not.
        width, height : int
            Size of the pictures, pixels.
        lookat : sequence of 3 floats
            Center of the view, m, in the frame of the root link.
        distance : float
            Distance of the camera from there, m.
        azimuth, elevation : float
            Direction of the camera, degrees.

        Raises
        ------
        NoOpenGLError
            If there is no offscreen OpenGL.

        """
        spec = mujoco.MjSpec.from_string(mujoco_text(Path(path).read_text(encoding='utf-8')))
        _add_scenery(spec)
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self._camera = mujoco.MjvCamera()
        self._camera.lookat[:], self._camera.distance = lookat, distance
        self._camera.azimuth, self._camera.elevation = azimuth, elevation
        size = height * OVERSAMPLING, width * OVERSAMPLING
        self.model.vis.global_.offheight, self.model.vis.global_.offwidth = size
        try:
            self._renderer = mujoco.Renderer(self.model, *size)
        except Exception as error:  # depends on the OpenGL implementation
            raise NoOpenGLError(
                'MuJoCo cannot render here with MUJOCO_GL='
                f'{os.environ["MUJOCO_GL"]} ({error}); install libegl1 (then '
                'MUJOCO_GL=egl) or libosmesa6 (then MUJOCO_GL=osmesa)'
            ) from error

    def close(self):
        """Free the OpenGL context."""
        self._renderer.close()

    def frame(self, position):
        """
        Render the arm at a position.

        Parameters
        ----------
        position : dict of str to float
            Position of each movable joint, rad or m.

        Returns
        -------
        ndarray, shape (height, width, 4)
            RGBA, 0 to 1; alpha is the share of a pixel covered by the arm.

        """
        for name, value in position.items():
            self.data.qpos[self.model.joint(name).qposadr[0]] = value
        mujoco.mj_forward(self.model, self.data)
        self._renderer.update_scene(self.data, self._camera)
        color = self._renderer.render().astype(float) / 255.0
        self._renderer.enable_segmentation_rendering()
        self._renderer.update_scene(self.data, self._camera)
        covered = (self._renderer.render()[:, :, 0] >= 0).astype(float)[:, :, None]
        self._renderer.disable_segmentation_rendering()
        alpha = _averaged(covered)
        # The color of the covered part alone: no fringe of the background.
        return np.concatenate((_averaged(color * covered) / np.maximum(alpha, 1e-9), alpha), 2)


def over(picture, frame, opacity=1.0):
    """
    Lay a frame over a picture.

    Parameters
    ----------
    picture : ndarray, shape (height, width, 3)
        RGB, 0 to 1.
    frame : ndarray, shape (height, width, 4)
        From `ArmRenderer.frame`.
    opacity : float

    Returns
    -------
    ndarray, shape (height, width, 3)

    """
    alpha = opacity * frame[:, :, 3:]
    return picture * (1.0 - alpha) + frame[:, :, :3] * alpha


def _averaged(picture):
    """Average squares of OVERSAMPLING pixels, shape (h k, w k, c) → (h, w, c)."""
    height, width, channels = picture.shape
    k = OVERSAMPLING
    return picture.reshape(height // k, k, width // k, k, channels).mean((1, 3))


def _add_scenery(spec):
    """Add lights and a base plate."""
    spec.visual.headlight.ambient = [0.45, 0.45, 0.45]
    spec.visual.headlight.diffuse = [0.25, 0.25, 0.25]
    spec.visual.headlight.specular = [0.1, 0.1, 0.1]
    light = spec.worldbody.add_light()
    light.pos, light.dir = [1.0, -2.0, 3.0], [-0.3, 0.6, -1.0]
    light.type = mujoco.mjtLightType.mjLIGHT_DIRECTIONAL
    light.diffuse, light.castshadow = [0.5, 0.5, 0.5], False
    plate = spec.worldbody.add_geom()
    plate.type = mujoco.mjtGeom.mjGEOM_CYLINDER
    plate.size = [PLATE_RADIUS, PLATE_HEIGHT / 2, 0.0]
    plate.pos, plate.rgba = [0.0, 0.0, -PLATE_HEIGHT / 2], [0.62, 0.64, 0.68, 1.0]
