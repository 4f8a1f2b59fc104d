"""The states of the output: latched faults, reported changes, failing observers."""

from dynamics_interfaces.msg import OutputState as Message
from dynamics_node.safety import OutputState, OutputStateMachine
from hypothesis import given
from hypothesis import strategies as st


def machine():
    """Return a machine and the list of changes that its observer receives."""
    heard = []
    return OutputStateMachine(lambda state, reason: heard.append((state.name, reason))), heard


def test_every_change_is_reported_once_with_its_reason():
    unit, heard = machine()
    unit.enter(OutputState.STARTING, 'enabled')
    unit.enter(OutputState.STARTING, 'enabled')
    unit.enter(OutputState.ACTIVE, 'full')
    assert heard == [('STARTING', 'enabled'), ('ACTIVE', 'full')]
    assert unit.is_driving
    assert unit.is_on
    assert unit.name == 'ACTIVE'


def test_the_first_fault_is_latched():
    unit, heard = machine()
    unit.latch('first')
    unit.latch('second')
    unit.enter(OutputState.FAULT, unit.fault)
    for i in range(1000):  # repeated faults are one event
        unit.enter(OutputState.FAULT, f'another {i}')
    assert heard == [('FAULT', 'first')]
    assert unit.fault == 'first'
    assert not unit.is_on


def test_a_failing_observer_has_no_effect(caplog):
    def fail(state, reason):
        raise RuntimeError('publisher is gone')

    unit = OutputStateMachine(fail)
    unit.enter(OutputState.STARTING, 'enabled')
    assert unit.state == OutputState.STARTING
    assert 'publisher is gone' in caplog.text


@given(st.lists(st.sampled_from(list(OutputState)), max_size=20))
def test_the_output_is_on_in_the_states_with_commands(states):
    unit, _ = machine()
    for state in states:
        unit.enter(state, 'test')
        assert unit.is_driving == (unit.name in ('STARTING', 'ACTIVE'))
        assert unit.is_on == (unit.name in ('STARTING', 'ACTIVE', 'STOPPING'))


def test_numbers_are_those_of_the_message():
    assert {state.name: int(state) for state in OutputState} == {
        name: getattr(Message, name)
        for name in ('READY', 'STARTING', 'ACTIVE', 'STOPPING', 'FAULT', 'HOLDING')
    }
