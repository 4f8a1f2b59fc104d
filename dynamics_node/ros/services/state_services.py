"""The services about one state: names and positions in, matrices and efforts out."""

from typing import Any

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
from numpy.typing import NDArray

from .base import RobotServices, state_service
from .query import finite, Query
from ...dynamics import forward_dynamics_locked
from ...errors import ArgumentError


class StateServices(RobotServices):
    """The services about one state."""

    @state_service(GetMassMatrix)
    def get_mass_matrix(self, query: Query, request: Any, response: Any) -> None:
        """Answer D."""
        response.mass_matrix = query.block(query.model.mass_matrix(query.q))

    @state_service(GetCoriolisMatrix)
    def get_coriolis_matrix(self, query: Query, request: Any, response: Any) -> None:
        """Answer C and C q̇."""
        terms = query.model.dynamics(query.q, query.qd)
        response.coriolis_matrix = query.block(terms.coriolis_matrix)
        response.coriolis_torque = query.part(terms.coriolis_matrix @ query.qd)

    @state_service(GetGravityTorque)
    def get_gravity_torque(self, query: Query, request: Any, response: Any) -> None:
        """Answer G."""
        response.gravity_torque = query.part(query.model.gravity_torque(query.q))

    @state_service(GetDynamics)
    def get_dynamics(self, query: Query, request: Any, response: Any) -> None:
        """Answer D, C, C q̇, G, kinetic and potential energy."""
        terms = query.model.dynamics(query.q, query.qd)
        response.mass_matrix = query.block(terms.mass_matrix)
        response.coriolis_matrix = query.block(terms.coriolis_matrix)
        response.coriolis_torque = query.part(terms.coriolis_matrix @ query.qd)
        response.gravity_torque = query.part(terms.gravity_torque)
        response.kinetic_energy = float(finite(query.model.kinetic_energy(query.q, query.qd)))
        response.potential_energy = float(finite(query.model.potential_energy(query.q)))

    @state_service(InverseDynamics)
    def inverse_dynamics(self, query: Query, request: Any, response: Any) -> None:
        """Answer the efforts of a motion, with or without friction and gravity."""
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

    @state_service(ForwardDynamics)
    def forward_dynamics(self, query: Query, request: Any, response: Any) -> None:
        """Answer the accelerations caused by efforts; joints outside `joints` are held."""
        model, given = query.model, query.whole('effort', request.effort)
        effort = given
        if request.with_friction:
            effort = given - model.friction_torque(query.qd)
            query.message += ', with friction'
        response.effort = query.part(given)
        response.acceleration = query.part(
            forward_dynamics_locked(model, query.index, query.q, query.qd, effort)
        )

    @state_service(GetJacobian)
    def get_jacobian(self, query: Query, request: Any, response: Any) -> None:
        """Answer J of a point of any link, 6 x n, linear rows first, base frame; and the pose."""
        model, link = query.model, request.link or query.model.tip_link
        point = np.array([request.point.x, request.point.y, request.point.z])
        if not np.isfinite(point).all():
            raise ArgumentError(f'point: expected finite numbers, m, got {point.tolist()}')
        response.jacobian = query.columns(model.jacobian(query.q, link, point))
        response.link, response.frame_id = link, model.tree.root
        response.pose = _pose(model.link_pose(query.q, link), point)
        query.message += f', link {link}'


def _pose(transform: NDArray[np.float64], point: NDArray[np.float64]) -> Pose:
    # Imported here: another thread imports scipy while the node starts, see `main`.
    from scipy.spatial.transform import Rotation

    x, y, z = finite(transform[:3, :3] @ point + transform[:3, 3]).tolist()
    qx, qy, qz, qw = Rotation.from_matrix(transform[:3, :3]).as_quat().tolist()
    return Pose(position=Point(x=x, y=y, z=z), orientation=Quaternion(x=qx, y=qy, z=qz, w=qw))
