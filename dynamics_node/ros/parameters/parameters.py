"""Parameters of the node: declared from the table, checked before they take effect."""

from collections.abc import Callable, Mapping
import difflib
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node

from .declaration import declare, ros_parameter
from .table import check_all, ParameterError, PARAMETERS
from ..support.callback_errors import logged
from ..support.throttling import Throttle


class Parameters:
    """
    The parameter values of the node: always complete, always checked.

    Attributes
    ----------
    values : dict of str to Any
        In force; replaced as a whole, never changed in place.

    """

    def __init__(self, node: Node) -> None:
        """
        Declare all parameters.

        Parameters
        ----------
        node : rclpy.node.Node

        Raises
        ------
        ParameterError
            If a value from the command line or a file is refused.

        """
        self._node = node
        self.logger = node.get_logger()
        self._logged: dict[str, Throttle] = {}
        self.values = check_all(declare(node, PARAMETERS))
        self._warn_of_misspelled()

    def watch(
        self,
        on_change: Callable[[dict[str, Any], dict[str, Any]], None],
        further_check: Callable[[dict[str, Any]], None],
    ) -> None:
        """
        Accept changes at run time from now on.

        Parameters
        ----------
        on_change : callable(dict, dict)
            Called after a change with all values and the values before.
        further_check : callable(dict)
            Raises ParameterError for values that do not fit the robot.

        """
        self._on_change, self._further_check = on_change, further_check
        self._node.add_on_set_parameters_callback(self._check)
        self._node.add_post_set_parameters_callback(self._take)

    def __getitem__(self, name: str) -> Any:
        """Return the value in force."""
        return self.values[name]

    def set(self, values: Mapping[str, Any]) -> None:
        """
        Set several parameters together, with the same checks as the ROS parameter services.

        Parameters
        ----------
        values : mapping of str to Any
            Name → value in its kind.

        Raises
        ------
        ParameterError
            If a value is refused; then none has changed.

        """
        kinds = {parameter.name: parameter for parameter in PARAMETERS}
        result = self._node.set_parameters_atomically(
            [ros_parameter(kinds[name], value) for name, value in values.items()]
        )
        if not result.successful:
            raise ParameterError(result.reason)

    def _warn_of_misspelled(self):
        # ROS ignores undeclared names: `effort_limit` would set no limit. rclpy has no public
        # list of the given names, except by declaring all of them, which would make each a
        # parameter of this node. Without the private list there is no warning, nothing else.
        names = [parameter.name for parameter in PARAMETERS]
        given = getattr(self._node, '_parameter_overrides', {})
        for name in sorted(set(given) - set(names)):
            alike = difflib.get_close_matches(name, names, n=1, cutoff=0.8)
            if alike and not self._node.has_parameter(name):
                self.logger.warning(
                    f"there is no parameter '{name}', and its value is ignored: "
                    f"is '{alike[0]}' meant?"
                )

    def _check(self, ros_parameters):
        try:
            self._further_check(self._merged(ros_parameters))
        except Exception as error:  # also an unexpected one: nothing has changed yet
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    @logged
    def _take(self, ros_parameters):
        if not any(item.name in self.values for item in ros_parameters):
            return
        # `_check` has accepted them.
        before, self.values = self.values, self._merged(ros_parameters)
        for name, value in self.values.items():
            # Throttled: gravity may change a hundred times a second.
            if value != before[name] and self._logged.setdefault(name, Throttle(0.5)).is_due():
                self.logger.info(f'parameter {name} changed: {before[name]} -> {value}')
        self._on_change(self.values, before)

    def _merged(self, ros_parameters):
        values = dict(self.values)
        values.update((item.name, item.value) for item in ros_parameters if item.name in values)
        return check_all(values)
