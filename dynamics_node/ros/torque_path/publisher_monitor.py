"""Other publishers on topics that must have one source."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..context import NodeContext

if TYPE_CHECKING:
    from .joint_state_input import JointStateInput
    from ..support.description_source import DescriptionSource


class PublisherMonitor:
    """
    Searches for a second source of efforts, joint states or robot descriptions.

    An arm with two sources jumps between their values.

    """

    def __init__(
        self,
        context: NodeContext,
        command_topic: str,
        states: JointStateInput,
        source: DescriptionSource,
    ) -> None:
        """
        Monitor the topics of a node.

        Parameters
        ----------
        context : NodeContext
        command_topic : str
            Resolved name.
        states : JointStateInput
        source : DescriptionSource

        """
        self._node = context.node
        self._command_topic = command_topic
        self._states = states
        self._source = source
        self._allows_several = context.parameters['allow_several_state_publishers']

    def conflicts(self) -> list[str]:
        """Return a message for each second source of efforts or joint states."""
        reasons = []
        others = self._node.count_publishers(self._command_topic) - 1
        if others > 0:
            reasons.append(
                f'{others} other publisher(s) on {self._command_topic}'
                f'{self._names(self._command_topic)}: two sources of effort would '
                'fight'
            )
        sources = self._states.count_publishers()
        if sources > 1 and not self._allows_several:
            topic = self._states.topic
            reasons.append(
                f'{sources} publishers on {topic}{self._names(topic)}: stop the '
                'others (a forgotten joint_state_publisher?) or set '
                'allow_several_state_publishers'
            )
        return reasons

    def description_conflicts(self) -> list[str]:
        """Return a message if several nodes publish a robot description."""
        topic = self._source.topic
        if topic is None or (count := self._node.count_publishers(topic)) < 2:
            return []
        return [
            f'{count} publishers on {topic}{self._names(topic)}: which of them describes '
            'this robot? Stop the others, or give the description as the parameter '
            'robot_description_file'
        ]

    def _names(self, topic: str) -> str:
        own = f'{self._node.get_namespace().rstrip("/")}/{self._node.get_name()}'
        names = [
            f'{info.node_namespace.rstrip("/")}/{info.node_name}'
            for info in self._node.get_publishers_info_by_topic(topic)
        ]
        if own in names:
            names.remove(own)  # once: another node may have the same name
        return f' ({", ".join(sorted(set(names)))})' if names else ''
