"""A robot's machine code: made once, found again, compared before it is used."""

from dataclasses import replace

from dynamics_node import RobotModel
from dynamics_node.codegen import compile, disk_cache, trace
from dynamics_node.kernels import recursive
from dynamics_node.kernels.packing import pack
import numpy as np
import pytest
from support.robots import PENDULUM, random_urdf


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv('DYNAMICS_NODE_CACHE_DIR', str(tmp_path))
    monkeypatch.setattr(compile, '_loaded', {})
    return tmp_path


@pytest.fixture
def packed():
    model = RobotModel.from_urdf(PENDULUM)
    return pack(model.tree, model.gravity)


def test_what_was_made_is_found_on_disk(packed, folder, monkeypatch):
    assert compile.from_disk(packed) is None
    assert compile.make(packed) is not None
    assert [path.name for path in folder.iterdir()] == [disk_cache.key(packed)]
    monkeypatch.setattr(compile, '_loaded', {})
    monkeypatch.delattr(compile, 'compile_robot')
    assert compile.make(packed) is not None


def test_code_of_another_robot_is_refused(packed):
    other = RobotModel.from_urdf(PENDULUM.read_text().replace('mass value="', 'mass value="3'))
    wrong = compile.compile_robot(pack(other.tree, other.gravity))
    disk_cache.save(disk_cache.key(packed), wrong)
    with pytest.raises(RuntimeError, match='something else'):
        compile.from_disk(packed)
    assert compile.make(packed) is not None


@pytest.mark.parametrize('name', trace.SIGNATURES)
def test_one_wrong_function_is_enough(packed, name, monkeypatch):
    # Each quantity is recorded with a mass of its own, in one function after the other.
    heavier = packed.numbers.copy()
    heavier[0, recursive.INERTIA : recursive.MULTIPLIER] *= 1.0 + 1e-6
    right = {record.__name__: record for record in trace.ALL}
    records = [
        (lambda p, f=f, k=k: f(replace(p, numbers=heavier) if k == name else p))
        for k, f in right.items()
    ]
    monkeypatch.setattr(trace, 'ALL', records)
    wrong = compile.compile_robot(packed)
    if name == 'coriolis_matrix':
        # One joint has none, whatever the mass.
        compile.RobotCode(packed, wrong)
        return
    with pytest.raises(RuntimeError, match=f'{name}: the machine code computes something else'):
        compile.RobotCode(packed, wrong)


@pytest.mark.parametrize('name', [name for name in trace.SIGNATURES if name != 'coriolis_matrix'])
def test_one_wrong_function_for_any_inertia_is_enough(packed, name, monkeypatch):
    # Recorded with an axis that is too long.
    other = packed.numbers.copy()
    other[0, recursive.AXIS : recursive.INERTIA] *= 1.0 + 1e-6
    right = {record.__name__: record for record in trace.ALL}
    records = [
        (lambda p, f=f, k=k: f(replace(p, numbers=other) if k == name else p))
        for k, f in right.items()
    ]
    monkeypatch.setattr(trace, 'ALL', records)
    wrong = compile.compile_robot(packed.with_payload_code())
    with pytest.raises(RuntimeError, match=f'{name}: the machine code computes something else'):
        compile.RobotCode(packed.with_payload_code(), wrong)


@pytest.mark.parametrize('column', [recursive.INERTIA, recursive.INERTIA + 5, recursive.ROTOR])
def test_for_any_inertia_every_number_must_have_been_read(column, monkeypatch):
    model = RobotModel.from_urdf(random_urdf(12, joints=2))
    packed = pack(model.tree, model.gravity)
    right = trace.input_places
    with monkeypatch.context() as patch:
        patch.setattr(
            trace,
            'input_places',
            lambda *arguments: [place for place in right(*arguments) if place != (1, column)],
        )
        wrong = compile.compile_robot(packed.with_payload_code())
    with pytest.raises(RuntimeError, match='computes something else'):
        compile.RobotCode(packed.with_payload_code(), wrong)


def test_for_any_inertia_it_is_one_for_all_inertias_and_beside_the_robots_own(packed, folder):
    heavier = packed.numbers.copy()
    heavier[0, recursive.INERTIA : recursive.MULTIPLIER] *= 3.0
    heavier[0, recursive.ROTOR] = 1.0
    code = compile.make(packed.with_payload_code())
    assert compile.make(replace(packed, numbers=heavier, payload_variant=True)) is code
    assert compile.make(packed) is not code
    assert {path.name for path in folder.iterdir()} == {
        disk_cache.key(packed),
        disk_cache.key(packed.with_payload_code()),
    }


def test_models_of_one_robot_share_it(packed):
    assert compile.make(packed) is compile.make(packed)
    assert compile.from_disk(packed) is compile.make(packed)


def test_a_robot_with_very_many_joints_gets_none():
    model = RobotModel.from_urdf(random_urdf(3, joints=60, with_mimic=False))
    packed = pack(model.tree, model.gravity)
    assert compile.make(packed) is None


def test_ordinary_numbers_are_finite_and_angles_not_too_large():
    plain = np.zeros((3, 2))
    assert compile.within_fast_range('dynamics', [plain, plain])
    assert compile.within_fast_range('dynamics', [plain, plain + 1e6])
    assert not compile.within_fast_range('dynamics', [plain + 1e6, plain])
    for bad in (np.nan, np.inf, -np.inf):
        spoilt = plain.copy()
        spoilt[2, 1] = bad
        assert not compile.within_fast_range('dynamics', [spoilt, plain])
        assert not compile.within_fast_range('dynamics', [plain, spoilt])
