"""A robot's machine code: made once, found again, compared before it is used."""

import threading

from dynamics_node import RobotModel
from dynamics_node.kernels.packing import pack
from dynamics_node.kernels.specialised import robot_code, store
import numpy as np
import pytest
from support.robots import PENDULUM, random_urdf


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv('DYNAMICS_NODE_CACHE_DIR', str(tmp_path))
    return tmp_path


@pytest.fixture
def packed():
    model = RobotModel.from_urdf(PENDULUM)
    return pack(model.tree, model.gravity)


def test_what_was_made_is_found_on_disk(packed, folder):
    assert robot_code.from_disk(*packed) is None
    assert robot_code.make(*packed) is not None
    assert [path.name for path in folder.iterdir()] == [store.key(*packed)]
    assert robot_code.from_disk(*packed) is not None


def test_code_of_another_robot_is_refused(packed):
    other = RobotModel.from_urdf(PENDULUM.read_text().replace('mass value="', 'mass value="3'))
    wrong = robot_code.compile_robot(*pack(other.tree, other.gravity))
    store.save(store.key(*packed), wrong)
    assert robot_code.from_disk(*packed) is None
    with pytest.raises(RuntimeError, match='something else'):
        robot_code.RobotCode(*packed, wrong)


def test_the_background_tells_when_it_is_ready(packed):
    answers = []
    robot_code.make_in_background(*packed, answers.append).join()
    assert isinstance(answers[0], robot_code.RobotCode)


def test_what_is_being_made_can_be_abandoned(packed, monkeypatch, folder):
    monkeypatch.setattr(robot_code, '_abandoned', threading.Event())
    robot_code.abandon()
    answers = []
    robot_code.make_in_background(*packed, answers.append).join()
    assert answers == [None]
    assert list(folder.iterdir()) == []


def test_a_robot_with_very_many_joints_gets_none():
    model = RobotModel.from_urdf(random_urdf(3, joints=60, with_mimic=False))
    packed = pack(model.tree, model.gravity)
    assert robot_code.make(*packed) is None
    answers = []
    robot_code.make_in_background(*packed, answers.append).join()
    assert answers == [None]


def test_ordinary_numbers_are_finite_and_angles_not_too_large():
    plain = np.zeros((3, 2))
    assert robot_code.are_ordinary('dynamics', [plain, plain])
    assert robot_code.are_ordinary('dynamics', [plain, plain + 1e6])
    assert not robot_code.are_ordinary('dynamics', [plain + 1e6, plain])
    for bad in (np.nan, np.inf, -np.inf):
        spoilt = plain.copy()
        spoilt[2, 1] = bad
        assert not robot_code.are_ordinary('dynamics', [spoilt, plain])
        assert not robot_code.are_ordinary('dynamics', [plain, spoilt])
