"""The services that set payload and gravity."""

import time
from typing import Any

from dynamics_interfaces.srv import SetGravity, SetPayload
import numpy as np

from .base import RobotServices, service
from ..parameters.table import ParameterError
from ...dynamics.arguments import check_link
from ...errors import ArgumentError

_TENSOR = ('ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz')
# Parameter names in a refusal → the fields of the request.
_FIELDS = {
    'payload.link': 'link',
    'payload.mass': 'inertia.m',
    'payload.com': 'inertia.com',
    'payload.inertia': 'inertia.ixx to izz',
    'payload com': 'inertia.com',
    'payload inertia': 'inertia.ixx to izz',
}
# Range of gravity on the surface of the earth, m/s².
_LEAST, _MOST = 9.76, 9.84


class PayloadGravityServices(RobotServices):
    """
    The services ~/set_payload and ~/set_gravity.

    Both set parameters: the values in force can be read there, and are checked in one place.

    """

    @service(SetPayload)
    def set_payload(self, request: Any, response: Any) -> str:
        """Answer the payload in force; m = 0 removes it."""
        robot, inertia = self.robot(), request.inertia
        com = (inertia.com.x, inertia.com.y, inertia.com.z)
        six = tuple(getattr(inertia, name) for name in _TENSOR)
        link, mass = request.link, inertia.m
        if mass == 0.0:
            link, com, six = '', (0.0,) * 3, (0.0,) * 6
        elif not link:
            raise ArgumentError(
                'link: expected the one that carries the payload, got none: '
                f'one of {", ".join(robot.model.link_names)}'
            )
        else:
            check_link(robot.model.tree.links, link)
        self._set_payload(link, mass, com, six)
        if not mass:
            return 'nothing is carried'
        if robot.model.tree.links[link].body < 0:
            return f'{mass:g} kg on {link}, which no joint moves: without any effect'
        over = robot.over_limits(self.parameters.values)
        return f'{mass:g} kg on {link}' + (
            f', but gravity torque is above its limit: {over}' if over else ''
        )

    @service(SetGravity)
    def set_gravity(self, request: Any, response: Any) -> str:
        """Answer gravity in force; it points to the earth, in the frame of any link."""
        robot, frame = self.robot(), request.gravity.header.frame_id
        vector = request.gravity.vector
        gravity = np.array([vector.x, vector.y, vector.z])
        if not np.isfinite(gravity).all():
            raise ArgumentError(f'gravity: expected finite numbers, got {gravity.tolist()}')
        if not gravity.any():
            raise ArgumentError(
                'gravity: expected a vector that points to the earth, got '
                'zero; for none at all set the parameter gravity'
            )
        if frame not in ('', robot.model.tree.root):
            gravity = self._turned(robot, frame, gravity)
        self.parameters.set({'gravity': tuple(gravity.tolist())})
        size = float(np.linalg.norm(gravity))
        return f'gravity is {size:.6g} m/s^2 along this vector' + (
            ''
            if _LEAST <= size <= _MOST
            else ', which is not that of the earth: its length counts too'
        )

    def completed(self, response: Any) -> Any:
        """Add the payload or the gravity in force to a response, also to a refusal."""
        if isinstance(response, SetPayload.Response):
            return self._with_payload(response)
        if isinstance(response, SetGravity.Response):
            return self._with_gravity(response)
        return response

    def _set_payload(self, link, mass, com, six):
        values = {'link': link, 'mass': mass, 'com': com, 'inertia': six}
        try:
            self.parameters.set({f'payload.{name}': value for name, value in values.items()})
        except ParameterError as error:
            raise ParameterError(_with_fields(str(error))) from error

    def _turned(self, robot, frame, vector):
        check_link(robot.model.tree.links, frame, 'header.frame_id')
        timeout = self.parameters['state_timeout']
        # The joints between base and frame must be measured, also those outside `joints`.
        if stale := robot.buffer.stale_joints(
            time.monotonic(), timeout, robot.model.tree.supporting_joints(frame)
        ):
            raise ArgumentError(
                f'header.frame_id: how {frame} is turned is not known: no joint '
                f'state within {timeout:g} s for {", ".join(stale)}; publish '
                'joint_states, or give gravity in the frame of the root link'
            )
        return robot.model.link_pose(robot.buffer.position, frame)[:3, :3] @ vector

    def _with_payload(self, response):
        robot = self.context.robot
        payload = robot.model.payload if robot else None
        if payload is not None:
            response.link, response.inertia.m = payload.link, payload.mass
            com = response.inertia.com
            com.x, com.y, com.z = payload.com.tolist()
            for name, value in zip(
                _TENSOR, payload.inertia[np.triu_indices(3)].tolist(), strict=True
            ):
                setattr(response.inertia, name, value)
        return response

    def _with_gravity(self, response):
        robot = self.context.robot
        if robot is not None:
            stamped = response.gravity
            stamped.header.frame_id = robot.model.tree.root
            stamped.vector.x, stamped.vector.y, stamped.vector.z = robot.model.gravity.tolist()
        return response


def _with_fields(text):
    for parameter, field in _FIELDS.items():
        text = text.replace(parameter, field)
    return text
