"""Latencies of commands, which have no stamps."""

import math

import pytest
from soak.latency import HISTORY, Latency


@pytest.fixture
def latency():
    """Return a Latency with an ACTIVE output."""
    latency = Latency()
    latency.state(0.0, 'ACTIVE')
    return latency


def values(latency):
    """Return all latencies, ms."""
    latency.settle()
    return [round(1e3 * value, 6) for value in latency.values]


def test_each_command_is_paired_with_its_state_in_any_order_of_arrival(latency):
    latency.answer(1.0012, 7)
    latency.command(1.0010)
    latency.sent(1.0, 7)
    latency.sent(1.002, 8)
    latency.answer(1.0035, 8)
    latency.command(1.0034)
    assert values(latency) == [1.0, 1.4]
    assert latency.quantile(1.0) == pytest.approx(0.0014)


def test_a_state_that_was_skipped_or_sent_meanwhile_changes_nothing(latency):
    latency.sent(1.0, 1)
    latency.sent(1.002, 2)  # while the node is busy
    latency.sent(1.004, 3)
    latency.command(1.005)
    latency.answer(1.0051, 1)
    latency.command(1.006)
    latency.answer(1.0061, 3)
    assert values(latency) == [5.0, 2.0]


def test_an_answer_without_a_command_of_its_own_does_not_count(latency):
    latency.sent(1.0, 1)
    latency.command(1.001)
    latency.answer(1.0011, 1)
    latency.sent(1.002, 2)
    latency.answer(1.003, 2)
    latency.answer(1.004, 99)
    assert values(latency) == [1.0]


def test_commands_of_a_stop_answer_no_state(latency):
    latency.sent(1.0, 1)
    latency.state(1.0001, 'STOPPING')
    latency.command(1.001)
    latency.answer(1.002, 1)
    assert values(latency) == []
    assert math.isnan(latency.quantile(0.99))


def test_messages_in_transit_are_awaited(latency):
    latency.sent(1.0, 1)
    latency.command(1.001)
    latency.settle(1.5)
    latency.answer(1.0015, 1)
    assert values(latency) == [1.0]


def test_old_states_without_an_answer_are_dropped(latency):
    for stamp in range(2 * HISTORY):
        latency.sent(1.0, stamp)
    latency.settle()
    assert len(latency._sent) == HISTORY
