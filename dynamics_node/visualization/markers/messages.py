"""Shapes as a visualization_msgs/MarkerArray."""

from builtin_interfaces.msg import Duration
from geometry_msgs.msg import Point
from std_msgs.msg import Header
from visualization_msgs.msg import Marker, MarkerArray

from .. import ARROW, BOX, DISC, LINE, SPHERE, TEXT

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
    Makes one message after the other of shapes with the same names.

    The markers of one message are filled anew for the next: rclpy takes longer to create a
    Marker, with the textures and meshes that it may have, than to fill one.

    """

    def __init__(self):
        """Start without markers."""
        self._made = {}

    def make(self, shapes, stamp, frame_id):
        """
        Return shapes as a message.

        Parameters
        ----------
        shapes : sequence of Shape
        stamp : builtin_interfaces.msg.Time
            Of the joint state that is shown.
        frame_id : str
            Name of the base frame.

        Returns
        -------
        visualization_msgs.msg.MarkerArray
            Valid until the next call. It begins with a DELETEALL marker if the names of the
            shapes, group and number, are not those of the call before: a shape that is gone
            vanishes at once then, not after its lifetime.

        """
        header = Header(stamp=stamp, frame_id=frame_id)
        names = {(shape.group, shape.number) for shape in shapes}
        has_changed = names != set(self._made)
        if has_changed:
            self._made = {name: (None, _new(*name)) for name in names}
        markers = [Marker(header=header, action=Marker.DELETEALL)] if has_changed else []
        return MarkerArray(markers=markers + [self._marker(shape, header) for shape in shapes])

    def _marker(self, shape, header):
        before, marker = self._made[shape.group, shape.number]
        if shape != before:
            _fill(marker, shape)
            self._made[shape.group, shape.number] = shape, marker
        marker.header = header
        return marker


def _new(group, number):
    # Locked: where RViz has another fixed frame, with the newest transform that it has.
    return Marker(ns=group, id=number, frame_locked=True, lifetime=Duration(sec=LIFETIME))


def _fill(marker, shape):
    marker.type, marker.text = _TYPES[shape.kind], shape.text
    position, orientation = marker.pose.position, marker.pose.orientation
    position.x, position.y, position.z = shape.position
    orientation.x, orientation.y, orientation.z, orientation.w = shape.orientation
    marker.scale.x, marker.scale.y, marker.scale.z = shape.size
    color = marker.color
    color.r, color.g, color.b, color.a = shape.color
    marker.points = [Point(x=x, y=y, z=z) for x, y, z in shape.points]
