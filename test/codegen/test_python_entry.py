"""The Python entry point: the common case in machine code, all others by the fallback."""

from concurrent.futures import ThreadPoolExecutor
import gc
import inspect
import resource
import sys
import weakref

from dynamics_node import ArgumentError, DynamicsTerms, RobotModel, SingularMassMatrixError
from dynamics_node.codegen import python_entry
import numpy as np
import pytest
from support.machine_code import needs_machine_code
from support.robots import random_urdf

pytestmark = needs_machine_code

QUANTITIES = {
    'dynamics': 2,
    'coriolis_matrix': 2,
    'mass_matrix': 1,
    'gravity_torque': 1,
    'inverse_dynamics': 3,
    'forward_dynamics': 3,
}


@pytest.fixture(scope='module')
def model():
    model = RobotModel.from_urdf(random_urdf(11, joints=4, with_mimic=False, prismatic=0.0))
    assert model.specialize()
    return model


@pytest.fixture
def arguments(model):
    return list(np.random.default_rng(1).uniform(-1.0, 1.0, (3, len(model.joint_names))))


def assert_same(actual, expected):
    for mine, theirs in zip(np.atleast_1d(*actual), np.atleast_1d(*expected), strict=True):
        np.testing.assert_allclose(mine, theirs, rtol=0, atol=1e-12 * np.abs(theirs).max())


@pytest.mark.parametrize('name', QUANTITIES)
def test_the_common_case_is_computed_by_machine_code(model, arguments, name):
    function, plain = getattr(model, name), arguments[: QUANTITIES[name]]
    assert inspect.isbuiltin(function)
    actual, expected = function(*plain), getattr(model._evaluation, name)(*plain)
    assert type(actual) is type(expected)
    for mine, theirs in zip(
        *(answer if isinstance(answer, tuple) else (answer,) for answer in (actual, expected)),
        strict=True,
    ):
        assert mine.dtype == theirs.dtype
        assert mine.shape == theirs.shape
        assert mine.flags.carray
        scale = max(1.0, np.abs(theirs).max())
        np.testing.assert_allclose(mine, theirs, rtol=0, atol=1e-12 * scale)


WAYS_TO_HOLD = {
    'answer': lambda D: D,
    'view': lambda D: D[1:],
    'transposed': lambda D: D.T,
    'memoryview': memoryview,
    'weak reference': weakref.ref,
    'buffer': lambda D: np.frombuffer(D.data.cast('B'), dtype=float),
}


@pytest.mark.parametrize('way', WAYS_TO_HOLD)
@pytest.mark.parametrize('kind', ['mass_matrix', 'dynamics'])
def test_a_referenced_answer_is_never_overwritten(model, way, kind):
    # More answers than are kept for reuse, each referenced in some way.
    rng, held = np.random.default_rng(3), []
    for _ in range(12):
        q, qd = rng.uniform(-1.0, 1.0, (2, 4))
        answer = model.mass_matrix(q) if kind == 'mass_matrix' else model.dynamics(q, qd)[0]
        held.append((WAYS_TO_HOLD[way](answer), answer.copy()))
        del answer
    for holder, expected in held:
        now = holder() if way == 'weak reference' else np.asarray(holder)
        if now is None:
            continue
        if way == 'view':
            expected = expected[1:]
        elif way == 'transposed':
            expected = expected.T
        np.testing.assert_array_equal(now.reshape(expected.shape), expected)


def test_an_unreferenced_answer_is_reused(model, arguments):
    places = {id(model.mass_matrix(arguments[0])) for _ in range(100)}
    assert len(places) == 1
    D = model.mass_matrix(arguments[0])
    assert id(model.mass_matrix(arguments[1])) != id(D)


def _resized(D):
    D.resize((4, 2), refcheck=False)


CHANGES = {
    'read-only': lambda D: D.setflags(write=False),
    'reshaped': lambda D: setattr(D, 'shape', 16),
    'another type': lambda D: setattr(D, 'dtype', np.int64),
    'smaller': _resized,
}


