"""Machine code: when it is compiled, shared, installed, and done without."""

from concurrent.futures import ThreadPoolExecutor
import copy
import gc
import inspect
import os
import pickle
import resource
import shutil
import subprocess
import sys
import threading
import time
import weakref

from dynamics_node import RobotModel, SingularMassMatrixError
from dynamics_node.codegen import compile, worker
from dynamics_node.codegen.manager import Specialization
from dynamics_node.dynamics.batch import Evaluation
import numpy as np
import pytest
from support.comparison import assert_terms_agree
from support.machine_code import needs_machine_code
from support.random_payload import random_body
from support.robots import PENDULUM, random_urdf

pytestmark = needs_machine_code

# Of the machine code to the general kernel, as both are to the judges.
RELATIVE = 1e-11

# With a joint that turns, one that slides, and links on fixed joints.
SMALL = random_urdf(12, joints=2)


@pytest.fixture(scope='module')
def compiled(tmp_path_factory):
    """Folder with the machine code of SMALL and its payload variant."""
    place = tmp_path_factory.mktemp('compiled')
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv('DYNAMICS_NODE_CACHE_DIR', str(place))
        assert RobotModel.from_urdf(SMALL).specialize(with_payload_code=True)
    return place


@pytest.fixture
def small(compiled, folder):
    """SMALL with all its machine code, from disk."""
    shutil.copytree(compiled, folder, dirs_exist_ok=True)
    model = RobotModel.from_urdf(SMALL)
    assert model.is_specialized
    return model


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv('DYNAMICS_NODE_CACHE_DIR', str(tmp_path))
    monkeypatch.setattr(compile, '_loaded', {})
    monkeypatch.setattr(worker, '_processes', {})
    return tmp_path


def test_frequent_use_starts_the_compiler():
    model = RobotModel.from_urdf(PENDULUM)
    q = np.array([0.3])
    expected = model.gravity_torque(q)
    end = time.monotonic() + 60
    while not model.is_specialized and time.monotonic() < end:
        np.testing.assert_allclose(model.gravity_torque(q), expected, rtol=1e-14)
    assert model.is_specialized
    np.testing.assert_allclose(model.gravity_torque(q), expected, rtol=1e-14)


def test_a_single_call_starts_no_compiler():
    model = RobotModel.from_urdf(PENDULUM)
    model.gravity_torque([0.3])
    assert model._evaluation.specialization._process is None


def test_the_next_model_of_the_robot_is_specialized_immediately():
    assert not RobotModel.from_urdf(PENDULUM).is_specialized
    assert RobotModel.from_urdf(PENDULUM).specialize()
    model = RobotModel.from_urdf(PENDULUM)
    assert model.is_specialized
    assert inspect.isbuiltin(model.dynamics)


def test_models_under_another_gravity_get_the_code_too():
    model = RobotModel.from_urdf(PENDULUM)
    before = model.with_gravity((0.0, 0.0, 0.0))
    assert model.specialize()
    after = model.with_gravity((0.0, 0.0, -1.0))
    for other in (before, after):
        assert other.is_specialized
        assert inspect.isbuiltin(other.gravity_torque)
    np.testing.assert_array_equal(before.gravity_torque(np.array([0.3])), [0.0])


def test_specialize_without_waiting_returns_immediately():
    model = RobotModel.from_urdf(PENDULUM)
    began = time.process_time()
    model.specialize(wait=False)
    # Neither waiting nor compiling in this process: either takes a second.
    assert not model.is_specialized
    assert time.process_time() - began < 0.1
    assert model.specialize(wait=True)


def test_a_full_compiler_queue_is_retried(monkeypatch):
    monkeypatch.setattr(worker, '_MAX_PROCESSES', 0)
    model = RobotModel.from_urdf(PENDULUM)
    model.specialize(wait=False)
    assert model._evaluation.specialization._process is None
    monkeypatch.setattr(worker, '_MAX_PROCESSES', 1)
    end = time.monotonic() + 60
    while not model.is_specialized and time.monotonic() < end:
        model.gravity_torque([0.3])
    assert model.is_specialized


