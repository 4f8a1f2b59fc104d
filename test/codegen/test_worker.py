"""The worker process: one per robot, with its result on disk."""

from pathlib import Path
import sys

from dynamics_node import RobotModel
from dynamics_node.codegen import disk_cache, worker
from dynamics_node.kernels.packing import pack
import pytest
from support.machine_code import needs_machine_code
from support.robots import PENDULUM, random_urdf

ROOT = Path(__file__).parents[2]


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv('DYNAMICS_NODE_CACHE_DIR', str(tmp_path))
    monkeypatch.setattr(worker, '_processes', {})
    return tmp_path


def packed(text):
    model = RobotModel.from_urdf(text)
    return pack(model.tree, model.gravity)


def test_the_worker_leaves_the_code_on_disk(folder):
    robot = packed(PENDULUM)
    process = worker.start(robot)
    assert worker.start(robot) is process
    assert process.wait(60.0) == 0
    assert [path.name for path in folder.iterdir()] == [disk_cache.key(robot)]


def test_the_payload_variant_is_compiled_separately(folder):
    robot = packed(PENDULUM)
    process = worker.start(robot.with_payload_code())
    assert worker.start(robot.with_payload_code()) is process
    assert worker.start(robot) is not process
    for started in worker._processes.values():
        assert started.wait(60.0) == 0
    assert {path.name for path in folder.iterdir()} == {
        disk_cache.key(robot),
        disk_cache.key(robot.with_payload_code()),
    }


def test_the_worker_fails_for_a_robot_that_is_too_large(folder):
    process = worker.start(packed(random_urdf(3, joints=60, with_mimic=False)))
    assert process.wait(60.0) == 1
    assert list(folder.iterdir()) == []


def test_without_a_writable_folder_the_worker_fails(folder, monkeypatch):
    (folder / 'file').write_text('')
    monkeypatch.setenv('DYNAMICS_NODE_CACHE_DIR', str(folder / 'file' / 'cache'))
    assert worker.start(packed(PENDULUM)).wait(60.0) == 1


def test_the_number_of_compiler_processes_is_limited(monkeypatch):
    monkeypatch.setattr(worker, '_MAX_PROCESSES', 1)
    robot, other = packed(PENDULUM), packed(random_urdf(1, joints=2))
    process = worker.start(robot)
    assert worker.start(other) is None
    assert worker.start(robot) is process
    assert process.wait(60.0) == 0
    assert worker.start(other).wait(60.0) == 0


@needs_machine_code
def test_the_worker_runs_no_file_of_the_current_folder(tmp_path_factory, monkeypatch):
    current = tmp_path_factory.mktemp('current')
    (current / 'numpy.py').write_text('open("ran", "w")')
    monkeypatch.chdir(current)
    assert worker.start(packed(PENDULUM)).wait(60.0) == 0
    assert [path.name for path in current.iterdir()] == ['numpy.py']


def test_packages_of_an_interactive_python_are_found(monkeypatch):
    # There '' stands for the current folder.
    monkeypatch.chdir(ROOT)
    monkeypatch.setattr(
        sys,
        'path',
        ['', *(place for place in sys.path if place and Path(place).resolve() != ROOT)],
    )
    assert worker.start(packed(PENDULUM)).wait(60.0) == 0
