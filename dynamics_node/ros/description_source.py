"""Where the robot description comes from: parameter, file or topic, in this order."""

from std_msgs.msg import String

from .guard import logged
from .qos import NO_SUBSCRIPTION_EVENTS, ROBOT_DESCRIPTION


class DescriptionSource:
    """
    Delivers each new description once.

    The parameter `robot_description` wins over `robot_description_file`, and both over the
    topic; the node's log says which one it was.

    """

    def __init__(self, node, parameters, on_description):
        """
        Deliver what is there and listen for more.

        Parameters
        ----------
        node : rclpy.node.Node
        parameters : Parameters
        on_description : callable(source, origin)
            Source is the URDF text or path; origin says in words where it comes from.
            Returns whether it is dealt with; otherwise the same text may come again.

        """
        self.logger = node.get_logger()
        self._on_description = on_description
        self._last = None
        self.topic = self.subscription = None
        if parameters['robot_description']:
            # Bytes are always text, so that a text is never taken for a path.
            on_description(parameters['robot_description'].encode(),
                           'parameter robot_description')
        elif parameters['robot_description_file']:
            path = parameters['robot_description_file']
            on_description(path, f'parameter robot_description_file ({path})')
        else:
            self.subscription = node.create_subscription(
                String, 'robot_description', self._received, ROBOT_DESCRIPTION,
                event_callbacks=NO_SUBSCRIPTION_EVENTS)
            self.topic = self.subscription.topic_name

    @logged
    def _received(self, message):
        if message.data == self._last:
            return
        if self._on_description(message.data.encode(errors='surrogatepass'),
                                f'topic {self.topic}'):
            self._last = message.data

    def offer_again(self):
        """Deliver the newest text once more: what it was refused for may have changed."""
        if self._last is not None:
            text, self._last = self._last, None
            self._received(String(data=text))
