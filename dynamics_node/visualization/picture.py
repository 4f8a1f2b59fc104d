"""`Picture`: all shapes of one robot at one state."""

from collections.abc import Sequence
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from . import colors, scale
from .bodies import BodyShapes
from .shapes import ARROW, Shape, TEXT
from .torque_arcs import TorqueArcs
from ..dynamics import Payload, RobotModel
from ..inertia import transform_pseudo_inertia
from ..model import KinematicTree

GRAVITY, PAYLOAD = 'gravity', 'payload'
# The arrow of gravity has its nominal length at this acceleration, m/s².
_EARTH = 9.81


class Picture:
    """
    Draws one robot at any number of states.

    A body is a moving link with the links fixed to it; the payload is drawn as a separate body.
    Links fixed to the base load no joint and are left out. A mimic joint has no effort of its
    own: that of its leader contains it.

    """

    def __init__(self, tree: KinematicTree, joint_names: Sequence[str]) -> None:
        """
        Prepare all that does not depend on the state.

        Parameters
        ----------
        tree : KinematicTree
        joint_names : sequence of str
            The m independent joints whose efforts are drawn.

        """
        self._scale = scale.make_scale(tree)
        self._bodies = BodyShapes(
            _link_names(tree), list(tree.inertia), range(len(tree.inertia)), self._scale
        )
        self._torques = TorqueArcs(tree, joint_names, self._scale)
        self._links = tree.links
        self._payload: Payload | None = None
        self._payload_body = self._body_of(None)

    def shapes(
        self,
        model: RobotModel,
        q: NDArray[np.float64],
        gravity_torque: NDArray[np.float64] | None,
        effort: NDArray[np.float64],
        limits: NDArray[np.float64],
    ) -> list[Shape]:
        """
        Return the shapes of one state.

        Parameters
        ----------
        model : RobotModel
            Model of the same tree, with its payload and gravity.
        q : numpy.ndarray, shape (n,)
            Joint positions, rad or m.
        gravity_torque : numpy.ndarray, shape (m,), or None
            G of the joints, N m or N, finite. None draws neither torques nor efforts.
        effort : numpy.ndarray, shape (m,)
            Measured effort of the joints, N m or N; NaN where unknown.
        limits : numpy.ndarray, shape (m,)
            Effort limits of the joints, N m or N; NaN where there is none.

        Returns
        -------
        list of Shape
            In the base frame: masses and gravity, then torques. Empty if the pose of a body is
            not finite.

        """
        poses = model.body_poses(q)
        if not np.isfinite(poses).all():
            return []
        torques = (
            ()
            if gravity_torque is None
            else self._torques.shapes(poses, gravity_torque, effort, limits)
        )
        return list(
            chain(
                self._bodies.shapes(poses),
                self._payload_shapes(model.payload).shapes(poses),
                self._gravity(model.gravity),
                torques,
            )
        )

    def _payload_shapes(self, payload: Payload | None) -> BodyShapes:
        if payload is not self._payload:
            self._payload, self._payload_body = payload, self._body_of(payload)
        return self._payload_body

    def _body_of(self, payload: Payload | None) -> BodyShapes:
        if payload is None or self._links[payload.link].body < 0:
            return BodyShapes((), (), (), self._scale)
        frame = self._links[payload.link]
        J = transform_pseudo_inertia(payload.pseudo_inertia, frame.placement)
        return BodyShapes(
            ('payload',),
            (J,),
            (frame.body,),
            self._scale,
            groups=(PAYLOAD, PAYLOAD),
            color=(colors.PAYLOAD, colors.PAYLOAD_INERTIA),
        )

    def _gravity(self, gravity: NDArray[np.float64]) -> list[Shape]:
        # Beside the base, where no body hides it.
        strength = float(np.linalg.norm(gravity))
        if strength == 0.0:
            return []
        unit_length = scale.GRAVITY * self._scale.reach
        direction = gravity / strength
        length = unit_length * min(strength / _EARTH, 2.0)
        beside = np.zeros(3)
        beside[np.argmin(np.abs(direction))] = unit_length
        start = beside - length * direction
        text_position = start - 1.5 * self._scale.text * direction
        width = 0.04 * unit_length
        return [
            Shape(
                GRAVITY,
                0,
                ARROW,
                (width, 2.5 * width, 5.0 * width),
                colors.GRAVITY,
                tuple(start.tolist()),
                points=((0.0, 0.0, 0.0), tuple((length * direction).tolist())),
            ),
            Shape(
                GRAVITY,
                1,
                TEXT,
                self._scale.text_size,
                colors.GRAVITY,
                tuple(text_position.tolist()),
                text=f'{strength:.3g} m/s^2',
            ),
        ]


def _link_names(tree: KinematicTree) -> list[str]:
    # A body takes the name of the link that its joint moves: their frames coincide.
    names: dict[int, str] = {}
    for link, frame in tree.links.items():
        names.setdefault(frame.body, link)
    return [names[k] for k in range(len(tree.inertia))]
