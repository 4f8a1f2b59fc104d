"""The first target: a robot description, as the node reads it from its topic."""

from dynamics_node import DynamicsError, RobotDescriptionError, RobotModel
from dynamics_node.ros.parameters.table import check_all
from dynamics_node.ros.torque_path.active_robot import ActiveRobot
import numpy as np

from .audit import nothing_opened
from .descriptions import bases, descriptions
from .error_digest import error_digest

NAME = 'descriptions'
SUFFIX = '.urdf'
# Characters: one sentence about up to 1000 links, each quoted with at most 62 characters.
_LONGEST_PROBLEM = 70_000


def inputs():
    """Return the strategy of lists of inputs."""
    return descriptions()


def warm_up():
    """Load lazy modules."""
    for text in set(bases()):
        _answer(text.encode())


def to_bytes(data):
    """Convert an input to the content of a file."""
    return data


def from_bytes(data):
    """Convert the content of a file to an input."""
    return data


def check(data):
    """
    Process a description.

    Returns
    -------
    list of str
        The answer: 'taken', or the digest of the error.

    Raises
    ------
    Exception
        The finding.

    """
    with nothing_opened():
        return [_answer(data)]


def _answer(data):
    try:
        model = RobotModel.from_urdf(data)
    except RobotDescriptionError as error:
        _check_sentences(error.problems)
        return 'refused: ' + error_digest(error.problems[0])
    _check_sentences(model.warnings)
    return _use(model) if model.joint_names else 'taken: no joint moves'


def _check_sentences(sentences):
    for sentence in sentences:
        assert sentence.isprintable(), f'not to be printed: {sentence!r}'
        assert 0 < len(sentence) <= _LONGEST_PROBLEM, f'{len(sentence)} characters: {sentence:.99}'


def _gravity_torque(robot):
    compensation = robot.compensation(check_all({}))
    return compensation.torques(robot.buffer.position, robot.buffer.velocity)[0]


def _use(model):
    robot = ActiveRobot(model, ())
    q = robot.buffer.position
    assert np.isfinite(q).all(), f'neutral position {q}'
    try:
        for name, array in (
            ('G', _gravity_torque(robot)),
            ('D', model.mass_matrix(q)),
            ('C', model.coriolis_matrix(q, np.ones_like(q))),
        ):
            assert np.isfinite(array).all(), f'{name} is not finite: {array}'
        is_usable = robot.is_mass_matrix_positive_definite()
    except DynamicsError as error:
        return 'taken, then refused: ' + error_digest(str(error))
    robot.unlimited_joints([])
    repr(model)
    assert not model.is_specialized
    return 'taken' if is_usable else 'taken: D is not positive definite'
