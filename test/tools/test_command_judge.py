"""The judge of commands: every violation is found, and correct commands are not accused."""

import random

import pytest
from soak.command_judge import CommandJudge

LIMIT, RATE = 10.0, 100.0


@pytest.fixture
def judge():
    """Return a judge of two joints whose output is on since t = 0."""
    judge = CommandJudge([LIMIT, 2 * LIMIT], [RATE, 2 * RATE])
    judge.state(-1.0, 'READY')
    judge.state(0.0, 'STARTING')
    return judge


def violations(judge):
    """Return all violations."""
    judge.settle()
    assert judge.count == len(judge.violations)
    return judge.violations


def test_a_ramp_at_the_rate_limit_is_fine(judge):
    for k in range(1, 10):
        judge.command(0.01 * k, [k, 2.0 * k])
    assert violations(judge) == []
    assert judge.commands == 9


def test_a_ramp_a_little_faster_than_the_rate_limit_is_found(judge):
    for k in range(1, 10):
        judge.command(0.01 * k, [1.01 * k, 0.0])
    assert violations(judge)
    assert 'joint 0: the step from' in judge.violations[0]


def test_all_joints_are_judged(judge):
    judge.command(0.01, [0.0, -2.1])
    [text] = violations(judge)
    assert 'joint 1: the step from 0 to -2.1' in text


@pytest.mark.parametrize('seed', range(20))
def test_a_node_that_is_interrupted_anywhere_is_not_accused(judge, seed):
    rng = random.Random(seed)
    now, written, effort = 0.0, 0.0, 0.0
    for _ in range(300):
        before = now
        now = written + rng.choice([0.0, 0.002, 0.1]) * rng.random()
        effort += RATE * (now - before) * rng.choice([-1, 1])
        effort = min(max(effort, -LIMIT), LIMIT)
        written = now + rng.choice([0.0001, 0.02]) * rng.random()
        judge.command(written, [effort, 0.0])
    assert violations(judge) == []


@pytest.mark.parametrize('seed', range(20))
def test_steps_a_tenth_too_large_are_found_in_the_same_disorder(judge, seed):
    rng = random.Random(seed)
    now, written, effort = 0.0, 0.0, 0.0
    for _ in range(300):
        before = now
        now = written + 0.002 * rng.random()
        step = 1.1 * RATE * (now - before)
        effort += step if effort < 0.0 else -step
        written = now + 0.0001 * rng.random()
        judge.command(written, [effort, 0.0])
    judge.settle()
    assert judge.count > 0


def test_a_late_command_excuses_the_step_after_it_once_only(judge):
    judge.command(1.0, [0.0, 0.0])
    # Possible: the clock for the one before was read at 0.5, and for this one at 1.0005.
    judge.command(1.001, [0.5, 0.0])
    judge.command(1.002, [0.7, 0.0])  # within 0.002 s, for the clock was read after 1.0
    judge.command(1.003, [1.2, 0.0])  # 0.005 s of the rate limit, at most 0.002 s after that
    [text] = violations(judge)
    assert text.startswith('at 1.003000') and 'from 0.7 to 1.2 takes 0.00499' in text


def test_limits_length_and_numbers(judge):
    judge.command(1.0, [LIMIT, -2 * LIMIT])
    judge.command(2.0, [LIMIT * 1.001, 0.0])
    judge.command(3.0, [1.0])
    judge.command(4.0, [])
    judge.command(5.0, [float('nan'), 0.0])
    judge.command(6.0, [0.0, float('-inf')])
    texts = violations(judge)
    assert [text[:5] for text in texts] == ['at 2.', 'at 3.', 'at 4.', 'at 5.', 'at 6.']
    assert 'expected at most 10, got 10.01' in texts[0]
    assert 'expected 2 values, got 1' in texts[1]


@pytest.mark.parametrize('state', ['READY', 'FAULT'])
def test_silence_while_off(judge, state):
    judge.command(1.0, [0.0, 0.0])
    judge.state(1.5, 'STOPPING')
    judge.command(1.6, [0.0, 0.0])
    judge.state(2.0, state)
    judge.command(2.1, [0.0, 0.0])
    judge.state(3.0, 'STARTING')
    judge.command(3.1, [0.0, 0.0])
    [text] = violations(judge)
    assert text.startswith('at 2.1') and f'expected silence in {state}' in text


def test_messages_are_judged_in_the_order_of_writing(judge):
    judge.state(2.0, 'FAULT')
    judge.command(1.0, [0.0, 0.0])
    judge.command(3.1, [0.0, 0.0])
    judge.settle(2.5)
    assert judge.commands == 1
    judge.state(3.0, 'STARTING')
    assert violations(judge) == []
    assert judge.commands == 2


def test_commands_that_did_not_arrive_are_counted_and_do_not_excuse(judge):
    for number, time in ((5, 0.1), (6, 0.11), (9, 0.14)):
        judge.command(time, [RATE * (time - 0.1), 0.0], number)
    judge.command(0.15, [7.0, 0.0], 10)
    assert len(violations(judge)) == 1
    assert judge.lost == 2


def test_another_node_begins_at_zero_and_in_silence(judge):
    judge.command(1.0, [LIMIT, 0.0], 70)
    judge.settle()
    judge.forget()
    judge.command(2.0, [0.0, 0.0], 1)
    assert len(violations(judge)) == 1
    assert 'before any state' in judge.violations[0]
    assert judge.lost == 0


def test_of_many_violations_the_first_are_kept(judge):
    for k in range(100):
        judge.command(1.0 + k, [])
    judge.settle()
    assert judge.count == 100
    assert len(judge.violations) == CommandJudge.MOST
