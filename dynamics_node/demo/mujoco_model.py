"""From a URDF text to a compiled MuJoCo model."""

from collections.abc import Callable
import logging

import mujoco
import numpy as np

from .robot_text import Mimic, MovableJoint, mujoco_text, RobotRefusedError

TIME_STEP = 0.0005  # [s] two to four steps per joint state keep the integration error small

# MuJoCo's own handler writes MUJOCO_LOG.TXT into the current directory.
mujoco.set_mju_user_warning(logging.getLogger('mujoco').debug)


def compile_model(
    text: str, joints: list[MovableJoint], extend: Callable[[mujoco.MjSpec], None] | None = None
) -> mujoco.MjModel:
    """
    Return the MuJoCo model of a robot.

    Parameters
    ----------
    text : str
        URDF.
    joints : list of MovableJoint
        Its movable joints.
    extend : callable, optional
        Adds to the model before it is compiled.

    Raises
    ------
    RobotRefusedError
        With MuJoCo's reason.

    """
    try:
        spec = mujoco.MjSpec.from_string(mujoco_text(text))
        for joint in joints:
            if joint.mimic is not None:
                _couple(spec, joint.name, joint.mimic)
        spec.option.timestep = TIME_STEP
        if extend is not None:
            extend(spec)
        return spec.compile()
    except ValueError as error:
        if isinstance(error, RobotRefusedError):
            raise
        reason = ' '.join(str(error).split())
        raise RobotRefusedError(
            f'MuJoCo cannot simulate this robot: {reason}; python -m dynamics_node.report '
            'lists the defects of its links'
        ) from error


def mimic_map(joints: list[MovableJoint]) -> tuple[np.ndarray, np.ndarray]:
    """
    Return B (n_all, n_driven) and b (n_all,) such that all positions = B @ driven + b.

    Both follow the order of `joints`; driven joints are those without a mimic tag.

    """
    by_name = {joint.name: joint for joint in joints}
    driven = [joint.name for joint in joints if joint.mimic is None]
    matrix, offset = np.zeros((len(joints), len(driven))), np.zeros(len(joints))
    for row, joint in enumerate(joints):
        source, multiplier, offset[row] = _resolve(joint, by_name)
        matrix[row, driven.index(source)] = multiplier
    return matrix, offset


def last_link(model: mujoco.MjModel) -> int:
    """
    Return the body at the end of the arm: the last one before the fingers of a hand.

    The walk follows the heavier branch and ends where only light branches are left.

    """
    mass, body = model.body_subtreemass, 0
    while True:
        children = [b for b in range(1, model.nbody) if model.body_parentid[b] == body]
        heaviest = max(children, key=lambda child: mass[child], default=None)
        if heaviest is None or (len(children) > 1 and mass[heaviest] < 0.05 * mass[0]):
            return body
        body = heaviest


def _couple(spec: mujoco.MjSpec, name: str, mimic: Mimic) -> None:
    """Couple a mimic joint by a constraint as stiff as the time step allows."""
    equality = spec.add_equality()
    equality.type = mujoco.mjtEq.mjEQ_JOINT
    equality.name1, equality.name2 = name, mimic.source
    equality.data[:2] = mimic.offset, mimic.multiplier
    equality.solref = [2.5 * TIME_STEP, 1.0]
    equality.solimp = [0.999, 0.9999, 0.001, 0.5, 2.0]


def _resolve(joint: MovableJoint, by_name: dict[str, MovableJoint]) -> tuple[str, float, float]:
    """Return the driven joint at the end of a chain of mimic tags, with multiplier and offset."""
    name, multiplier, offset = joint.name, 1.0, 0.0
    for _ in by_name:
        mimic = by_name[name].mimic
        if mimic is None:
            return name, multiplier, offset
        if mimic.source not in by_name:
            raise RobotRefusedError(
                f'joint {name!r} mimics {mimic.source!r}, which is no movable joint'
            )
        offset += multiplier * mimic.offset
        name, multiplier = mimic.source, multiplier * mimic.multiplier
    raise RobotRefusedError(f'joint {joint.name!r} mimics itself in a circle')
