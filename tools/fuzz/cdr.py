"""Serialized joint states in which any count can be false."""

import struct

_LIES = (
    0,
    1,
    2,
    3,
    4,
    5,
    100,
    4_095,
    4_097,
    65_536,
    2**24,
    2**28,
    2**29 - 1,
    2**31 - 1,
    2**31,
    2**32 - 8,
    2**32 - 1,
)


class _Writer:
    """Appends values with CDR's alignment; `lie` is (index of a count, its false value)."""

    def __init__(self, lie):
        self.data = bytearray(b'\x00\x01\x00\x00')
        self._lie, self._counts = lie, 0

    def number(self, form, value):
        # The alignment begins after the representation.
        self.data += bytes((4 - len(self.data)) % struct.calcsize(form))
        self.data += struct.pack('<' + form, value)

    def count(self, value):
        at, false_value = self._lie
        self.number('I', false_value if at == self._counts else value)
        self._counts += 1

    def text(self, data):
        self.count(len(data))
        self.data += data

    def doubles(self, values):
        self.count(len(values))
        if values:
            self.number('d', values[0])
            self.data += struct.pack(f'<{len(values) - 1}d', *values[1:])


def joint_state(stamp, frame, names, sequences, lie=(-1, 0)):
    """
    Return the bytes of a joint state.

    Parameters
    ----------
    stamp : (int, int)
    frame : bytes
        With a terminating zero.
    names : list of bytes
        Each with a terminating zero.
    sequences : three lists of float
        Positions, velocities, efforts.
    lie : (int, int)
        Index of a count, in order of appearance, and its false value; index -1: none.

    """
    writer = _Writer(lie)
    writer.number('i', stamp[0])
    writer.number('I', stamp[1])
    writer.text(frame)
    writer.count(len(names))
    for name in names:
        writer.text(name)
    for values in sequences:
        writer.doubles(values)
    return bytes(writer.data)


def lie(rng, names):
    """Return index and false value for a state with a number of names."""
    # Half of them behind the texts, where only few counts are.
    at = (
        rng.randrange(names + 5)
        if rng.random() < 0.5
        else rng.choice((0, 1, *range(names + 2, names + 5)))
    )
    return at, rng.choice((rng.choice(_LIES), rng.randrange(12), rng.randrange(2**32)))
