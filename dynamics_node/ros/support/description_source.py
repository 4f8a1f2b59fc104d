"""Source of the robot description: parameter, file or topic, in this order."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from std_msgs.msg import String

from .callback_errors import logged
from .qos import NO_SUBSCRIPTION_EVENTS, ROBOT_DESCRIPTION
from ..context import NodeContext


class DescriptionSource:
    """
    Delivers each new description once.

    The parameter `robot_description` wins over `robot_description_file`, and both over the
    topic; the node logs the chosen source.

    Attributes
    ----------
    topic : str or None
        Resolved name; None if the description is a parameter or a file.
    subscription : rclpy.subscription.Subscription or None

    """

    def __init__(
        self, context: NodeContext, on_description: Callable[[str | bytes, str], bool]
    ) -> None:
        """
        Create the source; `begin` delivers.

        Parameters
        ----------
        context : NodeContext
        on_description : callable(source, origin)
            Source: URDF text (bytes) or path (str). Origin: the source in words, for the log.
            Returns False if the description has to wait; `offer_pending` then repeats it.

        """
        self.logger = context.logger
        self._on_description = on_description
        self._last: str | None = None
        self._pending: str | None = None
        self.topic: str | None = None
        self.subscription: Any = None
        self._node, self._parameters = context.node, context.parameters

    def begin(self) -> None:
        """Deliver the description of a parameter or file, or subscribe to the topic."""
        parameters, on_description = self._parameters, self._on_description
        if parameters['robot_description']:
            # As bytes, which are always text: a string would be read as a path.
            on_description(parameters['robot_description'].encode(), 'parameter robot_description')
        elif parameters['robot_description_file']:
            path = parameters['robot_description_file']
            on_description(path, f'parameter robot_description_file ({path})')
        else:
            self.subscription = self._node.create_subscription(
                String,
                'robot_description',
                self._received,
                ROBOT_DESCRIPTION,
                event_callbacks=NO_SUBSCRIPTION_EVENTS,
                callback_group=getattr(self._node, 'service_group', None),
            )
            self.topic = self.subscription.topic_name

    @logged
    def _received(self, message):
        if message.data == self._last:
            self._pending = None  # the publisher has returned to the description in force
        elif message.data != self._pending:
            self._offer(message.data)

    def _offer(self, text):
        self._pending = text
        if self._on_description(text.encode(errors='surrogatepass'), f'topic {self.topic}'):
            self._last, self._pending = text, None

    @logged
    def offer_pending(self) -> None:
        """Deliver the newest text again if it had to wait."""
        if self._pending is not None:
            self._offer(self._pending)

    def offer_again(self) -> None:
        """Deliver the newest text again: the reason for its refusal may be gone."""
        if self._last is not None:
            text, self._last = self._last, None
            self._received(String(data=text))
