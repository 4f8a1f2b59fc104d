"""docs/safety.md: every fault has its test, and the numbers are those of the code."""

from pathlib import Path
import re

from dynamics_node.ros import main, node
from dynamics_node.ros.support import process
from dynamics_node.ros.torque_path import command_output, controller_check
from dynamics_node.safety import effort_output, joint_state_buffer, motion_limits, torque_path
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
        ('impossible jump', motion_limits.JUMP_MARGIN),
        ('impossible jumps in a row', joint_state_buffer.MAX_JUMPS),
        ('shortest time between two states', motion_limits.SHORTEST_STEP),
        ('a stamp may differ', joint_state_buffer.SMALLEST_TOLERANCE),
        ('longest time above', effort_output.LONGEST_SATURATION),
        ('longest ramp of a stop after a fault', effort_output.MAX_FAULT_RAMP),
        ('longest stop without a ramp', effort_output.ZERO_WITHIN),
        ('a step counts at most', effort_output.MAX_PERIODS),
        ('times the clock may go back', torque_path.MAX_RESTARTS),
        ('most joint names', joint_state_buffer.MAX_NAMES),
        ('other publishers', node.CHECK_EVERY + command_output.IDLE_TICK),
        ('longest time without that search', torque_path.MAX_MONITOR_AGE),
        ('time a controller has', controller_check.ANSWER_WITHIN),
        ('signals closer together', process.SAME_SIGNAL),
        ('longest stop after a signal', main.GIVE_UP_AFTER),
        ('zero after a second signal', main.HURRY_WITHIN),
        ('an executor that raises', main.FAILING_FOR),
    ]
    assert [value for _, value in said] == [value for _, value in expected]
    for (words, _), (beginning, _) in zip(said, expected, strict=True):
        assert words.startswith(beginning)
