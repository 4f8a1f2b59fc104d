"""Batches: pieces, threads, and results in given arrays."""

from dynamics_node import ArgumentError, RobotModel, SingularMassMatrixError
from dynamics_node.codegen import is_supported
from dynamics_node.dynamics import batch
import numpy as np
import pytest
from support.machine_code import needs_machine_code
from support.robots import random_urdf


@pytest.fixture(
    scope='module', params=['general', pytest.param('specialized', marks=needs_machine_code)]
)
def model(request):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv('DYNAMICS_NODE_SPECIALIZE', '01'[request.param == 'specialized'])
        model = RobotModel.from_urdf(random_urdf(21, joints=3, with_mimic=False))
        assert model.specialize() == (request.param == 'specialized')
        yield model


@pytest.fixture(autouse=True)
def small_pieces(monkeypatch):
    # So that few states make many of them.
    monkeypatch.setattr(batch, '_PIECE', 16)


def states(model, count, arrays=3):
    return np.random.default_rng(count).uniform(-2, 2, (arrays, count, len(model.joint_names)))


@pytest.mark.parametrize('count', [0, 1, 7, 16, 17, 33, 200])
@pytest.mark.parametrize('threads', [None, 1, 3])
def test_a_batch_is_its_states_one_by_one(model, count, threads):
    q, qd, qdd = states(model, count)
    terms = model.dynamics(q, qd, threads=threads)
    tau = model.inverse_dynamics(q, qd, qdd, threads=threads)
    back = model.forward_dynamics(q, qd, tau, threads=threads)
    D, G = model.mass_matrix(q, threads=threads), model.gravity_torque(q, threads=threads)
    C = model.coriolis_matrix(q, qd, threads=threads)
    for b in range(count):
        single = model.dynamics(q[b], qd[b])
        for mine, alone, theirs in zip(terms, (D[b], C[b], G[b]), single, strict=True):
            scale = np.abs(theirs).max() + 1e-3
            np.testing.assert_allclose(mine[b], theirs, rtol=0, atol=1e-13 * scale)
            np.testing.assert_allclose(alone, theirs, rtol=0, atol=1e-13 * scale)
        expected = model.inverse_dynamics(q[b], qd[b], qdd[b])
        np.testing.assert_allclose(tau[b], expected, rtol=0, atol=1e-12 * np.abs(expected).max())
        np.testing.assert_allclose(back[b], qdd[b], rtol=0, atol=1e-9)


def test_one_bad_state_spoils_no_other(model):
    q, _, _ = states(model, 100)
    expected = model.gravity_torque(q)
    q[50] = np.nan
    G = model.gravity_torque(q)
    assert np.isnan(G[50]).any()
    others = np.arange(100) != 50
    np.testing.assert_allclose(G[others], expected[others], rtol=0, atol=1e-11)


def test_results_can_be_written_to_given_arrays(model):
    q, qd, qdd = states(model, 40)
    for method, arguments in (
        (model.dynamics, (q, qd)),
        (model.mass_matrix, (q,)),
        (model.gravity_torque, (q,)),
        (model.inverse_dynamics, (q, qd, qdd)),
    ):
        out = method(*arguments)
        expected = [array.copy() for array in (out if isinstance(out, tuple) else (out,))]
        arrays = out if isinstance(out, tuple) else (out,)
        for array in arrays:
            array[...] = np.nan
        again = method(*arguments, out=out)
        for array, mine, theirs in zip(
            arrays, again if isinstance(again, tuple) else (again,), expected, strict=True
        ):
            assert mine is array
            np.testing.assert_array_equal(mine, theirs)


@pytest.mark.parametrize(
    'wrong',
    [
        np.empty((5, 2)),
        np.empty((4, 3)),
        np.empty((5, 3), dtype=np.float32),
        np.empty((3, 5)).T,
        [[0.0] * 3] * 5,
    ],
)
def test_arrays_for_the_answer_must_fit(model, wrong):
    q = states(model, 5)[0]
    with pytest.raises(ArgumentError, match='out: expected'):
        model.gravity_torque(q, out=wrong)


def test_arrays_for_the_answer_share_no_memory_with_others(model):
    q, qd, qdd = states(model, 8)
    for method, arguments, out in (
        (model.gravity_torque, (q,), q),
        (model.gravity_torque, (q[0],), q[0]),
        (model.gravity_torque, (q[1:5],), q[0:4]),
        (model.inverse_dynamics, (q, qd, qdd), qdd),
    ):
        with pytest.raises(ArgumentError, match='out: expected arrays of their own'):
            method(*arguments, out=out)
    D, _, G = model.dynamics(q, qd)
    with pytest.raises(ArgumentError, match='out: expected arrays of their own'):
        model.dynamics(q, qd, out=(D, D, G))


@pytest.mark.parametrize('threads', [0, -1, 1.5, '2', [2], float('nan')])
@pytest.mark.parametrize('count', [1, 100])
def test_threads_are_a_number_of_at_least_one(model, threads, count):
    with pytest.raises(ArgumentError, match='threads: expected an integer of at least 1'):
        model.gravity_torque(states(model, count)[0], threads=threads)


def test_a_singular_mass_matrix_is_refused_for_states_and_batches():
    # Two joints about one axis with a massless link between them: only their sum moves inertia.
    text = random_urdf(5, joints=1, with_mimic=False, prismatic=0.0).replace(
        '</robot>',
        """
        <link name="between"/><link name="end"><inertial><mass value="1.3"/>
        <origin xyz="0.2 0.1 0"/><inertia ixx="0.01" iyy="0.02" izz="0.025" ixy="0" ixz="0"
        iyz="0"/></inertial></link>
        <joint name="a" type="continuous"><parent link="link0"/><child link="between"/>
        <axis xyz="0.6 0 0.8"/></joint><joint name="b" type="continuous">
        <parent link="between"/><child link="end"/><axis xyz="0.6 0 0.8"/></joint></robot>""",
    )
    model = RobotModel.from_urdf(text)
    rng = np.random.default_rng(1)
    for _ in range(2):
        for _ in range(50):
            q, qd, tau = rng.uniform(-2, 2, (3, 3))
            with pytest.raises(SingularMassMatrixError):
                model.forward_dynamics(q, qd, tau)
            with pytest.raises(SingularMassMatrixError):
                model.forward_dynamics(q[None], qd[None], tau[None])
        assert model.specialize() == is_supported()


def test_batch_axes_of_any_number(model):
    q, qd, _ = states(model, 24)
    n = len(model.joint_names)
    D, C, G = model.dynamics(q.reshape(2, 3, 4, n), qd.reshape(2, 3, 4, n))
    assert (D.shape, C.shape, G.shape) == ((2, 3, 4, n, n), (2, 3, 4, n, n), (2, 3, 4, n))
    np.testing.assert_array_equal(D.reshape(24, n, n), model.dynamics(q, qd).mass_matrix)


def test_plain_arrays_are_not_copied(model):
    q = states(model, 10)[0]
    assert np.shares_memory(model._evaluation.states(q=q)[1][0], q)
