"""Shapes as a visualization_msgs/MarkerArray."""

from collections.abc import Sequence

from builtin_interfaces.msg import Duration, Time
from geometry_msgs.msg import Point
from std_msgs.msg import Header
from visualization_msgs.msg import Marker, MarkerArray

from .. import ARROW, BOX, DISC, LINE, Shape, SPHERE, TEXT

# A marker that is not replaced within this time vanishes, s.
LIFETIME = 1
_TYPES = {
    SPHERE: Marker.SPHERE,
    BOX: Marker.CUBE,
    DISC: Marker.CYLINDER,
    LINE: Marker.LINE_STRIP,
    ARROW: Marker.ARROW,
    TEXT: Marker.TEXT_VIEW_FACING,
}


class MarkerMessages:
    """
    Converts shapes to messages.

    The markers of one message are reused for the next: rclpy takes longer to create a Marker, with
    its textures and meshes, than to fill one.

    """

    def __init__(self) -> None:
        self._markers: dict[tuple[str, int], tuple[Shape | None, Marker]] = {}

    def make(self, shapes: Sequence[Shape], stamp: Time, frame_id: str) -> MarkerArray:
        """
        Return the message of shapes.

        Parameters
        ----------
        shapes : sequence of Shape
        stamp : builtin_interfaces.msg.Time
            Stamp of the joint state.
        frame_id : str
            Name of the base frame.

        Returns
        -------
        visualization_msgs.msg.MarkerArray
            Valid until the next call. It begins with a DELETEALL marker if the names of the
            shapes, group and number, differ from those of the last call: a removed shape then
            vanishes at once, not after its lifetime.

        """
        header = Header(stamp=stamp, frame_id=frame_id)
        names = {(shape.group, shape.number) for shape in shapes}
        has_changed = names != set(self._markers)
        if has_changed:
            self._markers = {name: (None, _new(*name)) for name in names}
        markers = [Marker(header=header, action=Marker.DELETEALL)] if has_changed else []
        return MarkerArray(markers=markers + [self._marker(shape, header) for shape in shapes])

    def _marker(self, shape: Shape, header: Header) -> Marker:
        before, marker = self._markers[shape.group, shape.number]
        if shape != before:
            _fill(marker, shape)
            self._markers[shape.group, shape.number] = shape, marker
        marker.header = header
        return marker


def _new(group: str, number: int) -> Marker:
    # Locked: RViz transforms it to another fixed frame with the newest transform.
    return Marker(ns=group, id=number, frame_locked=True, lifetime=Duration(sec=LIFETIME))


def _fill(marker: Marker, shape: Shape) -> None:
    marker.type, marker.text = _TYPES[shape.kind], shape.text
    position, orientation = marker.pose.position, marker.pose.orientation
    position.x, position.y, position.z = shape.position
    orientation.x, orientation.y, orientation.z, orientation.w = shape.orientation
    marker.scale.x, marker.scale.y, marker.scale.z = shape.size
    color = marker.color
    color.r, color.g, color.b, color.a = shape.color
    marker.points = [Point(x=x, y=y, z=z) for x, y, z in shape.points]
