"""A picture as the bytes of a visualization_msgs/MarkerArray: for a tenth of rclpy's time."""

import struct

from builtin_interfaces.msg import Duration, Time
from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from rclpy.serialization import deserialize_message, serialize_message
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray

from ..drawing import ARROW, BOX, DISC, LINE, Shape, SPHERE, TEXT

# Shapes that are written in one step.
PIECE = 40
# What is not replaced for so long is gone: nobody must see an arm that is not there any more, s.
LIFETIME = 1
_TYPES = {SPHERE: Marker.SPHERE, BOX: Marker.CUBE, DISC: Marker.CYLINDER, LINE: Marker.LINE_STRIP,
          ARROW: Marker.ARROW, TEXT: Marker.TEXT_VIEW_FACING}
# Common Data Representation, version 1, little endian; places count from behind this header.
_ENCAPSULATION = b'\x00\x01\x00\x00'
# Position, orientation and scale; colour, lifetime, frame_locked, count of points.
_POSE, _REST = struct.Struct('<10d'), struct.Struct('<4fiI?3xI')
# No colours, texture_resource '', texture with stamp 0, frame_id '', format '' and no data,
# no uv_coordinates.
_BEFORE_TEXT = struct.pack('<I' 'I4x' 'iI' 'I4x' 'I4x' 'I' 'I', 0, 1, 0, 0, 1, 1, 0, 0)
# mesh_resource '', mesh_file with filename '' and no data, no embedded materials.
_AFTER_TEXT = struct.pack('<I4x' 'I4x' 'I' '?', 1, 1, 0, False)


def as_message(shapes, stamp, frame_id, begins_anew):
    """
    Return a picture as a message.

    Parameters
    ----------
    shapes : sequence of Shape
    stamp : builtin_interfaces.msg.Time
    frame_id : str
        Name of the base frame.
    begins_anew : bool
        Whether all that was shown before goes.

    Returns
    -------
    visualization_msgs.msg.MarkerArray

    """
    header = Header(stamp=stamp, frame_id=frame_id)
    markers = [Marker(header=header, action=Marker.DELETEALL)] if begins_anew else []
    return MarkerArray(markers=markers + [_marker(shape, header) for shape in shapes])


def _marker(shape, header):
    position, turn, size, colour = shape.position, shape.orientation, shape.size, shape.colour
    return Marker(
        header=header, ns=shape.group, id=shape.number, type=_TYPES[shape.kind],
        pose=Pose(position=_named(Point, 'xyz', position),
                  orientation=_named(Quaternion, 'xyzw', turn)),
        scale=_named(Vector3, 'xyz', size), color=_named(ColorRGBA, 'rgba', colour),
        # With the newest transform that RViz has, where its fixed frame is another one.
        frame_locked=True, lifetime=Duration(sec=LIFETIME),
        points=[_named(Point, 'xyz', point) for point in shape.points], text=shape.text)


def _named(kind, names, values):
    return kind(**dict(zip(names, values, strict=True)))


class MarkerWriter:
    """
    Writes the bytes of `as_message`.

    rclpy makes an object of every point, reads it again attribute by attribute, and so takes
    longer than there is time between two joint states.

    """

    def __init__(self, frame_id):
        """
        Belong to a robot.

        Parameters
        ----------
        frame_id : str
            Name of its base frame.

        """
        self._frame_id = _text(frame_id)
        self._starts: dict = {}

    def write(self, shapes, stamp, begins_anew):
        """
        Return the bytes of a picture.

        Parameters
        ----------
        shapes, stamp, begins_anew
            See `as_message`.

        Returns
        -------
        bytes

        """
        *_, data = self.steps(shapes, stamp, begins_anew)
        return data

    def steps(self, shapes, stamp, begins_anew):
        """
        Write a picture piece by piece, for whoever has other things to do in between.

        Parameters
        ----------
        shapes, stamp, begins_anew
            See `as_message`.

        Yields
        ------
        None or bytes
            None after every PIECE shapes, the bytes of the whole at last.

        """
        out = bytearray(struct.pack('<I', len(shapes) + begins_anew))
        stamp = struct.pack('<iI', stamp.sec, stamp.nanosec)
        if begins_anew:
            _fill(out, stamp + self._start('', 0, Marker.ARROW, Marker.DELETEALL))
            _fill(out, _POSE.pack(*[0.0] * 6, 1.0, *[0.0] * 3), 8)
            out += _REST.pack(*[0.0] * 4, 0, 0, False, 0) + _BEFORE_TEXT + _text('')
            _fill(out, _AFTER_TEXT)
        for count, shape in enumerate(shapes):
            if count and count % PIECE == 0:
                yield None
            group, number, kind, size, colour, position, turn, points, text = shape
            start = self._starts.get((group, number, kind))
            if start is None:
                start = self._start(group, number, _TYPES[kind], Marker.ADD)
                self._starts[group, number, kind] = start
            _fill(out, stamp + start)
            _fill(out, _POSE.pack(*position, *turn, *size), 8)
            out += _REST.pack(*colour, LIFETIME, 0, True, len(points))
            if points:
                _fill(out, struct.pack(f'<{3 * len(points)}d', *[x for p in points for x in p]), 8)
            out += _BEFORE_TEXT + _text(text)
            _fill(out, _AFTER_TEXT)
        yield _ENCAPSULATION + bytes(out)

    def _start(self, group, number, kind, action):
        # What comes between the stamp and the pose and never changes.
        out = bytearray(self._frame_id)
        _fill(out, _text(group))
        _fill(out, struct.pack('<3i', number, kind, action))
        return bytes(out)

    def is_right(self):
        """
        Tell whether rclpy reads from the bytes what it would have written.

        Returns
        -------
        bool
            False also where this middleware has other bytes.

        """
        frame_id, stamp = self._frame_id[4:-1].decode(), Time(sec=1, nanosec=2)
        try:
            for begins_anew in (False, True):
                ours = self.write(_SAMPLES, stamp, begins_anew)
                theirs = serialize_message(as_message(_SAMPLES, stamp, frame_id, begins_anew))
                # Not the bytes: what stands in the gaps means nothing.
                if (deserialize_message(ours, MarkerArray)
                        != deserialize_message(theirs, MarkerArray)):
                    return False
        except Exception:  # which of them says that bytes are no message depends on rclpy
            return False
        return True


# One of each kind, behind texts and points of every length that leads to another gap.
_SAMPLES = [Shape('ab'[:i % 3] + 'c', i, kind, (0.1, 0.2, 0.3), (0.1, 0.2, 0.3, 0.4),
                  (1.0, 2.0, 3.0), (0.1, 0.2, 0.3, 0.4), ((4.0, 5.0, 6.0),) * (i % 2), 'text'[:i])
            for i, kind in enumerate((*_TYPES, *_TYPES))]


def _fill(out, data, alignment=4):
    out += bytes(-len(out) % alignment)
    out += data


def _text(text):
    encoded = text.encode()
    return struct.pack('<I', len(encoded) + 1) + encoded + b'\x00'
