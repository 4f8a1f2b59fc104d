"""The MuJoCo viewer, for people who want to watch."""

import os
import sys
from typing import Any

import mujoco

from .robot_text import RobotRefusedError


def open_viewer(model: mujoco.MjModel, data: mujoco.MjData) -> Any:
    """Return a passive viewer of a running simulation, with sync() and close()."""
    on_linux = sys.platform.startswith('linux')
    if on_linux and not (os.environ.get('DISPLAY') or os.environ.get('WAYLAND_DISPLAY')):
        raise RobotRefusedError(
            'the viewer needs a display, and neither DISPLAY nor WAYLAND_DISPLAY is set; run '
            'without VIEW=1 or --view'
        )
    from mujoco import viewer  # imports GLFW, which complains where there is no display

    return viewer.launch_passive(model, data, show_left_ui=False, show_right_ui=False)
