"""Where the robot description comes from: parameter, file or topic, in this order."""

from std_msgs.msg import String

from .callback_errors import logged
from .qos import NO_SUBSCRIPTION_EVENTS, ROBOT_DESCRIPTION


class DescriptionSource:
    """
    Delivers each new description once.

    The parameter `robot_description` wins over `robot_description_file`, and both over the
    topic; the log names the one in use.

    """

    def __init__(self, context, on_description):
        """
        Choose the source; `begin` delivers.

        Parameters
        ----------
        context : NodeContext
        on_description : callable(source, origin)
            Source is the URDF text or path; origin says in words where it comes from.
            Returns False if it has to wait; `offer_pending` then offers it again.

        """
        self.logger = context.logger
        self._on_description = on_description
        self._last = self._pending = None
        self.topic = self.subscription = None
        self._node, self._parameters = context.node, context.parameters

    def begin(self):
        """Deliver the description of a parameter, or subscribe to the topic."""
        parameters, on_description = self._parameters, self._on_description
        if parameters['robot_description']:
            # Bytes are always text, so that a text is never taken for a path.
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
            self._pending = None  # the publisher went back to what is in force
        elif message.data != self._pending:
            self._offer(message.data)

    def _offer(self, text):
        self._pending = text
        if self._on_description(text.encode(errors='surrogatepass'), f'topic {self.topic}'):
            self._last, self._pending = text, None

    @logged
    def offer_pending(self):
        """Deliver a postponed text if it is still the newest."""
        if self._pending is not None:
            self._offer(self._pending)

    def offer_again(self):
        """Deliver the newest text again: the reason of its refusal may have changed."""
        if self._last is not None:
            text, self._last = self._last, None
            self._received(String(data=text))
