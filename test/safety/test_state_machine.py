"""The states of the output: which follows which, and when."""

from itertools import pairwise

from dynamics_node.safety import OutputState, OutputStateMachine
from hypothesis import given
from hypothesis import strategies as st

ALLOWED = {('READY', 'STARTING'), ('READY', 'FAULT'), ('STARTING', 'ACTIVE'),
           ('STARTING', 'STARTING'), ('STARTING', 'STOPPING'), ('ACTIVE', 'STARTING'),
           ('ACTIVE', 'STOPPING'), ('STOPPING', 'READY'), ('STOPPING', 'FAULT'),
           ('FAULT', 'STARTING'), ('FAULT', 'FAULT')}


def test_a_whole_run():
    seen = []
    machine = OutputStateMachine(lambda state, reason: seen.append((state.name, reason)))
    assert machine.enable(10.0, 0.5)
    assert machine.progress(10.25) == 0.5
    machine.advance(10.4)
    assert machine.name == 'STARTING'
    machine.advance(10.5)
    assert machine.name == 'ACTIVE'
    machine.stop(12.0, 1.0, 'disabled on request')
    assert machine.progress(12.25) == 0.25
    machine.advance(13.0)
    assert seen == [('STARTING', 'enabled'), ('ACTIVE', 'start ramp done'),
                    ('STOPPING', 'disabled on request'),
                    ('READY', 'stopped: disabled on request')]


def test_a_fault_is_latched_until_the_next_enable():
    machine = OutputStateMachine()
    machine.enable(0.0, 0.0)
    machine.advance(0.0)
    machine.stop(1.0, 1.0, 'stale', is_fault=True)
    machine.stop(1.5, 1.0, 'disabled on request')
    machine.advance(2.0)
    assert (machine.name, machine.reason) == ('FAULT', 'stale')
    machine.advance(99.0)
    assert machine.name == 'FAULT'
    assert machine.enable(100.0, 1.0)
    machine.stop(100.5, 1.0, 'done')
    machine.advance(102.0)
    assert machine.name == 'READY'


def test_the_first_fault_of_several_is_the_one_that_is_told():
    machine = OutputStateMachine()
    machine.enable(0.0, 1.0)
    machine.stop(0.5, 1.0, 'first', is_fault=True)
    machine.stop(0.6, 1.0, 'second', is_fault=True)
    machine.advance(2.0)
    assert machine.reason == 'first'


def test_a_fault_while_off_latches_at_once():
    machine = OutputStateMachine()
    machine.stop(0.0, 1.0, 'broken', is_fault=True)
    assert (machine.name, machine.reason) == ('FAULT', 'broken')


def test_a_stop_can_be_hastened_but_never_slowed():
    machine = OutputStateMachine()
    machine.enable(0.0, 0.0)
    machine.stop(0.0, 60.0, 'disabled on request')
    machine.hasten(1.0, 2.0)
    assert machine.progress(3.0) == 1.0
    machine.hasten(1.0, 50.0)
    assert machine.progress(3.0) == 1.0


def test_a_restart_begins_the_ramp_anew_and_only_while_driving():
    machine = OutputStateMachine()
    machine.restart(0.0, 1.0, 'the clock went back')
    assert machine.name == 'READY'
    machine.enable(0.0, 1.0)
    machine.advance(1.0)
    machine.restart(5.0, 1.0, 'the clock went back')
    assert (machine.name, machine.reason) == ('STARTING', 'the clock went back')
    assert machine.progress(5.5) == 0.5
    machine.stop(5.6, 1.0, 'off')
    machine.restart(5.7, 1.0, 'the clock went back')
    assert machine.name == 'STOPPING'


def test_enabling_twice_or_while_stopping_changes_nothing():
    machine = OutputStateMachine()
    assert machine.enable(0.0, 1.0)
    assert not machine.enable(0.5, 1.0)
    machine.stop(0.6, 1.0, 'off')
    assert not machine.enable(0.7, 1.0)
    assert machine.name == 'STOPPING'


@given(st.lists(st.tuples(st.sampled_from(
    ['enable', 'stop', 'fault', 'advance', 'hasten', 'restart']), st.floats(0, 2)), max_size=40))
def test_no_sequence_of_calls_makes_a_step_that_is_not_allowed(calls):
    changes = ['READY']
    machine = OutputStateMachine(lambda state, reason: changes.append(state.name))
    now = 0.0
    for call, step in calls:
        now += step
        if call == 'enable':
            machine.enable(now, 1.0)
        elif call == 'advance':
            machine.advance(now)
        elif call == 'restart':
            machine.restart(now, 1.0, 'the clock went back')
        elif call == 'hasten':
            machine.hasten(now, 0.1)
        else:
            machine.stop(now, 1.0, call, is_fault=call == 'fault')
        assert 0.0 <= machine.progress(now) <= 1.0
    assert set(pairwise(changes)) <= ALLOWED


def test_numbers_are_those_of_the_message():
    assert [state.value for state in OutputState] == [0, 1, 2, 3, 4]
