"""The faults of the link."""

import math

from builtin_interfaces.msg import Time
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import JointState
from soak.faulty_link import BUSY, FAULTS, FaultyLink, FLOOD, MANY, shifted, stamp_of

NAMES = ['a', 'b', 'c', 'd']


def state(k=0, name=NAMES):
    """Return the k-th state of a robot, with joints at k, k + 0.1, ..."""
    message = JointState(
        name=list(name),
        position=[k + 0.1 * i for i in range(len(name))],
        velocity=[0.5] * len(name),
        effort=[9.0] * len(name),
    )
    message.header.stamp = Time(sec=1000 + k, nanosec=7)
    return message


def put_through(fault, count=1, seed=0):
    """Return the output for each of the first `count` states."""
    link = FaultyLink(seed)
    link.switch(fault)
    return [link.out(state(k)) for k in range(count)]


def only(outputs):
    """Return the only message of the only state."""
    [[message]] = outputs
    return message


def by_name(message):
    """Return position, velocity and effort by name."""
    return {
        name: (q, qd, tau)
        for name, q, qd, tau in zip(
            message.name, message.position, message.velocity, message.effort
        )
    }


def test_without_a_fault_messages_pass():
    link = FaultyLink()
    message = state()
    assert link.fault == 'none'
    assert link.out(message)[0] is message


@pytest.mark.parametrize('fault', sorted(FAULTS))
def test_no_message_is_changed_in_place(fault):
    link = FaultyLink()
    link.switch(fault)
    for k in range(5):
        message = state(k)
        link.out(message)
        assert message == state(k)


@pytest.mark.parametrize('fault', ['', 'flod', 'nan/0', 'nan/x', 'nan/-1'])
def test_an_unknown_fault_is_refused_with_the_known_ones(fault):
    link = FaultyLink()
    with pytest.raises(ValueError, match=r'expected one of all_nan, bag_loop, duplicated.*got'):
        link.switch(fault)
    assert link.fault == 'none'


def test_a_fault_of_every_third_message():
    out = put_through('silent/3', 7)
    assert [len(messages) for messages in out] == [1, 1, 0, 1, 1, 0, 1]


def test_silent_and_frozen():
    assert put_through('silent', 3) == [[], [], []]
    assert put_through('frozen', 3) == [[state(0)]] * 3


def test_permuted_is_the_same_state_in_other_orders():
    out = [message for [message] in put_through('permuted', 20)]
    assert all(by_name(message) == by_name(state(k)) for k, message in enumerate(out))
    assert len({tuple(message.name) for message in out}) > 5


def test_parts_make_up_the_whole_and_half_does_not():
    [first], [second], [third] = put_through('parts', 3)
    assert {*first.name} | {*second.name} == {*NAMES}
    assert not {*first.name} & {*second.name}
    assert third.name == first.name
    assert by_name(first).items() <= by_name(state(0)).items()
    assert [message.name for [message] in put_through('half', 2)] == [['a', 'b']] * 2


def test_duplicated():
    assert put_through('duplicated') == [[state(0), state(0)]]


def test_nan_is_one_position_that_is_not_finite():
    out = [message for [message] in put_through('nan', 30)]
    assert all(sum(not math.isfinite(q) for q in message.position) == 1 for message in out)
    assert {repr(q) for message in out for q in message.position if not math.isfinite(q)} == {
        'nan',
        'inf',
        '-inf',
    }
    assert all(map(math.isnan, only(put_through('all_nan')).position))


def test_lengths_and_names_do_not_fit():
    out = [message for [message] in put_through('length', 30)]
    assert {len(message.position) for message in out} == {0, 3, 5}
    assert only(put_through('name_twice')).name == ['b', 'b', 'c', 'd']
    assert not {*only(put_through('unknown_names')).name} & {*NAMES}


def test_a_flood_ends_with_the_state_itself():
    [out] = put_through('flood')
    messages = [deserialize_message(data, JointState) for data in out]
    assert len(messages) == FLOOD
    stamps = [stamp_of(data) for data in out]
    assert stamps == sorted(set(stamps))
    assert stamps[-1] - stamps[0] < 2_000_000  # less than the period of 500 Hz
    assert messages[-1] == state(0)
    assert all(by_name(message) == by_name(state(0)) for message in messages)


def test_many_names_are_a_message_that_can_be_read():
    message = deserialize_message(only(put_through('many_names')), JointState)
    assert len(message.name) == len(message.position) == MANY
    assert {*message.name} == {'j'}
    assert 16e6 <= len(only(put_through('million_names'))) < 17e6


def test_during_a_million_names_no_state_passes():
    out = put_through('million_names/50', 50 + BUSY + 4)
    assert [len(messages) for messages in out] == [*[1] * 50, *[0] * BUSY, 1, 1, 1, 1]
    assert isinstance(out[49][0], bytes) and out[-1][0].name == NAMES


def test_jump_and_too_fast():
    assert only(put_through('jump')).position == pytest.approx([1.0, 1.1, 1.2, 1.3])
    assert only(put_through('too_fast')).velocity.tolist() == [50.0] * 4
    assert only(put_through('too_fast')).position == state(0).position


def test_stamps():
    assert only(put_through('no_stamp')).header.stamp == Time()
    assert only(put_through('old_stamp')).header.stamp == Time(sec=970, nanosec=7)
    assert only(put_through('future_stamp')).header.stamp == Time(sec=1030, nanosec=7)
    assert only(put_through('future_stamp')).position == state(0).position


def test_a_bag_loop_repeats_what_came_before_it():
    link = FaultyLink()
    for k in range(4):
        link.out(state(k))
    link.switch('bag_loop')
    out = [link.out(state(k))[0].header.stamp.sec for k in range(4, 16)]
    # Five states, over and over: those before and the one at which it began.
    assert out[:5] == out[5:10] and {*out} == {1000, 1001, 1002, 1003, 1004}


def test_garbage_is_seldom_a_joint_state():
    out = [data for [data] in put_through('garbage', 200)]
    assert all(isinstance(data, bytes) for data in out)
    assert len({*out}) > 190
    assert serialize_message(state(0)) not in out
    assert any(len(data) < 20 for data in out)


def test_the_same_seed_is_the_same_garbage():
    assert put_through('garbage', 20, 3) == put_through('garbage', 20, 3)
    assert put_through('garbage', 20, 3) != put_through('garbage', 20, 4)


def test_a_serialized_state_is_moved_in_time():
    data = serialize_message(state(0))
    earlier = shifted(data, -2_000_000_008)
    assert stamp_of(data) == 1_000_000_000_007
    assert deserialize_message(earlier, JointState).header.stamp == Time(
        sec=997, nanosec=999_999_999
    )
    assert by_name(deserialize_message(earlier, JointState)) == by_name(state(0))
