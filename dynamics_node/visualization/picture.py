"""`Picture`: all that there is to see of a robot's dynamics at one state."""

from itertools import chain

import numpy as np

from . import colors, scale
from .bodies import Bodies
from .shapes import ARROW, Shape, TEXT
from .torque_arcs import Torques
from ..inertia import transform_pseudo_inertia

GRAVITY, PAYLOAD = 'gravity', 'payload'
# m/s²: an arrow of gravity has its full length then.
_EARTH = 9.81


class Picture:
    """
    Draws one robot again and again.

    Bodies are those that joints move, each with all that is fixed to it, but without the payload,
    which is drawn as one of its own. Links fixed to the base weigh on no joint and are left out.
    A joint that mimics another one has no effort of its own: its leader's contains it.

    """

    def __init__(self, tree, joint_names):
        """
        Look at what stays the same.

        Parameters
        ----------
        tree : KinematicTree
        joint_names : sequence of str
            The m joints, of the tree's independent ones, whose efforts are drawn.

        """
        self._sizes = scale.make_sizes(tree)
        self._bodies = Bodies(
            _link_names(tree), list(tree.inertia), range(len(tree.inertia)), self._sizes
        )
        self._torques = Torques(tree, joint_names, self._sizes)
        self._links = tree.links
        self._payload = None
        self._payload_body = self._body_of(None)

    def shapes(self, model, q, gravity_torque, effort, limits):
        """
        Draw one state.

        Parameters
        ----------
        model : RobotModel
            Of the same tree, with its payload and gravity.
        q : numpy.ndarray, shape (n,)
            Joint positions, rad or m.
        gravity_torque : numpy.ndarray, shape (m,), or None
            G of the joints, N m or N, finite. None draws neither torques nor efforts.
        effort : numpy.ndarray, shape (m,)
            Another effort of the joints, N m or N; NaN where there is none.
        limits : numpy.ndarray, shape (m,)
            Largest effort of the joints, N m or N; NaN where there is none.

        Returns
        -------
        list of Shape
            In the base frame: masses and gravity, then torques. Empty where the pose of a body
            is not finite.

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
                self._carried(model.payload).shapes(poses),
                self._gravity(model.gravity.tolist()),
                torques,
            )
        )

    def _carried(self, payload):
        if payload is not self._payload:
            self._payload, self._payload_body = payload, self._body_of(payload)
        return self._payload_body

    def _body_of(self, payload):
        frame = self._links[payload.link] if payload else None
        if frame is None or frame.body < 0:
            return Bodies((), (), (), self._sizes)
        J = transform_pseudo_inertia(payload.pseudo_inertia, frame.placement)
        return Bodies(
            ('payload',),
            (J,),
            (frame.body,),
            self._sizes,
            groups=(PAYLOAD, PAYLOAD),
            color=(colors.PAYLOAD, colors.PAYLOAD_INERTIA),
        )

    def _gravity(self, gravity):
        # Beside the base, so that it is not hidden inside it.
        strength = float(np.linalg.norm(gravity))
        if strength == 0.0:
            return []
        reach, text = self._sizes.reach, self._sizes.text
        direction = np.array(gravity) / strength
        length = scale.GRAVITY * reach * min(strength / _EARTH, 2.0)
        beside = np.zeros(3)
        beside[np.argmin(np.abs(direction))] = scale.GRAVITY * reach
        start = beside - length * direction
        thick = 0.04 * scale.GRAVITY * reach
        return [
            Shape(
                GRAVITY,
                0,
                ARROW,
                (thick, 2.5 * thick, 5.0 * thick),
                colors.GRAVITY,
                tuple(start.tolist()),
                points=((0.0, 0.0, 0.0), tuple((length * direction).tolist())),
            ),
            Shape(
                GRAVITY,
                1,
                TEXT,
                self._sizes.text_size,
                colors.GRAVITY,
                tuple((start - 1.5 * text * direction).tolist()),
                text=f'{strength:.3g} m/s^2',
            ),
        ]


def _link_names(tree):
    # A body is called by the link that its joint moves, the one whose frame is the body's.
    names: dict = {}
    for link, frame in tree.links.items():
        names.setdefault(frame.body, link)
    return [names[k] for k in range(len(tree.inertia))]
