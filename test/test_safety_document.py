"""docs/safety.md: every fault has its test, and the numbers are those of the code."""

from pathlib import Path
import re

from dynamics_node.ros import controller_check, main, node
from dynamics_node.safety import channel, joint_state_buffer, motion_limits, stamps
import pytest

TESTS = Path(__file__).parent
DOCUMENT = TESTS.parent / 'docs' / 'safety.md'
ROW = re.compile(r'^\| (\d+) \|(.*)\|(.*)\|(.*)\|$', re.MULTILINE)
NUMBER = re.compile(r'^\| ([a-z`].*[A-Za-z`]) \| ([\d.]+)( s)? \|$', re.MULTILINE)


@pytest.fixture(scope='module')
def text():
    return DOCUMENT.read_text(encoding='utf-8')


def test_all_42_faults_are_there_in_their_order(text):
    assert [int(number) for number, *_ in ROW.findall(text)] == list(range(1, 43))


def test_every_fault_names_tests_that_exist(text):
    for number, fault, behavior, tests in ROW.findall(text):
        assert fault.strip()
        assert behavior.strip()
        named = re.findall(r'`([^`]+)::([^`]+)`', tests)
        assert named, f'fault {number}'
        for path, name in named:
            source = (TESTS / path).read_text(encoding='utf-8')
            assert re.search(rf'^def {name}\(', source, re.MULTILINE), f'{path}::{name}'


def test_all_tests_that_are_named_exist(text):
    named = set(re.findall(r'`([\w/]+\.py)::(\w+)`', text))
    assert len(named) > 60
    for path, name in named:
        source = (TESTS / path).read_text(encoding='utf-8')
        assert re.search(rf'^def {name}\(', source, re.MULTILINE), f'{path}::{name}'


def test_the_numbers_are_those_of_the_code(text):
    said = [(words, float(value)) for words, value, _ in NUMBER.findall(text)]
    expected = [
        ('impossible jump', motion_limits.VELOCITY_MARGIN),
        ('runaway', motion_limits.VELOCITY_MARGIN),
        ('impossible jumps in a row', joint_state_buffer.MAX_JUMPS),
        ('shortest time between two states', motion_limits.SHORTEST_STEP),
        ('a stamp may differ', stamps.SMALLEST_TOLERANCE),
        ('longest time above', channel.LONGEST_SATURATION),
        ('times the clock may go back', channel.MAX_RESTARTS),
        ('most joint names', joint_state_buffer.MAX_NAMES),
        ('other publishers', node.RIVALS_EVERY),
        ('time a controller has', controller_check.ANSWER_WITHIN),
        ('longest stop', main.GIVE_UP_AFTER)]
    assert [value for _, value in said] == [value for _, value in expected]
    for (words, _), (beginning, _) in zip(said, expected, strict=True):
        assert words.startswith(beginning)
