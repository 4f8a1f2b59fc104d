"""Machine code takes over without anybody waiting, and can be done without."""

import copy
import inspect
import os
import pickle
import subprocess
import sys
import time

from dynamics_node import RobotModel
from dynamics_node.dynamics.specialisation import Specialisation
from dynamics_node.kernels import specialised
from dynamics_node.kernels.specialised import background, robot_code
import numpy as np
import pytest
from support.machine_code import needs_machine_code
from support.robots import PENDULUM, random_urdf

pytestmark = needs_machine_code


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv('DYNAMICS_NODE_CACHE_DIR', str(tmp_path))
    monkeypatch.setattr(robot_code, '_loaded', {})
    monkeypatch.setattr(background, '_processes', {})
    return tmp_path


def test_a_model_that_is_used_often_gets_machine_code_by_itself():
    model = RobotModel.from_urdf(PENDULUM)
    q = np.array([0.3])
    expected = model.gravity_torque(q)
    end = time.monotonic() + 60
    while not model.is_specialised and time.monotonic() < end:
        np.testing.assert_allclose(model.gravity_torque(q), expected, rtol=1e-14)
    assert model.is_specialised
    np.testing.assert_allclose(model.gravity_torque(q), expected, rtol=1e-14)


def test_a_model_that_is_used_once_does_not():
    model = RobotModel.from_urdf(PENDULUM)
    model.gravity_torque([0.3])
    assert model._evaluation.specialisation._process is None


def test_the_next_model_of_the_robot_has_it_at_once():
    assert not RobotModel.from_urdf(PENDULUM).is_specialised
    assert RobotModel.from_urdf(PENDULUM).specialise()
    model = RobotModel.from_urdf(PENDULUM)
    assert model.is_specialised
    assert inspect.isbuiltin(model.dynamics)


def test_models_under_another_gravity_get_it_too():
    model = RobotModel.from_urdf(PENDULUM)
    before = model.with_gravity((0.0, 0.0, 0.0))
    assert model.specialise()
    after = model.with_gravity((0.0, 0.0, -1.0))
    for other in (before, after):
        assert other.is_specialised
        assert inspect.isbuiltin(other.gravity_torque)
    np.testing.assert_array_equal(before.gravity_torque(np.array([0.3])), [0.0])


def test_it_can_be_asked_for_without_waiting():
    model = RobotModel.from_urdf(PENDULUM)
    began = time.process_time()
    model.specialise(wait=False)
    # Neither waited for nor made here: either takes a second of work.
    assert not model.is_specialised
    assert time.process_time() - began < 0.1
    assert model.specialise(wait=True)


def test_while_enough_others_are_being_made_it_is_asked_for_again(monkeypatch):
    monkeypatch.setattr(background, '_MOST_AT_ONCE', 0)
    model = RobotModel.from_urdf(PENDULUM)
    model.specialise(wait=False)
    assert model._evaluation.specialisation._process is None
    monkeypatch.setattr(background, '_MOST_AT_ONCE', 1)
    end = time.monotonic() + 60
    while not model.is_specialised and time.monotonic() < end:
        model.gravity_torque([0.3])
    assert model.is_specialised


def test_it_can_be_switched_off(monkeypatch):
    monkeypatch.setenv('DYNAMICS_NODE_SPECIALISE', '0')
    model = RobotModel.from_urdf(PENDULUM)
    assert not model.specialise()
    assert not inspect.isbuiltin(model.dynamics)
    assert np.isfinite(model.gravity_torque([0.3])).all()


def test_a_robot_with_very_many_joints_goes_on_with_the_general_kernel():
    model = RobotModel.from_urdf(random_urdf(3, joints=60, with_mimic=False))
    assert not model.specialise()
    assert model.gravity_torque(np.zeros(60)).shape == (60,)


@pytest.mark.parametrize('duplicate', [
    copy.copy, copy.deepcopy, lambda item: pickle.loads(pickle.dumps(item))])