def test_an_environment_variable_turns_machine_code_off(monkeypatch):
    monkeypatch.setenv('DYNAMICS_NODE_SPECIALIZE', '0')
    model = RobotModel.from_urdf(PENDULUM)
    assert not model.specialize()
    assert not inspect.isbuiltin(model.dynamics)
    assert np.isfinite(model.gravity_torque([0.3])).all()


def test_a_robot_with_60_joints_uses_the_general_kernel():
    model = RobotModel.from_urdf(random_urdf(3, joints=60, with_mimic=False))
    assert not model.specialize()
    assert model.gravity_torque(np.zeros(60)).shape == (60,)


@pytest.mark.parametrize(
    'duplicate', [copy.copy, copy.deepcopy, lambda item: pickle.loads(pickle.dumps(item))]
)
def test_a_model_and_its_methods_can_be_copied_and_pickled(duplicate):
    model = RobotModel.from_urdf(PENDULUM)
    model.note = 'mine'
    q = np.array([0.3])
    for _ in range(2):
        other = duplicate(model)
        assert other.note == 'mine'
        assert other.is_specialized == model.is_specialized
        np.testing.assert_array_equal(other.gravity_torque(q), model.gravity_torque(q))
        method = duplicate(model.gravity_torque)
        np.testing.assert_allclose(method(q), model.gravity_torque(q), rtol=1e-14)
        assert model.specialize()


def test_a_function_assigned_to_the_instance_stays():
    model = RobotModel.from_urdf(PENDULUM)
    model.gravity_torque = lambda q: np.zeros(1)
    assert model.specialize()
    np.testing.assert_array_equal(model.gravity_torque(np.array([0.3])), [0.0])


@pytest.mark.parametrize(
    'module, step', [(compile, 'from_disk'), (compile, 'make'), (worker, 'start')]
)
def test_after_a_failure_the_general_kernel_stays_in_use(module, step, monkeypatch, caplog):
    def fail(*arguments):
        raise OSError('as it happens')

    monkeypatch.setattr(module, step, fail)
    model = RobotModel.from_urdf(PENDULUM)
    assert not model.specialize(wait=step != 'start')
    assert np.isfinite(model.gravity_torque([0.3])).all()
    assert 'the general kernel goes on: OSError: as it happens' in caplog.text


def test_a_failing_installation_does_not_reach_the_caller(caplog):
    def refuse(owner, code):
        raise AttributeError('no')

    model = RobotModel.from_urdf(PENDULUM)
    assert model.specialize()
    Specialization(model._evaluation.packed).attach(model, refuse)
    assert 'the general kernel goes on: AttributeError' in caplog.text


def test_finalizers_can_call_machine_code_at_exit():
    # Finalizers run in any order: the machine code must outlive them all.
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
    assert model.specialize()
    Arm(model)
    del model
    gc.collect()
