"""
`python -m fuzz.seeded_defects`: seed one defect after the other, and print the answers as JSON.

A separate process, because an audit hook cannot be removed.

"""

from contextlib import suppress
import importlib
import json
import logging
import random
import socket
from unittest import mock

from dynamics_node.ros.torque_path import joint_state_cdr
from dynamics_node.safety import JointStateBuffer, RejectedStateError
from dynamics_node.urdf import read
import numpy as np

from . import description_target, joint_state_target, joint_states
from .__main__ import be_strict
from .cdr import joint_state

_TEXT = description_target.bases()[0].encode()
_STATES = [
    joint_states.right(random.Random(i), joint_states.CLOCK + i * joint_states.PERIOD)
    for i in range(3)
]
_CUT = _STATES[0][:-30]
# Count 3, that of the positions, is false.
_LYING = [joint_state((5, 0), b'base\x00', [b'elbow\x00'], ([0.5], [], []), lie=(3, 2**28))]


def _open(*_):
    return open('/dev/null')  # noqa: PTH123


def _open_and_go_on(*_):
    with suppress(Exception):
        _open()


def _refuse(buffer, *_):
    buffer._position[0] += 1e-9
    raise RejectedStateError('length', 'never')


def _reversed(arrays):
    return arrays and [values[::-1] for values in arrays]


def _spoil(buffer, *_):
    buffer._position[0] = np.nan


_good_measure = joint_state_cdr.JointStateReader._measure
_good_as_before = joint_state_cdr.JointStateReader._as_before
_good_learn = joint_state_cdr.JointStateReader._learn
_good_end = joint_state_cdr.end_of_names
_Reader = joint_state_cdr.JointStateReader
# Defect → object, attribute, replacement, input.
SEEDED = {
    'nothing in a description': (read, 'math', read.math, _TEXT),
    'a file is opened': (read, 'check_text', _open, _TEXT),
    'a file is opened and the error caught': (read, 'check_text', _open_and_go_on, _TEXT),
    'a socket is opened': (read, 'check_text', lambda text: socket.socket(), _TEXT),
    'something is imported': (
        read,
        'check_text',
        lambda text: importlib.import_module('tabnanny'),
        _TEXT,
    ),
    'another library logs': (read, 'check_text', lambda text: logging.error('dear me'), _TEXT),
    'an exception of another kind': (read, 'check_text', lambda text: {}[0], _TEXT),
    'a message of two lines': (read, 'structure_problems', lambda robot: ['a\nb'], _TEXT),
    'a message without end': (read, 'structure_problems', lambda robot: ['a' * 99_999], _TEXT),
    'a mass matrix that is not finite': (
        description_target.RobotModel,
        'mass_matrix',
        lambda *_: np.array(np.inf),
        _TEXT,
    ),
    'nothing in the states': (joint_state_cdr, 'sys', joint_state_cdr.sys, _STATES),
    'rclpy prints': (joint_state_cdr, 'end_of_names', lambda data: 0, _LYING),
    'a cut message is read': (
        _Reader,
        '_learn',
        lambda self, data: _good_learn(self, _STATES[1]),
        [_CUT],
    ),
    'a number is wrong': (
        _Reader,
        '_measure',
        lambda self, data: _reversed(_good_measure(self, data)),
        _STATES,
    ),
    'a number is wrong in a state like the last': (
        _Reader,
        '_as_before',
        lambda self, data: _reversed(_good_as_before(self, data)),
        _STATES,
    ),
    'a good message is refused': (
        joint_state_cdr,
        'end_of_names',
        lambda data: _good_end(data[:-8]),
        _STATES,
    ),
    'a refused message moves a joint': (JointStateBuffer, 'update', _refuse, _STATES),
    'a position that is not finite': (JointStateBuffer, 'update', _spoil, _STATES),
}


def main():
    """Print the answer of a target for each defect, as JSON."""
    be_strict()
    description_target.warm_up()
    joint_state_target.warm_up()
    print(json.dumps({name: _answer(*defect) for name, defect in SEEDED.items()}))


def _answer(owner, name, replacement, given):
    target = description_target if isinstance(given, bytes) else joint_state_target
    with mock.patch.object(owner, name, replacement):
        try:
            return str(target.check(given))
        except Exception as error:
            return f'{type(error).__name__}: {error}'


if __name__ == '__main__':
    main()
