"""The services about D, C and G: names and positions in, matrices out."""

import time

from dynamics_interfaces.srv import (
    GetCoriolisMatrix,
    GetDynamics,
    GetGravityTorque,
    GetMassMatrix,
)
import numpy as np

from .guard import guarded_service
from .messages import from_field, to_field
from ..errors import ArgumentError, DynamicsError


class NoRobotError(DynamicsError):
    """No robot description has been accepted yet."""


class DynamicsServices:
    """
    Creates and answers the services.

    A failed request is answered with success = false, a message that says why and empty arrays.

    """

    def __init__(self, node, get_robot, parameters):
        """
        Create the services of a node.

        Parameters
        ----------
        node : rclpy.node.Node
        get_robot : callable() -> Robot or None
        parameters : Parameters

        """
        self.logger = node.get_logger()
        self._get_robot = get_robot
        self._parameters = parameters
        for kind, name, callback in (
                (GetMassMatrix, 'get_mass_matrix', self.get_mass_matrix),
                (GetCoriolisMatrix, 'get_coriolis_matrix', self.get_coriolis_matrix),
                (GetGravityTorque, 'get_gravity_torque', self.get_gravity_torque),
                (GetDynamics, 'get_dynamics', self.get_dynamics)):
            node.create_service(kind, f'~/{name}', callback)

    @guarded_service
    def get_mass_matrix(self, request, response):
        """Answer D(q)."""
        def fill(query):
            response.mass_matrix = query.block(query.model.mass_matrix(query.q))
        return self._answer(request, response, fill)

    @guarded_service
    def get_coriolis_matrix(self, request, response):
        """Answer C(q, qd) and C qd."""
        def fill(query):
            terms = query.model.dynamics(query.q, query.qd)
            response.velocity = query.part(query.qd)
            response.coriolis_matrix = query.block(terms.coriolis_matrix)
            response.coriolis_torque = query.part(terms.coriolis_matrix @ query.qd)
        return self._answer(request, response, fill)

    @guarded_service
    def get_gravity_torque(self, request, response):
        """Answer G(q)."""
        def fill(query):
            response.gravity_torque = query.part(query.model.gravity_torque(query.q))
        return self._answer(request, response, fill)

    @guarded_service
    def get_dynamics(self, request, response):
        """Answer D, C, G and the energies."""
        def fill(query):
            terms = query.model.dynamics(query.q, query.qd)
            response.velocity = query.part(query.qd)
            response.mass_matrix = query.block(terms.mass_matrix)
            response.coriolis_matrix = query.block(terms.coriolis_matrix)
            response.coriolis_torque = query.part(terms.coriolis_matrix @ query.qd)
            response.gravity_torque = query.part(terms.gravity_torque)
            response.kinetic_energy = float(_finite(query.model.kinetic_energy(query.q, query.qd)))
            response.potential_energy = float(_finite(query.model.potential_energy(query.q)))
        return self._answer(request, response, fill)

    def failed(self, response, message):
        """Make a new response the answer to a request that failed."""
        # Its arrays are empty as they are; energies are no arrays, and 0 J would be a value.
        response.success = False
        response.message = message
        for name in ('kinetic_energy', 'potential_energy'):
            if hasattr(response, name):
                setattr(response, name, np.nan)
        return response

    def _answer(self, request, response, fill):
        try:
            robot = self._get_robot()
            if robot is None:
                raise NoRobotError('no robot description yet: publish robot_description, or set '
                                   'the parameter robot_description_file')
            query = _Query(robot, request, self._parameters['state_timeout'])
            fill(query)
        except DynamicsError as error:
            return self.failed(type(response)(), str(error))
        response.joint_names = query.names
        response.position = query.part(query.q)
        response.success = True
        response.message = query.message
        return response


def _finite(values):
    if not np.isfinite(values).all():
        raise ArgumentError('the result is not finite: positions or velocities are too large')
    return values


class _Query:
    """One request, resolved: the state of all joints and the wanted order."""

    def __init__(self, robot, request, timeout):
        selection = robot.selection
        self.model = robot.model
        if request.joint_names:
            order = selection.permutation(request.joint_names)
            self.names = [selection.names[i] for i in order]
            self._index = selection.index[order]
        else:
            self.names, self._index = list(selection.names), selection.index
        self._has_all_in_order = robot.has_all_in_order and not request.joint_names
        if len(request.position):
            self.q = robot.buffer.position
            self.q[self._index] = self._checked('position', request.position)
            self.message = 'at the given position'
        else:
            self.q = robot.measured_position(time.monotonic(), timeout)
            self.message = 'at the newest measured position'
        self.qd = np.zeros(self.q.size)
        if hasattr(request, 'velocity'):
            if len(request.velocity):
                self.qd[self._index] = self._checked('velocity', request.velocity)
            else:
                self.message += ', velocity zero'

    def part(self, vector):
        """Return the entries of the wanted joints of a vector of all joints."""
        return to_field(_finite(vector if self._has_all_in_order else vector[self._index]))

    def block(self, matrix):
        """Return rows and columns of the wanted joints of a matrix of all joints."""
        if not self._has_all_in_order:
            matrix = matrix[np.ix_(self._index, self._index)]
        return to_field(_finite(matrix))

    def _checked(self, name, field):
        values = from_field(field)
        if values.size != len(self.names):
            raise ArgumentError(f'{name}: expected {len(self.names)} values for '
                                f'{", ".join(self.names)}, or none; got {values.size}')
        if not np.isfinite(values).all():
            raise ArgumentError(f'{name}: expected finite values, got {values.tolist()}')
        return values
