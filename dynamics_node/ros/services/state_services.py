"""The services about one state: names and positions in, matrices and efforts out."""

from dynamics_interfaces.srv import (
    ForwardDynamics,
    GetCoriolisMatrix,
    GetDynamics,
    GetGravityTorque,
    GetJacobian,
    GetMassMatrix,
    InverseDynamics,
)
from geometry_msgs.msg import Point, Pose, Quaternion
import numpy as np

from .base import Answering
from .query import finite, Query
from ..support.callback_errors import guarded_service
from ...dynamics import forward_dynamics_locked
from ...errors import ArgumentError


class DynamicsServices(Answering):
    """Creates and answers the services that ask about one state."""

    def __init__(self, node, get_robot, parameters):
        """Create the services of a node; see `Answering`."""
        super().__init__(node, get_robot, parameters)
        for kind, name in (
            (GetMassMatrix, 'get_mass_matrix'),
            (GetCoriolisMatrix, 'get_coriolis_matrix'),
            (GetGravityTorque, 'get_gravity_torque'),
            (GetDynamics, 'get_dynamics'),
            (InverseDynamics, 'inverse_dynamics'),
            (ForwardDynamics, 'forward_dynamics'),
            (GetJacobian, 'get_jacobian'),
        ):
            self.serve(kind, name, getattr(self, name))

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
            response.mass_matrix = query.block(terms.mass_matrix)
            response.coriolis_matrix = query.block(terms.coriolis_matrix)
            response.coriolis_torque = query.part(terms.coriolis_matrix @ query.qd)
            response.gravity_torque = query.part(terms.gravity_torque)
            response.kinetic_energy = float(finite(query.model.kinetic_energy(query.q, query.qd)))
            response.potential_energy = float(finite(query.model.potential_energy(query.q)))

        return self._answer(request, response, fill)

    @guarded_service
    def inverse_dynamics(self, request, response):
        """Answer D qdd + C qd + G."""

        def fill(query):
            model, qdd = query.model, query.whole('acceleration', request.acceleration)
            effort = model.inverse_dynamics(query.q, query.qd, qdd)
            if request.without_gravity:
                effort = effort - model.gravity_torque(query.q)
                query.message += ', without gravity'
            if request.with_friction:
                effort = effort + model.friction_torque(query.qd)
                query.message += ', with friction'
            response.acceleration = query.part(qdd)
            response.effort = query.part(effort)

        return self._answer(request, response, fill)

    @guarded_service
    def forward_dynamics(self, request, response):
        """Answer the accelerations that efforts cause."""

        def fill(query):
            model, given = query.model, query.whole('effort', request.effort)
            effort = given
            if request.with_friction:
                effort = given - model.friction_torque(query.qd)
                query.message += ', with friction'
            response.effort = query.part(given)
            response.acceleration = query.part(
                forward_dynamics_locked(model, query.index, query.q, query.qd, effort)
            )

        return self._answer(request, response, fill)

    @guarded_service
    def get_jacobian(self, request, response):
        """Answer the Jacobian of a point of a link, and where they are."""

        def fill(query):
            model, link = query.model, request.link or query.model.tip_link
            point = np.array([request.point.x, request.point.y, request.point.z])
            if not np.isfinite(point).all():
                raise ArgumentError(f'point: expected finite numbers, m, got {point.tolist()}')
            response.jacobian = query.columns(model.jacobian(query.q, link, point))
            response.link, response.frame_id = link, model.tree.root
            response.pose = _pose(model.link_pose(query.q, link), point)
            query.message += f', link {link}'

        return self._answer(request, response, fill)

    def _answer(self, request, response, fill):
        def fill_all():
            query = Query(self.robot(), request, self.parameters['state_timeout'])
            fill(query)
            response.joint_names = query.names
            response.position = query.part(query.q)
            if hasattr(response, 'velocity'):
                response.velocity = query.part(query.qd)
            return query.message + query.unseen

        return self.answer(response, fill_all)


def _pose(transform, point):
    # scipy is imported by another thread when the node starts: see `main`.
    from scipy.spatial.transform import Rotation

    x, y, z = finite(transform[:3, :3] @ point + transform[:3, 3]).tolist()
    qx, qy, qz, qw = Rotation.from_matrix(transform[:3, :3]).as_quat().tolist()
    return Pose(position=Point(x=x, y=y, z=z), orientation=Quaternion(x=qx, y=qy, z=qz, w=qw))
