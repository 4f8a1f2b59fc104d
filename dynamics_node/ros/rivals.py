"""Who else publishes where only one may."""


class Rivals:
    """
    Looks for a second source of efforts and a second source of joint states.

    Both make an arm jump between what the two sources say.

    """

    def __init__(self, node, command_topic, states, allow_several_state_publishers):
        """
        Know what to look at.

        Parameters
        ----------
        node : rclpy.node.Node
        command_topic : str
            Resolved name.
        states : StateInput
        allow_several_state_publishers : bool

        """
        self._node = node
        self._command_topic = command_topic
        self._states = states
        self._allows_several = allow_several_state_publishers

    def found(self):
        """Return what speaks against driving the arm, as a list of str."""
        reasons = []
        others = self._node.count_publishers(self._command_topic) - 1
        if others > 0:
            reasons.append(f'{others} other publisher(s) on {self._command_topic}'
                           f'{self._names(self._command_topic)}: two sources of effort would '
                           'fight')
        sources = self._states.count_publishers()
        if sources > 1 and not self._allows_several:
            topic = self._states.topic
            reasons.append(f'{sources} publishers on {topic}{self._names(topic)}: stop the '
                           'others (a forgotten joint_state_publisher?) or set '
                           'allow_several_state_publishers')
        return reasons

    def _names(self, topic):
        own = (self._node.get_name(), self._node.get_namespace())
        names = {f'{info.node_namespace.rstrip("/")}/{info.node_name}'
                 for info in self._node.get_publishers_info_by_topic(topic)
                 if (info.node_name, info.node_namespace) != own}
        return f' ({", ".join(sorted(names))})' if names else ''
