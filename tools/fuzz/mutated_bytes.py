"""Bytes broken without regard to their meaning."""

# Longest input, bytes: longer than the 5 MB at which descriptions are refused.
_LONGEST = 6_000_000
_TIMES = (2, 2, 3, 10, 10, 100, 1_000, 20_000)


def broken(rng, data):
    """Return bytes truncated, or with some bytes flipped, removed, repeated or replaced."""
    start = rng.randint(0, len(data))
    end = min(len(data), start + rng.choice((0, 1, 2, 4, 8, rng.randint(0, 60))))
    return rng.choice(_WAYS)(rng, data, start, end)[:_LONGEST]


def _cut(rng, data, start, end):
    return data[:start]


def _flip(rng, data, start, end):
    return (
        data[:start] + bytes(byte ^ 1 << rng.randrange(8) for byte in data[start:end]) + data[end:]
    )


def _remove(rng, data, start, end):
    return data[:start] + data[end:]


def _repeat(rng, data, start, end):
    return data[:start] + data[start:end] * rng.choice(_TIMES) + data[end:]


def _replace(rng, data, start, end):
    return data[:start] + rng.randbytes(rng.choice((1, 1, 4, 8))) + data[end:]


_WAYS = (_cut, _flip, _flip, _remove, _repeat, _replace)
