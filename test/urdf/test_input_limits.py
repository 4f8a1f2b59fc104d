"""Oversized descriptions and those at the limits: refused or read within a second."""

import time

from dynamics_node import RobotDescriptionError
from dynamics_node.urdf import read_urdf
import pytest
import yourdfpy  # noqa: F401  (its import is not part of the measured times)


def many(text, count):
    """Return a robot of one link and a repeated text."""
    return '<robot name="r"><link name="a"/>' + text * count + '</robot>'


ATTRIBUTES = ' '.join(f'a{i}=""' for i in range(400_000))


@pytest.mark.parametrize(
    'text, message',
    [
        (many('<a/>', 1_200_000), 'it has 120000[0-9] tags, at most 200000 are accepted'),
        (many('<joint/>', 600_000), 'it has 60000[0-9] tags, at most'),
        (many('<joint/>', 1_001), 'it has more than 1000 joints'),
        (many('<link/>', 1_000), 'it has more than 1000 links'),
        (
            many(f'<a {ATTRIBUTES}/>', 1),
            'it has 40000[0-9] attributes, at most 100000 are accepted',
        ),
        ('<' + 'x' * 4_000_000 + '/>', r'root element is <x{57}\.\.\.>, expected'),
        (
            '<?xml version="1.0" encoding="' + 'x' * 4_000_000 + '"?><robot name="r"/>',
            r"encoding is 'x{57}\.\.\.', expected",
        ),
    ],
    ids=['elements', 'tags of joints', 'joints', 'links', 'attributes', 'root', 'encoding'],
)
def test_an_oversized_text_is_refused_quickly_with_a_short_message(text, message):
    start = time.process_time()
    with pytest.raises(RobotDescriptionError, match=message) as caught:
        read_urdf(text.encode())
    assert time.process_time() - start < 1.0
    assert len(str(caught.value)) < 300


@pytest.mark.parametrize(
    'text',
    [
        many('<a/>', 199_000),
        many('<a b=""/>', 99_000),
        many('&lt;', 1_200_000),
        many('<!-->-->', 190_000),
        many('x', 4_900_000),
    ],
    ids=['elements', 'attributes', 'references', 'comments', 'text'],
)
def test_a_text_at_the_limits_is_read_within_a_second(text):
    start = time.process_time()
    assert len(read_urdf(text.encode()).links) == 1
    assert time.process_time() - start < 1.0


@pytest.mark.parametrize('encoding', ['utf-7', 'shift_jis', 'cp037', 'nothing'])
def test_an_encoding_declared_behind_a_byte_order_mark_is_ignored(encoding):
    text = f'\ufeff<?xml version="1.0" encoding="{encoding}"?>' + many('', 0)
    assert read_urdf(text.encode()).root == 'a'
