"""A robot's machine code: made once, found again, compared before it is used."""

from dynamics_node import RobotModel
from dynamics_node.kernels import closed_form
from dynamics_node.kernels.packing import pack
from dynamics_node.kernels.specialised import quantities, robot_code, store
import numpy as np
import pytest
from support.robots import PENDULUM, random_urdf


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv('DYNAMICS_NODE_CACHE_DIR', str(tmp_path))
    monkeypatch.setattr(robot_code, '_loaded', {})
    return tmp_path


@pytest.fixture
def packed():
    model = RobotModel.from_urdf(PENDULUM)
    return pack(model.tree, model.gravity)


def test_what_was_made_is_found_on_disk(packed, folder, monkeypatch):
    assert robot_code.from_disk(*packed) is None
    assert robot_code.make(*packed) is not None
    assert [path.name for path in folder.iterdir()] == [store.key(*packed)]
    monkeypatch.setattr(robot_code, '_loaded', {})
    monkeypatch.delattr(robot_code, 'compile_robot')
    assert robot_code.make(*packed) is not None


def test_code_of_another_robot_is_refused(packed):
    other = RobotModel.from_urdf(PENDULUM.read_text().replace('mass value="', 'mass value="3'))
    wrong = robot_code.compile_robot(*pack(other.tree, other.gravity))
    store.save(store.key(*packed), wrong)
    with pytest.raises(RuntimeError, match='something else'):
        robot_code.from_disk(*packed)
    assert robot_code.make(*packed) is not None


@pytest.mark.parametrize('name', quantities.SIGNATURES)
def test_one_wrong_function_is_enough(packed, name, monkeypatch):
    # Each quantity is recorded with a mass of its own, in one function after the other.
    heavier = packed[1].copy()
    heavier[0, closed_form.INERTIA : closed_form.MULTIPLIER] *= 1.0 + 1e-6
    right = {record.__name__: record for record in quantities.ALL}
    records = [
        (lambda s, n, a, f=f, k=k: f(s, heavier if k == name else n, a)) for k, f in right.items()
    ]
    monkeypatch.setattr(quantities, 'ALL', records)
    wrong = robot_code.compile_robot(*packed)
    if name == 'coriolis_matrix':
        # One joint has none, whatever the mass.
        robot_code.RobotCode(*packed, wrong)
        return
    with pytest.raises(RuntimeError, match=f'{name}: the machine code computes something else'):
        robot_code.RobotCode(*packed, wrong)


@pytest.mark.parametrize(
    'name', [name for name in quantities.SIGNATURES if name != 'coriolis_matrix']
)
def test_one_wrong_function_for_any_inertia_is_enough(packed, name, monkeypatch):
    # Recorded with an axis that is too long.
    other = packed[1].copy()
    other[0, closed_form.AXIS : closed_form.INERTIA] *= 1.0 + 1e-6
    right = {record.__name__: record for record in quantities.ALL}
    records = [
        (lambda s, n, a, f=f, k=k: f(s, other if k == name else n, a)) for k, f in right.items()
    ]
    monkeypatch.setattr(quantities, 'ALL', records)
    wrong = robot_code.compile_robot(*packed, True)
    with pytest.raises(RuntimeError, match=f'{name}: the machine code computes something else'):
        robot_code.RobotCode(*packed, wrong, True)


@pytest.mark.parametrize(
    'column', [closed_form.INERTIA, closed_form.INERTIA + 5, closed_form.ROTOR]
)
def test_for_any_inertia_every_number_must_have_been_read(column, monkeypatch):
    model = RobotModel.from_urdf(random_urdf(12, joints=2))
    packed = pack(model.tree, model.gravity)
    right = quantities.input_places
    with monkeypatch.context() as patch:
        patch.setattr(
            quantities,
            'input_places',
            lambda *arguments: [place for place in right(*arguments) if place != (1, column)],
        )
        wrong = robot_code.compile_robot(*packed, True)
    with pytest.raises(RuntimeError, match='computes something else'):
        robot_code.RobotCode(*packed, wrong, True)


def test_for_any_inertia_it_is_one_for_all_inertias_and_beside_the_robots_own(packed, folder):
    heavier = packed[1].copy()
    heavier[0, closed_form.INERTIA : closed_form.MULTIPLIER] *= 3.0
    heavier[0, closed_form.ROTOR] = 1.0
    code = robot_code.make(*packed, True)
    assert robot_code.make(packed[0], heavier, True) is code
    assert robot_code.make(*packed) is not code
    assert {path.name for path in folder.iterdir()} == {
        store.key(*packed),
        store.key(*packed, True),
    }


def test_models_of_one_robot_share_it(packed):
    assert robot_code.make(*packed) is robot_code.make(*packed)
    assert robot_code.from_disk(*packed) is robot_code.make(*packed)


def test_a_robot_with_very_many_joints_gets_none():
    model = RobotModel.from_urdf(random_urdf(3, joints=60, with_mimic=False))
    packed = pack(model.tree, model.gravity)
    assert robot_code.make(*packed) is None


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
