"""Streams of joint states: valid, permuted, of other joints, false, truncated, random."""

import random

from .cdr import joint_state, lie
from .mutated_bytes import broken
from .seeds import seeds, siblings

JOINTS = ('shoulder', 'elbow', 'wrist', 'finger')
# Time of the first message, and period, ns.
CLOCK, PERIOD = 5_000_000_000, 10_000_000
_USUAL = tuple(name.encode() + b'\x00' for name in JOINTS)
_UNUSUAL = (
    b'other\x00',
    b'\xff\xfe\x00',
    b'\x00',
    b'',
    b'elbow',
    b'el\x00bow\x00',
    b'w' * 300 + b'\x00',
    '肘\x00'.encode(),
    b'elbow\n\x00',
    b' elbow\x00',
    b'ELBOW\x00',
)
_FRAMES = (b'base\x00', b'base\x00', b'\x00', b'', b'base', b'\xff\x00', b'x' * 999 + b'\x00')
_NUMBERS = (float('nan'), float('inf'), -float('inf'), 1e308, -1.7e308, -0.0, 5e-324, 3.2, -6.3)
_REPRESENTATIONS = (
    b'\x00\x00\x00\x00',
    b'\x00\x01\x00\x03',
    b'\x00\x02\x00\x00',
    b'\x00\x03\x00\x00',
    b'\x00\x06\x00\x00',
    b'\x00\x07\x00\x00',
    b'\x00\x08\x00\x00',
    b'\x00\x0a\x00\x00',
    b'\xff\xff\xff\xff',
    b'\x01\x00\x00\x00',
)


def streams():
    """
    Return a strategy of streams: lists of serialized messages of one subscription.

    Hypothesis chooses a seed for each message; see `descriptions` for why. The streams of one
    drawing differ in their last message.

    """
    return seeds(8).map(
        lambda drawn: [
            [_message(random.Random(seed), CLOCK + i * PERIOD) for i, seed in enumerate(each)]
            for each in siblings(drawn)
        ]
    )


def _message(rng, clock):
    return rng.choice(_WAYS)(rng, clock)


def right(rng, clock):
    """Return the next valid state of a robot."""
    positions = [0.5 + rng.uniform(-0.01, 0.01) for _ in _USUAL]
    velocities = [rng.uniform(-1.0, 1.0) for _ in _USUAL]
    return joint_state(divmod(clock, 10**9), b'base\x00', _USUAL, (positions, velocities, []))


def _parts(rng, clock):
    names = _names(rng)
    stamp = rng.choice((0, clock, clock, clock - rng.randrange(2 * 10**8), rng.randrange(2**63)))
    stamp = stamp // 10**9 % 2**31, stamp % 10**9
    if rng.random() < 0.1:
        stamp = rng.randint(-(2**31), 2**31 - 1), rng.randrange(2**32)
    return stamp, rng.choice(_FRAMES), names, [_values(rng, len(names)) for _ in range(3)]


def _names(rng):
    way = rng.random()
    if way < 0.4:
        return list(_USUAL)
    if way < 0.6:
        return rng.sample(_USUAL, len(_USUAL))
    if way < 0.8:
        return [rng.choice(_USUAL) for _ in range(rng.randrange(7))]
    if way < 0.995:
        return [rng.choice(_USUAL + _UNUSUAL) for _ in range(rng.randrange(9))]
    return [*_USUAL, *(b'%d\x00' % i for i in range(rng.choice((4_092, 4_093, 6_000))))]


def _values(rng, count):
    if rng.random() < 0.2:
        count = rng.choice((0, 0, rng.randrange(9)))
    width = rng.choice((0.01, 0.01, 0.01, 7.0))
    values = [0.5 + rng.uniform(-width, width) for _ in range(count)]
    while values and rng.random() < 0.3:
        values[rng.randrange(count)] = rng.choice(_NUMBERS)
    return values


def _other(rng, clock):
    """Return a well-formed message with random joints and numbers."""
    return joint_state(*_parts(rng, clock))


def _lying(rng, clock):
    """Return a message with a false count."""
    parts = _parts(rng, clock)
    return joint_state(*parts, lie(rng, len(parts[2])))


def _mangled(rng, clock):
    """Return a well-formed message broken at one or two places."""
    data = (right if rng.random() < 0.5 else _other)(rng, clock)
    for _ in range(rng.randint(1, 2)):
        data = broken(rng, data)
    return data


def _foreign(rng, clock):
    """Return a message with another representation in its header."""
    data = (right if rng.random() < 0.5 else _lying)(rng, clock)
    return rng.choice((rng.choice(_REPRESENTATIONS), rng.randbytes(4))) + data[4:]


def _noise(rng, clock):
    """Return random bytes."""
    return rng.randbytes(rng.randrange(120))


_WAYS = (right,) * 6 + (_other,) * 6 + (_lying, _lying, _mangled, _mangled, _foreign, _noise)
