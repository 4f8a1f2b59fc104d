"""What can be wrong with a stream of joint states: a message in, messages out, and no ROS node."""

from collections import deque
import random
import struct

from builtin_interfaces.msg import Time
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState

FLOOD = 20  # messages for one: 10 kHz from a robot of 500 Hz
FLOOD_STEP = 100_000  # [ns] between their stamps
JUMP = 1.0  # [rad or m]
TOO_FAST = 50.0  # [rad/s or m/s]
CLOCKS_APART = 30_000_000_000  # [ns]
LOOP = 100  # states that the loop of a bag repeats
# What best-effort DDS still delivers, and what it never does: there it loses a fragment.
MANY, MILLION = 10_000, 1_000_000
BUSY = 100  # states for which the line carries nothing else than a million names
_STAMP = struct.Struct('<iI')
_COUNT = struct.Struct('<I')
_REPRESENTATION = b'\x00\x01\x00\x00'


class Line:
    """
    The line between a robot and the node.

    Attributes
    ----------
    fault : str
        What is wrong with it, a key of FAULTS; 'none' at first.

    """

    def __init__(self, seed=0):
        """Let everything through; `seed` decides what random faults look like."""
        self._rng = random.Random(seed)
        self._recent = deque(maxlen=LOOP)
        self._big = {}
        self.switch('none')

    def switch(self, fault):
        """
        Change what is wrong from now on.

        Parameters
        ----------
        fault : str
            A key of FAULTS, for every message; 'nan/7' for every seventh.

        Raises
        ------
        ValueError
            If there is no such fault.

        """
        kind, _, every = fault.partition('/')
        if kind not in FAULTS or (every and not every.isdecimal()) or every == '0':
            raise ValueError(
                f"expected one of {', '.join(sorted(FAULTS))}, with '/7' behind it "
                f'for every seventh message, got {fault!r}'
            )
        self.fault = fault
        self._act, self._every = FAULTS[kind], int(every or 1)
        self._count = self._busy = 0
        self._held = None

    def out(self, message):
        """
        Return what comes out for a joint state.

        Parameters
        ----------
        message : sensor_msgs.msg.JointState

        Returns
        -------
        list of sensor_msgs.msg.JointState or bytes
            Bytes are to be published as they are.

        """
        self._count += 1
        self._recent.append(message)
        if self._busy:
            self._busy -= 1
            return []
        return [message] if self._count % self._every else self._act(self, message)

    # The faults ------------------------------------------------------------------------------

    def _none(self, message):
        return [message]

    def _silent(self, message):
        return []

    def _frozen(self, message):
        self._held = self._held or message
        return [self._held]

    def _permuted(self, message):
        order = self._rng.sample(range(len(message.name)), len(message.name))
        return [_chosen(message, order)]

    def _parts(self, message):
        # One at a time, as two broadcasters send them: a queue has room for the newest only.
        half, count = len(message.name) // 2, len(message.name)
        return [
            _chosen(message, range(half) if self._count // self._every % 2 else range(half, count))
        ]

    def _half(self, message):
        return [_chosen(message, range(len(message.name) // 2))]

    def _duplicated(self, message):
        return [message, message]

    def _nan(self, message):
        return [
            self._with_one_position(
                message, self._rng.choice([float('nan'), float('inf'), -float('inf')])
            )
        ]

    def _all_nan(self, message):
        return [_changed(message, position=[float('nan')] * len(message.name))]

    def _length(self, message):
        cut = self._rng.choice([0, len(message.position) - 1, len(message.position) + 1])
        return [_changed(message, position=[*message.position, 0.0][:cut])]

    def _name_twice(self, message):
        return [_changed(message, name=[message.name[1], *message.name[1:]])]

    def _unknown_names(self, message):
        return [_changed(message, name=[f'{name}_of_another_robot' for name in message.name])]

    def _flood(self, message):
        data = bytearray(serialize_message(message))
        stamps = [_stamp(message) - back * FLOOD_STEP for back in range(FLOOD - 1, -1, -1)]
        return [_restamped(data, stamp) for stamp in stamps]

    def _many_names(self, message):
        return [self._names(MANY)]

    def _million_names(self, message):
        # Newer states would drive its fragments out of the queue before they have arrived.
        self._busy = BUSY
        return [self._names(MILLION)]

    def _jump(self, message):
        return [_changed(message, position=[value + JUMP for value in message.position])]

    def _too_fast(self, message):
        return [_changed(message, velocity=[TOO_FAST] * len(message.name))]

    def _no_stamp(self, message):
        return [_at(message, 0)]

    def _old_stamp(self, message):
        return [_at(message, _stamp(message) - CLOCKS_APART)]

    def _future_stamp(self, message):
        return [_at(message, _stamp(message) + CLOCKS_APART)]

    def _bag_loop(self, message):
        self._held = self._held or list(self._recent)
        return [self._held[self._count // self._every % len(self._held)]]

    def _garbage(self, message):
        data = serialize_message(message)
        kind = self._rng.randrange(3)
        if kind == 0:  # anything at all
            return [self._rng.randbytes(self._rng.randrange(len(data)))]
        if kind == 1:  # cut off
            return [data[: self._rng.randrange(len(data))]]
        # Some bytes of a good one, behind the stamp and before the numbers: whatever bytes a
        # number has, it is one, and may well be that of an arm that runs away.
        wrong = bytearray(data)
        numbers = sum(
            8 + 8 * len(field) for field in (message.position, message.velocity, message.effort)
        )
        for _ in range(8):
            wrong[self._rng.randrange(12, len(wrong) - numbers)] = self._rng.randrange(256)
        return [bytes(wrong)]

    # -----------------------------------------------------------------------------------------

    def _with_one_position(self, message, value):
        position = list(message.position)
        position[self._rng.randrange(len(position))] = value
        return _changed(message, position=position)

    def _names(self, count):
        # Made once, of bytes: as Python strings they would take the relay seconds.
        if count not in self._big:
            names = _COUNT.pack(2) + b'j\0\0\0'
            head = (
                _REPRESENTATION
                + _STAMP.pack(0, 0)
                + _COUNT.pack(1)
                + b'\0\0\0\0'
                + _COUNT.pack(count)
                + names * count
                + _COUNT.pack(count)
            )
            gap = bytes(-(len(head) - len(_REPRESENTATION)) % 8)
            self._big[count] = head + gap + bytes(8 * count) + _COUNT.pack(0) + _COUNT.pack(0)
        return self._big[count]


FAULTS = {
    'none': Line._none,
    'silent': Line._silent,
    'frozen': Line._frozen,
    'permuted': Line._permuted,
    'parts': Line._parts,
    'half': Line._half,
    'duplicated': Line._duplicated,
    'nan': Line._nan,
    'all_nan': Line._all_nan,
    'length': Line._length,
    'name_twice': Line._name_twice,
    'unknown_names': Line._unknown_names,
    'flood': Line._flood,
    'many_names': Line._many_names,
    'million_names': Line._million_names,
    'jump': Line._jump,
    'too_fast': Line._too_fast,
    'no_stamp': Line._no_stamp,
    'old_stamp': Line._old_stamp,
    'future_stamp': Line._future_stamp,
    'bag_loop': Line._bag_loop,
    'garbage': Line._garbage,
}


def shifted(data, offset):
    """Return a serialized joint state with `offset` ns added to its stamp."""
    return _restamped(bytearray(data), stamp_of(data) + offset)


def stamp_of(data):
    """Return the stamp of any serialized message that begins with a header, ns."""
    sec, nanosec = _STAMP.unpack_from(data, len(_REPRESENTATION))
    return sec * 1_000_000_000 + nanosec


def _restamped(data, stamp):
    _STAMP.pack_into(data, len(_REPRESENTATION), *divmod(stamp, 1_000_000_000))
    return bytes(data)


def _stamp(message):
    return message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec


def _at(message, stamp):
    changed = _changed(message)
    sec, nanosec = divmod(stamp, 1_000_000_000)
    changed.header.stamp = Time(sec=sec, nanosec=nanosec)
    return changed


def _changed(message, **fields):
    kept = {field: getattr(message, field) for field in ('name', 'position', 'velocity', 'effort')}
    changed = JointState(**{**kept, **fields})
    changed.header = type(message.header)(
        stamp=message.header.stamp, frame_id=message.header.frame_id
    )
    return changed


def _chosen(message, order):
    return _changed(
        message,
        **{
            field: [getattr(message, field)[i] for i in order]
            for field in ('name', 'position', 'velocity', 'effort')
        },
    )