def test_a_model_and_its_methods_can_be_copied_and_pickled(duplicate):
    model = RobotModel.from_urdf(PENDULUM)
    model.note = 'mine'
    q = np.array([0.3])
    for _ in range(2):
        other = duplicate(model)
        assert other.note == 'mine'
        assert other.is_specialised == model.is_specialised
        np.testing.assert_array_equal(other.gravity_torque(q), model.gravity_torque(q))
        method = duplicate(model.gravity_torque)
        np.testing.assert_allclose(method(q), model.gravity_torque(q), rtol=1e-14)
        assert model.specialise()


def test_what_somebody_put_in_the_place_of_a_method_stays():
    model = RobotModel.from_urdf(PENDULUM)
    model.gravity_torque = lambda q: np.zeros(1)
    assert model.specialise()
    np.testing.assert_array_equal(model.gravity_torque(np.array([0.3])), [0.0])


@pytest.mark.parametrize('step', ['from_disk', 'make', 'start'])
def test_whatever_fails_the_general_kernel_goes_on(step, monkeypatch, caplog):
    def fail(*arguments):
        raise OSError('as it happens')

    monkeypatch.setattr(specialised, step, fail)
    model = RobotModel.from_urdf(PENDULUM)
    assert not model.specialise(wait=step != 'start')
    assert np.isfinite(model.gravity_torque([0.3])).all()
    assert 'the general kernel goes on: OSError: as it happens' in caplog.text


def test_a_failing_hand_out_does_not_reach_the_caller(caplog):
    class Refusing:
        def _use(self, code):
            raise AttributeError('no')

    model, refusing = RobotModel.from_urdf(PENDULUM), Refusing()
    assert model.specialise()
    specialisation = Specialisation(*model._evaluation.packed)
    specialisation.attach(refusing)
    assert 'the general kernel goes on: AttributeError' in caplog.text


def test_a_controller_may_use_its_model_to_the_end():
    # The finalizers of garbage run in any order: the machine code must outlive them all.
    script = f"""
import gc
import numpy as np
from dynamics_node import RobotModel

class Arm:
    def __init__(self, model):
        self.model, self.callback = model, self.hold
    def hold(self):
        return self.model.gravity_torque(np.array([0.3]))
    def __del__(self):
        self.hold()

for _ in range(10):
    model = RobotModel.from_urdf({str(PENDULUM)!r})
    assert model.specialise()
    Arm(model)
    del model
    gc.collect()
last = Arm(RobotModel.from_urdf({str(PENDULUM)!r}))
"""
    environment = dict(os.environ, PYTHONPATH=os.pathsep.join(sys.path))
    run = subprocess.run([sys.executable, '-c', script], env=environment, capture_output=True,
                         text=True, timeout=120)
    assert (run.returncode, run.stderr) == (0, '')


def test_a_method_of_a_subclass_stays():
    class Doubled(RobotModel):
        def gravity_torque(self, q):
            return 2.0 * super().gravity_torque(q)

    model, plain = Doubled.from_urdf(PENDULUM), RobotModel.from_urdf(PENDULUM)
    assert model.specialise()
    assert inspect.isbuiltin(model.dynamics)
    np.testing.assert_allclose(model.gravity_torque([0.3]), 2.0 * plain.gravity_torque([0.3]))


def test_python_may_end_while_it_is_made(folder):
    script = (f'from dynamics_node import RobotModel\n'
              f'RobotModel.from_urdf({str(PENDULUM)!r}).specialise(wait=False)\n')
    environment = dict(os.environ, PYTHONPATH=os.pathsep.join(sys.path))
    run = subprocess.run([sys.executable, '-W', 'always', '-c', script], env=environment,
                         capture_output=True, text=True, timeout=120)
    assert (run.returncode, run.stderr) == (0, '')
    # The other process finishes what it has begun.
    end = time.monotonic() + 60
    while not list(folder.iterdir()) and time.monotonic() < end:
        time.sleep(0.05)
    assert list(folder.iterdir())
