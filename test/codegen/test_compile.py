"""A robot's machine code: compiled once, kept on disk, compared before use."""

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


def test_compiled_code_is_found_on_disk(packed, folder, monkeypatch):
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


@pytest.mark.parametrize('payload_variant', [False, True])
@pytest.mark.parametrize('name', trace.SIGNATURES)
def test_one_wrong_function_is_enough(packed, name, payload_variant, monkeypatch):
    # One quantity is recorded with another mass or, if inertia is an input, another axis.
    if payload_variant:
        packed = packed.with_payload_code()
    columns = slice(
        recursive.AXIS if payload_variant else recursive.INERTIA,
        recursive.INERTIA if payload_variant else recursive.MULTIPLIER,
    )
    numbers = packed.numbers.copy()
    numbers[0, columns] *= 1.0 + 1e-6
    records = [
        lambda p, f=f: f(replace(p, numbers=numbers) if f.__name__ == name else p)
        for f in trace.ALL
    ]
    monkeypatch.setattr(trace, 'ALL', records)
    wrong = compile.compile_robot(packed)
    if name == 'coriolis_matrix':
        # Zero with a single joint, for any mass and axis.
        compile.RobotCode(packed, wrong)
        return
    with pytest.raises(RuntimeError, match=f'{name}: the machine code computes something else'):
        compile.RobotCode(packed, wrong)


@pytest.mark.parametrize('column', [recursive.INERTIA, recursive.INERTIA + 5, recursive.ROTOR])
def test_a_payload_variant_that_ignores_an_input_is_refused(column, monkeypatch):
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


def test_all_inertias_share_one_payload_variant(packed, folder):
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


def test_models_of_one_robot_share_code(packed):
    assert compile.make(packed) is compile.make(packed)
    assert compile.from_disk(packed) is compile.make(packed)


def test_a_robot_with_60_joints_gets_no_machine_code():
    model = RobotModel.from_urdf(random_urdf(3, joints=60, with_mimic=False))
    packed = pack(model.tree, model.gravity)
    assert compile.make(packed) is None


def test_the_fast_range_has_finite_numbers_and_limited_angles():
    plain = np.zeros((3, 2))
    assert compile.within_fast_range('dynamics', [plain, plain])
    assert compile.within_fast_range('dynamics', [plain, plain + 1e6])
    assert not compile.within_fast_range('dynamics', [plain + 1e6, plain])
    for bad in (np.nan, np.inf, -np.inf):
        spoilt = plain.copy()
        spoilt[2, 1] = bad
        assert not compile.within_fast_range('dynamics', [spoilt, plain])
        assert not compile.within_fast_range('dynamics', [plain, spoilt])
