"""Streams of joint states: of the same joints, of others, permuted, wrong, cut and flipped."""

import random

from hypothesis import strategies as st

from .cdr import joint_state, lie
from .mutated_bytes import broken

JOINTS = ('shoulder', 'elbow', 'wrist', 'finger')
_USUAL = tuple(name.encode() + b'\x00' for name in JOINTS)
_UNUSUAL = (b'other\x00', b'\xff\xfe\x00', b'\x00', b'', b'elbow', b'el\x00bow\x00',
            b'w' * 300 + b'\x00', '肘\x00'.encode(), b'elbow\n\x00', b' elbow\x00', b'ELBOW\x00')
_FRAMES = (b'base\x00', b'base\x00', b'\x00', b'', b'base', b'\xff\x00', b'x' * 999 + b'\x00')
_NUMBERS = (float('nan'), float('inf'), -float('inf'), 1e308, -1.7e308, -0.0, 5e-324, 3.2, -6.3)
_REPRESENTATIONS = (b'\x00\x00\x00\x00', b'\x00\x01\x00\x03', b'\x00\x02\x00\x00',
                    b'\x00\x03\x00\x00', b'\x00\x06\x00\x00', b'\x00\x07\x00\x00',
                    b'\x00\x08\x00\x00', b'\x00\x0a\x00\x00', b'\xff\xff\xff\xff',
                    b'\x01\x00\x00\x00')


def streams():
    """
    Return a strategy of lists of bytes: what one subscription receives in turn.

    Hypothesis chooses the way of each message and a seed; see `descriptions` for why.

    """
    message = st.builds(lambda way, seed: way(random.Random(seed)), st.sampled_from(
        [_right, _right, _other, _other, _lying, _mangled, _mangled, _foreign]),
        st.integers(0, 2**32))
    return st.lists(st.one_of(*[message] * 9, st.binary(max_size=120)), min_size=1, max_size=8)


def _right(rng):
    """A robot's next state."""
    stamp = rng.randrange(60), rng.randrange(10**9)
    positions, velocities = ([rng.uniform(-3.0, 3.0) for _ in _USUAL] for _ in range(2))
    return joint_state(stamp, b'base\x00', _USUAL, (positions, velocities, []))


def _parts(rng):
    names = _names(rng)
    stamp = rng.choice((rng.randrange(60), rng.randint(-2**31, 2**31 - 1))), rng.choice(
        (0, rng.randrange(10**9), rng.randrange(2**32)))
    return stamp, rng.choice(_FRAMES), names, [_values(rng, len(names)) for _ in range(3)]


def _names(rng):
    way = rng.random()
    if way < 0.4:
        return list(_USUAL)
    if way < 0.6:
        return rng.sample(_USUAL, len(_USUAL))
    if way < 0.8:
        return [rng.choice(_USUAL) for _ in range(rng.randrange(7))]
    if way < 0.99:
        return [rng.choice(_USUAL + _UNUSUAL) for _ in range(rng.randrange(9))]
    return [*_USUAL, *(b'%d\x00' % i for i in range(rng.choice((4_092, 4_093, 6_000))))]


def _values(rng, count):
    if rng.random() < 0.2:
        count = rng.choice((0, 0, rng.randrange(9)))
    values = [rng.uniform(-7.0, 7.0) for _ in range(count)]
    while values and rng.random() < 0.3:
        values[rng.randrange(count)] = rng.choice(_NUMBERS)
    return values


def _other(rng):
    """Well made, but of any joints and numbers."""
    return joint_state(*_parts(rng))


def _lying(rng):
    """One count is not true."""
    parts = _parts(rng)
    return joint_state(*parts, lie(rng, len(parts[2])))


def _mangled(rng):
    """One or two places broken, of what was well made."""
    data = (_right if rng.random() < 0.5 else _other)(rng)
    for _ in range(rng.randint(1, 2)):
        data = broken(rng, data)
    return data


def _foreign(rng):
    """Another representation is said in front, and numbers may be in that order."""
    data = (_right if rng.random() < 0.5 else _lying)(rng)
    return rng.choice((rng.choice(_REPRESENTATIONS), rng.randbytes(4))) + data[4:]
