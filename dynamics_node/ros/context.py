"""The context shared by all parts of the node: ROS node, parameters and robot in force."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rclpy.impl.rcutils_logger import RcutilsLogger
    from rclpy.node import Node

    from .parameters.parameters import Parameters
    from .torque_path.active_robot import ActiveRobot


@dataclass
class NodeContext:
    """
    The ROS node, its parameters, and the robot in force.

    Attributes
    ----------
    node : rclpy.node.Node
    parameters : Parameters
        Name → value in force.
    robot : ActiveRobot or None
        Replaced as a whole when another description is accepted; None until the first one is.

    """

    node: Node
    parameters: Parameters
    robot: ActiveRobot | None = None

    @property
    def logger(self) -> RcutilsLogger:
        """Logger of the node."""
        return self.node.get_logger()