last = Arm(RobotModel.from_urdf({str(PENDULUM)!r}))
"""
    environment = dict(os.environ, PYTHONPATH=os.pathsep.join(sys.path))
    run = subprocess.run(
        [sys.executable, '-c', script],
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert (run.returncode, run.stderr) == (0, '')


def test_a_method_of_a_subclass_stays():
    class Doubled(RobotModel):
        def gravity_torque(self, q):
            return 2.0 * super().gravity_torque(q)

    model, plain = Doubled.from_urdf(PENDULUM), RobotModel.from_urdf(PENDULUM)
    assert model.specialize()
    assert inspect.isbuiltin(model.dynamics)
    np.testing.assert_allclose(model.gravity_torque([0.3]), 2.0 * plain.gravity_torque([0.3]))


def test_python_can_end_while_the_worker_compiles(folder):
    script = (
        f'from dynamics_node import RobotModel\n'
        f'RobotModel.from_urdf({str(PENDULUM)!r}).specialize(wait=False)\n'
    )
    environment = dict(os.environ, PYTHONPATH=os.pathsep.join(sys.path))
    run = subprocess.run(
        [sys.executable, '-W', 'always', '-c', script],
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert (run.returncode, run.stderr) == (0, '')
    # The worker finishes its compilation.
    end = time.monotonic() + 60
    while not list(folder.iterdir()) and time.monotonic() < end:
        time.sleep(0.05)
    assert list(folder.iterdir())


def compiler_count():
    """Return how many processes have been started to compile."""
    return len(worker._processes)


def used_until_specialized(model):
    q = np.zeros(len(model.joint_names))
    end = time.monotonic() + 60
    while not model.is_specialized and time.monotonic() < end:
        model.gravity_torque(q)
    assert model.is_specialized


def with_random_payload(model, rng):
    links = [link for link, frame in model.tree.links.items() if frame.body >= 0]
    return model.with_payload(links[int(rng.integers(len(links)))], *random_body(rng))


def assert_as_the_general_kernel(model, rng):
    """Compare one state and a batch, all quantities; the general kernel knows no machine code."""
    assert inspect.isbuiltin(model.dynamics)
    general = Evaluation(
        model._evaluation.packed,
        model.joint_names,
        Specialization(model._evaluation.packed, compile=False),
    )
    states = rng.uniform(-2.0, 2.0, (3, 9, len(model.joint_names)))
    batch = (
        *model.dynamics(*states[:2]),
        model.mass_matrix(states[0]),
        model.gravity_torque(states[0]),
        model.inverse_dynamics(*states),
    )
    for i, (q, qd, qdd) in enumerate(zip(*states, strict=True)):
        terms, effort = general.dynamics(q, qd), general.inverse_dynamics(q, qd, qdd)
        scale = max(
            np.abs(terms.mass_matrix @ qdd).max(),
            np.abs(terms.gravity_torque).max(),
            np.abs(effort).max(),
            np.abs(terms.mass_matrix).max(),
        )
        one = (
            *model.dynamics(q, qd),
            model.mass_matrix(q),
            model.gravity_torque(q),
            model.inverse_dynamics(q, qd, qdd),
        )
        for D, C, G, D_alone, G_alone, tau in (one, [answer[i] for answer in batch]):
            assert_terms_agree(model, qd, (D, C, G), terms, RELATIVE)
            assert_terms_agree(
                model, qd, (D_alone, model.coriolis_matrix(q, qd), G_alone), terms, RELATIVE
            )
            np.testing.assert_allclose(tau, effort, rtol=0, atol=1e-12 * scale)


def test_a_second_payload_starts_no_compiler():
    model = RobotModel.from_urdf(SMALL)
    rng = np.random.default_rng(5)
    assert model.specialize()
    assert compiler_count() == 0
    used_until_specialized(with_random_payload(model, rng))
    assert compiler_count() == 1
    for _ in range(20):
        other = with_random_payload(model, rng).with_rotor_inertia(rng.uniform(0.0, 1.0))
        assert other.is_specialized
        assert_as_the_general_kernel(other, rng)
        used_until_specialized(other)
    assert compiler_count() == 1
    # A robot that differs only in its inertia starts none either.
    heavier = RobotModel.from_urdf(SMALL.replace('mass value="', 'mass value="1'))
    assert not heavier.is_specialized
    assert with_random_payload(heavier, rng).is_specialized
    assert compiler_count() == 1


def test_earlier_models_with_payload_get_the_code_too():
    model = RobotModel.from_urdf(PENDULUM)
    light, heavy = model.with_payload('rod', 1.0), model.with_payload('rod', 50.0)
    geared = model.with_rotor_inertia(0.3)
    assert light.specialize()
    assert heavy.is_specialized
    assert geared.is_specialized
    assert not model.is_specialized
    assert (
        len(
            {
                float(robot.mass_matrix(np.zeros(1))[0, 0])
                for robot in (model, light, heavy, geared)
            }
        )
        == 4
    )


def test_the_payload_variant_can_be_compiled_in_advance():
    model = RobotModel.from_urdf(PENDULUM)
    q = np.zeros(1)
    model.specialize(wait=False, with_payload_code=True)
    assert compiler_count() == 1
    used_until_specialized(model)
    # One after the other.
    end = time.monotonic() + 10
    while compiler_count() < 2 and time.monotonic() < end:
        time.sleep(0.001)
    assert compiler_count() == 2
    for process in worker._processes.values():
        assert process.wait(60.0) == 0
    # The first model that carries something finds it, and so do all that come later.
    loaded = model.with_payload('rod', 1.0)
    end = time.monotonic() + 10
    while not loaded.is_specialized and time.monotonic() < end:
        time.sleep(0.001)
    assert loaded.is_specialized
    assert model.with_payload('rod', 2.0).is_specialized
    assert compiler_count() == 2
    again = RobotModel.from_urdf(PENDULUM)
    assert again.specialize(with_payload_code=True)
    np.testing.assert_array_equal(
        again.with_payload('rod', 1.0).mass_matrix(q), loaded.mass_matrix(q)
    )


def test_a_new_model_does_not_wait_while_machine_code_is_loaded(small, monkeypatch):
    begun_to_load, may_end = threading.Event(), threading.Event()
    right = compile.from_disk

    def slow(packed):
        begun_to_load.set()
        assert may_end.wait(60.0)
        return right(packed)

    specialization = small._specialization.payload_variant
    specialization.code = None
    monkeypatch.setattr(compile, 'from_disk', slow)
    thread = threading.Thread(target=specialization._take)
    thread.start()
    try:
        assert begun_to_load.wait(60.0)
        loaded = small.with_payload('link0', 1.0)
        assert not loaded.is_specialized
    finally:
        may_end.set()
        thread.join()
    assert inspect.isbuiltin(loaded.dynamics)


def test_both_codes_can_be_compiled_in_this_process():
    model = RobotModel.from_urdf(PENDULUM)
    assert model.with_payload('rod', 1.0).specialize(with_payload_code=True)
    assert not model.is_specialized
    assert model.specialize(with_payload_code=True)
    assert model.with_rotor_inertia(1.0).is_specialized
    assert compiler_count() == 0


@pytest.mark.parametrize('seed', range(4))
def test_a_payload_and_rotors_on_a_random_tree(seed):
    rng = np.random.default_rng(seed)
    model = RobotModel.from_urdf(random_urdf(seed, joints=1 + seed))
    loaded = (
        with_random_payload(model, rng)
        .with_rotor_inertia(rng.uniform(0.0, 1.0, len(model.joint_names)))
        .with_gravity(rng.normal(0.0, 6.0, 3))
    )
    assert loaded.specialize()
    for robot in (loaded, with_random_payload(loaded, rng), loaded.with_rotor_inertia(0.0)):
        assert_as_the_general_kernel(robot, rng)


def test_removing_a_payload_restores_every_bit(small):
    model, rng = small, np.random.default_rng(8)
    states = rng.uniform(-2.0, 2.0, (2, 9, len(model.joint_names)))
    before, batch = model.dynamics(*states[:, 0]), model.dynamics(*states)
    loaded = model.with_payload('link0', *random_body(rng)).with_rotor_inertia(1.0)
    assert loaded.is_specialized
    assert not np.array_equal(loaded.dynamics(*states).mass_matrix, batch.mass_matrix)
    removed = loaded.with_payload('link0', 0.0).with_rotor_inertia(0.0)
    assert removed._evaluation.specialization is model._evaluation.specialization
    for old, new in zip(
        (*before, *batch),
        (*removed.dynamics(*states[:, 0]), *removed.dynamics(*states)),
        strict=True,
    ):
        assert old.tobytes() == new.tobytes()


def test_a_massless_link_can_carry_a_payload():
    # The tip is massless, so D is singular in every state, until it carries a payload.
    text = random_urdf(12, joints=2, with_mimic=False).replace(
        '</robot>',
        """
        <link name="tip"/><joint name="last" type="continuous"><parent link="link1"/>
        <child link="tip"/><axis xyz="0 0 1"/></joint></robot>""",
    )
    model = RobotModel.from_urdf(text)
    assert model.specialize()
    rng = np.random.default_rng(12)
    q, qd, tau = rng.uniform(-1.0, 1.0, (3, 3))
    loaded = model.with_payload('tip', *random_body(rng))
    assert loaded.specialize()
    assert_as_the_general_kernel(loaded, rng)
    qdd = loaded.forward_dynamics(q, qd, tau)
    np.testing.assert_allclose(loaded.inverse_dynamics(q, qd, qdd), tau, rtol=0, atol=1e-10)
    # The same machine code finds D singular when only another link is loaded.
    elsewhere = loaded.with_payload('link0', *random_body(rng))
    assert elsewhere.is_specialized
    for singular in (model, elsewhere):
        with pytest.raises(SingularMassMatrixError):
            singular.forward_dynamics(q, qd, tau)


def test_a_very_heavy_first_payload_does_not_affect_later_ones(monkeypatch):
    # Loaded code is compared at loads that fit the robot, not at the first payload.
    model = RobotModel.from_urdf(random_urdf(4, joints=3, with_mimic=False))
    assert model.with_payload(model.link_names[-1], 1.0).specialize()
    monkeypatch.setattr(compile, '_loaded', {})
    again = RobotModel.from_urdf(random_urdf(4, joints=3, with_mimic=False))
    assert again.with_payload(model.link_names[-1], 1e15).is_specialized
    assert_as_the_general_kernel(
        again.with_payload(model.link_names[-1], 2.0), np.random.default_rng(4)
    )


def test_a_thousand_payloads_leak_nothing(small):
    model, rng = small, np.random.default_rng(9)
    bodies = [random_body(rng) for _ in range(10)]
    q = rng.uniform(-1.0, 1.0, len(model.joint_names))
    assert model.with_payload('link0', *bodies[0]).is_specialized
    processes, codes = compiler_count(), len(compile._loaded)

    def load(times):
        for i in range(times):
            loaded = model.with_payload('link0', *bodies[i % 10])
            loaded.gravity_torque(q)
        return weakref.ref(loaded)

    load(100)
    gc.collect()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    gc.disable()
    try:
        last = load(1000)
        # No reference cycle either: it is freed without a garbage collection.
        assert last() is None
    finally:
        gc.enable()
    assert len(model._specialization.payload_variant._owners) == 0
    assert (compiler_count(), len(compile._loaded)) == (processes, codes)
    # A model and its entries take some 10 kB: a thousand would be 10 MB.
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 4_000


def test_threads_load_and_free_models_side_by_side(small):
    model, rng = small, np.random.default_rng(9)
    states = rng.uniform(-1.0, 1.0, (8, len(model.joint_names)))
    bodies = [random_body(rng) for _ in range(8)]

    def expected(i):
        other = model.with_payload('link1', *bodies[i])
        return other._evaluation.mass_matrix(states[i])

    wanted = [expected(i) for i in range(8)]

    def work(i):
        worst = 0.0
        for _ in range(200):
            D = model.with_payload('link1', *bodies[i]).mass_matrix(states[i])
            worst = max(worst, np.abs(D - wanted[i]).max())
        return worst

    with ThreadPoolExecutor(8) as pool:
        assert max(pool.map(work, range(8))) < 1e-12


@pytest.mark.parametrize('ready', [False, True])
def test_a_loaded_model_can_be_pickled(ready, request):
    model = request.getfixturevalue('small') if ready else RobotModel.from_urdf(SMALL)
    rng = np.random.default_rng(6)
    loaded = with_random_payload(model, rng).with_rotor_inertia(0.2)
    other = pickle.loads(pickle.dumps(loaded))
    assert other.is_specialized == ready
    q = np.full(len(model.joint_names), 0.3)
    np.testing.assert_array_equal(other.mass_matrix(q), loaded.mass_matrix(q))
    assert other._specialization.payload_variant is other._evaluation.specialization
    assert with_random_payload(other, rng).specialize()
    assert other.is_specialized
    assert_as_the_general_kernel(other, rng)


@pytest.mark.skipif(not hasattr(os, 'fork'), reason='needs fork')
@pytest.mark.filterwarnings('ignore:This process.*is multi-threaded:DeprecationWarning')
def test_a_forked_process_has_the_same_payloads(small):
    model, rng = small, np.random.default_rng(6)
    child = os.fork()
    if child == 0:
        code = 1
        try:
            assert_as_the_general_kernel(with_random_payload(model, rng), rng)
            code = 0
        finally:
            os._exit(code)
    assert os.waitpid(child, 0)[1] == 0
