"""What all services about the robot have in common: how they answer, and how they refuse."""

import numpy as np

from ..parameters.table import ParameterError
from ...errors import DynamicsError

# Numbers that are no arrays: 0 would be a value.
_NUMBERS = ('kinetic_energy', 'potential_energy', 'mass')


class NoRobotError(DynamicsError):
    """No robot description has been accepted yet."""


class Answering:
    """
    A group of services that answer success, message and, if it succeeded, the rest.

    A request that fails is answered with success = false, a message that says why and empty
    arrays.

    """

    def __init__(self, node, get_robot, parameters):
        """
        Keep what every service needs.

        Parameters
        ----------
        node : rclpy.node.Node
        get_robot : callable() -> Robot or None
        parameters : Parameters

        """
        self.logger = node.get_logger()
        self.parameters = parameters
        self._get_robot = get_robot
        self._node = node

    def serve(self, kind, name, callback):
        """
        Create a private service.

        Parameters
        ----------
        kind : type
            Of the service.
        name : str
        callback : callable(request, response) -> response

        """
        self._node.create_service(kind, f'~/{name}', callback)

    def robot(self):
        """
        Return the robot in force.

        Raises
        ------
        NoRobotError
            If there is none yet; says what to do.

        """
        robot = self._get_robot()
        if robot is None:
            raise NoRobotError(
                'no robot description yet: publish robot_description, or set the '
                'parameter robot_description_file'
            )
        return robot

    def failed(self, response, message):
        """Make a new response the answer to a request that failed."""
        response.success = False
        response.message = message
        for name in _NUMBERS:
            if hasattr(response, name):
                setattr(response, name, np.nan)
        return response

    def answer(self, response, fill):
        """
        Answer a request.

        Parameters
        ----------
        response : object
            Of the service.
        fill : callable() -> str
            Fills the response and returns its message, or raises DynamicsError or
            ParameterError.

        Returns
        -------
        object
            The response, or a new one that says why not.

        """
        try:
            response.message = fill()
        except (DynamicsError, ParameterError) as error:
            return self.failed(type(response)(), str(error))
        response.success = True
        return response
