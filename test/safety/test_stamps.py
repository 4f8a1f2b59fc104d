"""Stamps against the clock: what can be true, and what is said of the rest."""

from dynamics_node.safety import RejectedStateError, StampTolerance
import pytest

SECOND = 1_000_000_000
NOW = 1_700_000_000 * SECOND


@pytest.mark.parametrize('late', [0, 0.05, 0.3, -0.05, -0.3])
def test_a_stamp_as_far_as_a_state_may_be_old_passes(late):
    StampTolerance(0.3).check(NOW - round(late * SECOND), NOW)


@pytest.mark.parametrize(
    'late, text',
    [
        (0.301, r'within 0\.3 s of the clock, got one 0\.301 s old'),
        (3600, r'3600\.000 s old: synchronise the clocks'),
        (-0.4, r'0\.400 s in the future'),
        (NOW / SECOND, 'set use_sim_time on both sides or on neither'),
    ],
)
def test_a_stamp_further_away_is_refused_in_words(late, text):
    with pytest.raises(RejectedStateError, match=text) as caught:
        StampTolerance(0.3).check(NOW - round(late * SECOND), NOW)
    assert caught.value.kind == 'stamp'
    assert not caught.value.is_fault


def test_a_very_short_timeout_leaves_room_for_clocks_that_are_synchronised():
    StampTolerance(0.005).check(NOW - SECOND // 11, NOW)


def test_a_stamp_far_ahead_of_the_clock_was_given_before_the_clock_was_set_back():
    tolerance = StampTolerance(0.1)
    assert tolerance.is_ahead(NOW + SECOND, NOW)
    assert not tolerance.is_ahead(NOW + SECOND // 20, NOW)
    assert not tolerance.is_ahead(NOW - SECOND, NOW)