@pytest.mark.filterwarnings('ignore:Setting the:DeprecationWarning')
@pytest.mark.parametrize('change', CHANGES)
def test_a_modified_answer_is_not_reused(change):
    model = RobotModel.from_urdf(random_urdf(11, joints=4, with_mimic=False, prismatic=0.0))
    assert model.specialize()
    q = np.array([0.1, 0.2, 0.3, 0.4])
    expected = model._evaluation.mass_matrix(q)
    for _ in range(8):
        D = model.mass_matrix(q)
        assert D.shape == (4, 4)
        assert D.dtype == float
        assert D.flags.carray
        np.testing.assert_allclose(D, expected, rtol=0, atol=1e-12)
        CHANGES[change](D)
        del D


def test_threads_get_separate_answers(model):
    states = np.random.default_rng(5).uniform(-1.0, 1.0, (8, 4))
    expected = [model._evaluation.mass_matrix(q) for q in states]

    def work(index):
        return max(
            np.abs(model.mass_matrix(states[index]) - expected[index]).max() for _ in range(3000)
        )

    with ThreadPoolExecutor(8) as pool:
        assert max(pool.map(work, range(8))) < 1e-12


OTHER_SHAPES = {
    'list': lambda q: q.tolist(),
    'tuple': lambda q: tuple(q),
    'integers': lambda q: q.astype(int),
    'float32': lambda q: q.astype(np.float32),
    'strided': lambda q: np.repeat(q, 2)[::2],
    'reversed': lambda q: q[::-1].copy()[::-1],
    'big endian': lambda q: q.astype('>f8'),
    'unaligned': lambda q: np.frombuffer(b'x' + q.tobytes(), dtype=float, offset=1),
    'subclass': lambda q: q.view(np.recarray),
    'read-only': lambda q: np.broadcast_to(q, q.shape),
    'objects': lambda q: q.astype(object),
    'batch of one': lambda q: q[None],
    'batch': lambda q: np.tile(q, (3, 1)),
}


@pytest.mark.parametrize('kind', OTHER_SHAPES)
def test_array_likes_go_to_the_fallback(model, arguments, kind):
    q = OTHER_SHAPES[kind](arguments[0])
    expected = model._evaluation.gravity_torque(q)
    np.testing.assert_allclose(
        model.gravity_torque(q), expected, rtol=0, atol=1e-12 * np.abs(expected).max()
    )


def test_keywords_are_taken(model, arguments):
    q, qd, _ = arguments
    for mine, theirs in zip(model.dynamics(qd=qd, q=q), model.dynamics(q, qd), strict=True):
        np.testing.assert_allclose(mine, theirs, atol=1e-12)
    out = model.dynamics(q, qd)
    assert model.dynamics(q, qd, out=out, threads=1).mass_matrix is out.mass_matrix


@pytest.mark.parametrize(
    'wrong',
    [
        (np.zeros(5), np.zeros(4)),
        (np.zeros(4), np.zeros(3)),
        (np.zeros(()), np.zeros(4)),
        (np.zeros(0), np.zeros(4)),
        ('abcd', np.zeros(4)),
        (None, None),
    ],
)
def test_machine_code_refuses_wrong_arguments(model, wrong):
    with pytest.raises((ArgumentError, TypeError, ValueError)):
        model.dynamics(*wrong)


@pytest.mark.parametrize('count', [0, 1, 3, 7])
def test_a_wrong_number_of_arguments_is_a_type_error(model, count):
    with pytest.raises(TypeError):
        model.dynamics(*[np.zeros(4)] * count)


