"""`FaultyLink`: faults in a stream of joint states. No ROS node."""

from collections import deque
import random
import struct

from builtin_interfaces.msg import Time
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState

FLOOD = 20  # messages per state: 10 kHz from a robot of 500 Hz
FLOOD_STEP = 100_000  # [ns] between their stamps
JUMP = 1.0  # [rad or m]
TOO_FAST = 50.0  # [rad/s or m/s]
CLOCKS_APART = 30_000_000_000  # [ns]
LOOP = 100  # states repeated by a looping bag
# Names in a message that best-effort DDS delivers, and in one that it loses.
MANY, MILLION = 10_000, 1_000_000
BUSY = 100  # states that the link drops during a message of a million names
_STAMP = struct.Struct('<iI')
_COUNT = struct.Struct('<I')
_REPRESENTATION = b'\x00\x01\x00\x00'


class FaultyLink:
    """
    The link between a robot and the node.

    Attributes
    ----------
    fault : str
        A key of FAULTS, initially 'none'.

    """

    def __init__(self, seed=0):
        """Pass all messages; `seed` is that of random faults."""
        self._rng = random.Random(seed)
        self._recent = deque(maxlen=LOOP)
        self._big = {}
        self.switch('none')

    def switch(self, fault):
        """
        Set the fault.

        Parameters
        ----------
        fault : str
            A key of FAULTS, for every message; 'nan/7': for every seventh.

        Raises
        ------
        ValueError
            If the fault is unknown.

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
        Return the output for one joint state.

        Parameters
        ----------
        message : sensor_msgs.msg.JointState

        Returns
        -------
        list of sensor_msgs.msg.JointState or bytes
            Bytes are published as they are.

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
        # Alternately, as two broadcasters send them: a queue holds only the newest.
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
        # Newer states would displace its fragments from the queue before they arrive.
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
        if kind == 0:  # random bytes
            return [self._rng.randbytes(self._rng.randrange(len(data)))]
        if kind == 1:  # truncated
            return [data[: self._rng.randrange(len(data))]]
        # Random bytes between stamp and numbers: random numbers would be valid, and could
        # look like a runaway arm.
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
        # Serialized once: as Python strings they would take the relay seconds.
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
    'none': FaultyLink._none,
    'silent': FaultyLink._silent,
    'frozen': FaultyLink._frozen,
    'permuted': FaultyLink._permuted,
    'parts': FaultyLink._parts,
    'half': FaultyLink._half,
    'duplicated': FaultyLink._duplicated,
    'nan': FaultyLink._nan,
    'all_nan': FaultyLink._all_nan,
    'length': FaultyLink._length,
    'name_twice': FaultyLink._name_twice,
    'unknown_names': FaultyLink._unknown_names,
    'flood': FaultyLink._flood,
    'many_names': FaultyLink._many_names,
    'million_names': FaultyLink._million_names,
    'jump': FaultyLink._jump,
    'too_fast': FaultyLink._too_fast,
    'no_stamp': FaultyLink._no_stamp,
    'old_stamp': FaultyLink._old_stamp,
    'future_stamp': FaultyLink._future_stamp,
    'bag_loop': FaultyLink._bag_loop,
    'garbage': FaultyLink._garbage,
}


def shifted(data, offset):
    """Return a serialized joint state with `offset` ns added to its stamp."""
    return _restamped(bytearray(data), stamp_of(data) + offset)


def stamp_of(data):
    """Return the stamp of a serialized message with a header, ns."""
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
