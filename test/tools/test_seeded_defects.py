"""Seeded defects: each is detected by its target."""

import json

from fuzz.seeded_defects import SEEDED
import pytest
from support.python_process import run_tool

DETECTED = {
    'nothing in a description': "['taken",
    'a file is opened': "OpenedError: open ('/dev/null'",
    'a file is opened and the error caught': "OpenedError: open ('/dev/null'",
    'a socket is opened': 'OpenedError: socket.__new__',
    'something is imported': 'OpenedError: open',
    'another library logs': 'AssertionError: root logs: dear me',
    'an exception of another kind': 'KeyError: 0',
    'a message of two lines': 'AssertionError: not to be printed',
    'a message without end': 'AssertionError: 99999 characters',
    'a mass matrix that is not finite': 'AssertionError: D is not finite',
    'nothing in the states': "['taken: usable', 'taken: usable', 'taken: usable']",
    'rclpy prints': 'PrintedError: sequence size exceeds',
    'a cut message is read': 'AssertionError: rclpy does not read this message',
    'a number is wrong': 'AssertionError',
    'a number is wrong in a state like the last': 'AssertionError',
    'a good message is refused': 'AssertionError: rclpy reads this message',
    'a refused message moves a joint': 'AssertionError: a refused message changed',
    'a position that is not finite': 'AssertionError: position [nan',
}


@pytest.fixture(scope='module')
def responses():
    """Return the answer of a target for each defect."""
    run = run_tool('fuzz.seeded_defects')
    assert run.returncode == 0, run.stderr
    return json.loads(run.stdout)


def test_all_seeded_defects_are_tested():
    assert list(DETECTED) == list(SEEDED)


@pytest.mark.parametrize('defect', DETECTED)
def test_a_seeded_defect_is_detected(defect, responses):
    assert responses[defect].startswith(DETECTED[defect])