@pytest.mark.parametrize('bad', [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize('place', range(4))
def test_nan_and_infinity_in_give_nan_out(model, arguments, bad, place):
    q, qd, qdd = arguments
    for argument in (q, qd, qdd):
        kept, argument[place] = argument[place], bad
        assert not np.isfinite(model.inverse_dynamics(q, qd, qdd)).all()
        argument[place] = kept
    assert np.isfinite(model.inverse_dynamics(q, qd, qdd)).all()


def test_large_angles_are_left_to_the_general_kernel(model, arguments):
    q = arguments[0] + 1e7
    np.testing.assert_array_equal(model.gravity_torque(q), model._evaluation.gravity_torque(q))


def test_machine_code_refuses_a_singular_mass_matrix():
    # A massless tip behind the arm's last joint: D is singular, wherever the arm is.
    text = random_urdf(12, joints=2, with_mimic=False).replace(
        '</robot>',
        """
        <link name="tip"/><joint name="last" type="continuous"><parent link="link1"/>
        <child link="tip"/><axis xyz="0 0 1"/></joint></robot>""",
    )
    model = RobotModel.from_urdf(text)
    states = np.random.default_rng(1).uniform(-1.0, 1.0, (3, 3))
    assert model.specialize()
    with pytest.raises(SingularMassMatrixError):
        model.forward_dynamics(*states)
    np.testing.assert_array_equal(model.gravity_torque(states[0])[-1], 0.0)


def test_documentation_and_signature_stay(model):
    assert model.dynamics.__name__ == 'dynamics'
    assert model.dynamics.__doc__ == inspect.cleandoc(RobotModel.dynamics.__doc__)
    assert list(inspect.signature(model.dynamics).parameters) == ['q', 'qd', 'out', 'threads']


def test_addresses_cannot_be_written(model):
    with pytest.raises(ValueError, match='read-only'):
        model.dynamics.__self__[:] = 0


def test_ctypes_pythonapi_is_not_modified():
    import ctypes

    for name in python_entry._SYMBOLS:
        assert getattr(ctypes.pythonapi, name).argtypes is None


def test_each_model_has_its_gravity(model, arguments):
    other = model.with_gravity((1.0, -2.0, 3.0))
    assert inspect.isbuiltin(other.gravity_torque)
    expected = other._evaluation.gravity_torque(arguments[0])
    np.testing.assert_allclose(
        other.gravity_torque(arguments[0]), expected, rtol=0, atol=1e-12 * np.abs(expected).max()
    )
    assert not np.allclose(expected, model.gravity_torque(arguments[0]))


def test_a_function_outlives_its_model_and_the_model_is_freed(model, arguments):
    short_lived = model.with_gravity((0.0, 0.0, -1.0))
    expected = short_lived.gravity_torque(arguments[0])
    function, gone = short_lived.gravity_torque, weakref.ref(short_lived)
    del short_lived
    assert gone() is None
    np.testing.assert_array_equal(function(arguments[0]), expected)
    np.testing.assert_allclose(function(arguments[0].tolist()), expected, atol=1e-12)


def test_a_function_keeps_the_payload_that_it_was_made_with(model, arguments):
    carrying = [model.with_payload('link3', mass) for mass in (1.0, 2.0)]
    assert carrying[0].specialize()
    functions = [loaded.gravity_torque for loaded in carrying]
    assert all(inspect.isbuiltin(function) for function in functions)
    expected = [loaded._evaluation.gravity_torque(arguments[0]) for loaded in carrying]
    del carrying
    gc.collect()
    # Memory that was freed would be taken by these.
    garbage = [np.full(model._evaluation.packed.numbers.shape, np.nan) for _ in range(100)]
    for function, wanted in zip(functions, expected, strict=True):
        np.testing.assert_allclose(
            function(arguments[0]), wanted, rtol=0, atol=1e-12 * np.abs(wanted).max()
        )
    assert len(garbage) == 100


def test_nothing_is_leaked(model, arguments):
    q, qd, qdd = arguments
    nan, functions = q * np.nan, [getattr(model, name) for name in QUANTITIES]

    def use(times):
        for _ in range(times):
            for function, count in zip(functions, QUANTITIES.values(), strict=True):
                function(*(q, qd, qdd)[:count])
            model.dynamics(q, nan)

    use(100)
    gc.collect()
    counts = [sys.getrefcount(item) for item in (q, DynamicsTerms, np.ndarray)]
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    use(20_000)
    gc.collect()
    assert [sys.getrefcount(item) for item in (q, DynamicsTerms, np.ndarray)] == counts
    # One lost array of 4 numbers per call would be 20 MB.
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 4_000
