"""Declaration of the services about the robot: success, refusal, state of a request."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import functools
from typing import Any

import numpy as np

from .query import Query
from ..context import NodeContext
from ..parameters.table import ParameterError
from ..support.callback_errors import guarded_service
from ..torque_path.active_robot import ActiveRobot
from ...errors import DynamicsError

# Scalar response fields: NaN in a refusal, because 0 would be a valid value.
_NUMBERS = ('kinetic_energy', 'potential_energy', 'mass')


class NoRobotError(DynamicsError):
    """No robot description has been accepted yet."""


class RobotServices:
    """
    A group of services: its methods decorated with `service` or `state_service`.

    A refused request gets success = false, the reason as message, and empty arrays.

    Attributes
    ----------
    context : NodeContext
    parameters : Parameters

    """

    def __init__(self, context: NodeContext) -> None:
        self.context = context
        self.parameters = context.parameters
        self.logger = context.logger
        for name, kind, _ in self.declared():
            context.node.create_service(kind, f'~/{name}', getattr(self, name))

    @classmethod
    def declared(cls) -> Iterator[tuple[str, type, str]]:
        """Yield the name, the type and the docstring of every service of this group."""
        for name, method in vars(cls).items():
            if kind := getattr(method, 'service_type', None):
                yield name, kind, method.__doc__ or ''

    def robot(self) -> ActiveRobot:
        """
        Return the robot in force.

        Raises
        ------
        NoRobotError
            If there is none yet.

        """
        if self.context.robot is None:
            raise NoRobotError(
                'no robot description yet: publish robot_description, or set the '
                'parameter robot_description_file'
            )
        return self.context.robot

    def failed(self, response: Any, message: str) -> Any:
        """Return an empty response, filled as a refusal."""
        response.success = False
        response.message = message
        for name in _NUMBERS:
            if hasattr(response, name):
                setattr(response, name, np.nan)
        return self.completed(response)

    def completed(self, response: Any) -> Any:
        """Complete a response, also a refusal; unchanged by default."""
        return response


def service(kind: type) -> Callable:
    """
    Declare a method of `RobotServices` as the service `~/<its name>`.

    The method takes request and response, fills the response and returns its message.
    DynamicsError and ParameterError become the refusal. Its docstring is "Answer ...".

    Parameters
    ----------
    kind : type
        Service type.

    """

    def declare(method: Callable) -> Callable:
        @guarded_service
        @functools.wraps(method)
        def answer(self: RobotServices, request: Any, response: Any) -> Any:
            try:
                response.message = method(self, request, response)
            except (DynamicsError, ParameterError) as error:
                return self.failed(kind.Response(), str(error))  # type: ignore[attr-defined]
            response.success = True
            return self.completed(response)

        answer.service_type = kind
        return answer

    return declare


def state_service(kind: type) -> Callable:
    """
    Declare a method of `RobotServices` as the service `~/<its name>` about one state.

    The method takes the resolved `Query`, request and response. Joint names, state and message
    of the response are filled here. Its docstring is "Answer ...".

    Parameters
    ----------
    kind : type
        Service type.

    """

    def declare(method: Callable) -> Callable:
        @functools.wraps(method)
        def about_state(self: RobotServices, request: Any, response: Any) -> str:
            query = Query(self.robot(), request, self.parameters['state_timeout'])
            method(self, query, request, response)
            response.joint_names = query.names
            response.position = query.part(query.q)
            if hasattr(response, 'velocity'):
                response.velocity = query.part(query.qd)
            return query.message + query.unseen

        return service(kind)(about_state)

    return declare
