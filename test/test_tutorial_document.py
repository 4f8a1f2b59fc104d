"""docs/tutorial.md: all blocks run in order and print the stated output."""

from pathlib import Path
import sys

import pytest

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / 'scripts'))

from tutorial.page import Block, join, PATH, split  # noqa: E402
from tutorial.session import fits, numbers, Session, shape  # noqa: E402


@pytest.mark.timeout(300)
def test_it_prints_what_the_page_says():
    stated = split(PATH.read_text())
    session = Session()
    try:
        printed = session.run(stated)
    finally:
        session.close()
    for before, now in zip(stated, printed, strict=True):
        if isinstance(before, Block):
            assert shape(now.text) == shape(before.text)
            if before.text.startswith('the shoulder went'):
                # How far a push goes depends on how punctual the simulation is.
                went, *rest = numbers(now.text)
                assert -45.0 < went < -10.0
                assert rest == pytest.approx(numbers(before.text)[1:], abs=0.3)
            else:
                assert numbers(now.text) == pytest.approx(numbers(before.text), rel=0.1, abs=0.3)
    assert sum(isinstance(part, Block) for part in stated) > 20


def test_the_page_is_taken_apart_and_put_together_again():
    page = PATH.read_text()
    parts = split(page)
    assert join(parts) == page
    assert '```' not in ''.join(part for part in parts if isinstance(part, str))
    assert not [part for part in parts if isinstance(part, Block) and ' ...\n' in part.text]


@pytest.mark.parametrize(
    ('stated', 'line', 'does'),
    [
        ('[INFO] [1795372226.228780977] [n]: at 1.5', '[INFO] [1795379999.1] [n]: at 1.7', True),
        ('at 1.5 N m', 'at 1.5 N', False),
        ('READY ...', '[n]: output READY: off', True),
        ('READY ...', '[n]: output FAULT: off', False),
    ],
)
def test_a_line_fits_but_for_its_stamp_and_its_numbers(stated, line, does):
    assert fits(stated, line) is does


def test_what_is_printed_and_not_shown_is_an_error():
    session = Session()
    with pytest.raises(AssertionError, match='does not show what was printed: hidden'):
        session.run([Block('python', '', "print('hidden')"), Block('python', '', 'pass')])
