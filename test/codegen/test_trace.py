"""Straight-line programs agree with the general kernel."""

from dataclasses import replace
import math

from dynamics_node import RobotModel
from dynamics_node.codegen import trace
from dynamics_node.codegen.trace import Program, ProgramTooLongError, Symbol
from dynamics_node.kernels.packing import pack
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from support.interpreter import run
from support.random_payload import random_body
from support.robots import ARM7, PENDULUM, random_state, random_urdf


def evaluate(quantity, model, **inputs):
    results = [value for output in quantity.outputs for value in output.flat]
    numbers = model._evaluation.packed.numbers.ravel()
    values = iter(run(quantity.program, results, numbers=numbers, **inputs))
    return [
        np.array([next(values) for _ in output.flat]).reshape(output.shape)
        for output in quantity.outputs
    ]


def assert_close(actual, expected):
    scale = max(np.abs(expected).max(initial=0.0), 1e-3)
    np.testing.assert_allclose(actual, expected, rtol=0, atol=1e-13 * scale)


def assert_agrees_with_the_general_kernel(model, rng, recorded_from=None):
    """Record a robot, or the payload variant of another one, and run it as `model`."""
    q, qd = random_state(rng, model)
    qdd = rng.normal(size=q.size)
    packed = model._evaluation.packed
    if recorded_from is not None:
        packed = recorded_from._evaluation.packed.with_payload_code()
    D, C, G = model._evaluation.dynamics(q, qd)
    tau = model._evaluation.inverse_dynamics(q, qd, qdd)
    for actual, expected in zip(
        evaluate(trace.dynamics(packed), model, q=q, qd=qd), (D, C, G), strict=True
    ):
        assert_close(actual, expected)
    assert_close(evaluate(trace.mass_matrix(packed), model, q=q)[0], D)
    assert_close(evaluate(trace.coriolis_matrix(packed), model, q=q, qd=qd)[0], C)
    assert_close(evaluate(trace.gravity_torque(packed), model, q=q)[0], G)
    assert_close(evaluate(trace.inverse_dynamics(packed), model, q=q, qd=qd, qdd=qdd)[0], tau)
    # Accelerations are as exact as D is well-conditioned.
    back = evaluate(trace.forward_dynamics(packed), model, q=q, qd=qd, tau=tau)[0]
    np.testing.assert_allclose(D @ back, D @ qdd, rtol=0, atol=1e-11 * np.abs(tau).max())


# A third of the examples that others take: recording six programs of a robot takes time.
@settings(deadline=None, max_examples=settings.default.max_examples // 3)
@given(st.integers(0, 2**32 - 1))
def test_every_quantity_on_random_trees(seed):
    model = RobotModel.from_urdf(random_urdf(seed, joints=1 + seed % 3))
    assert_agrees_with_the_general_kernel(model, np.random.default_rng(seed))


@settings(deadline=None, max_examples=settings.default.max_examples // 3)
@given(st.integers(0, 2**32 - 1))
def test_every_payload_variant_on_random_trees(seed):
    rng = np.random.default_rng(seed)
    text = random_urdf(seed, joints=1 + seed % 3)
    # Recorded from one robot, run as another: with other masses, a payload and rotors.
    recorded_from = RobotModel.from_urdf(text)
    links = recorded_from.link_names
    model = RobotModel.from_urdf(text.replace('mass value="', 'mass value="1'))
    model = model.with_gravity(rng.normal(0.0, 6.0, 3)).with_rotor_inertia(rng.uniform())
    model = model.with_payload(links[int(rng.integers(len(links)))], *random_body(rng))
    assert_agrees_with_the_general_kernel(model, rng, recorded_from)


@pytest.mark.parametrize('path', [ARM7, PENDULUM], ids=['arm7', 'pendulum'])
def test_every_quantity_on_our_robots(path):
    assert_agrees_with_the_general_kernel(RobotModel.from_urdf(path), np.random.default_rng(5))


def test_the_signatures_are_those_of_the_programs():
    model = RobotModel.from_urdf(PENDULUM)
    recorded = [record(pack(model.tree, model.gravity)) for record in trace.ALL]
    assert {
        quantity.name: (quantity.inputs, len(quantity.outputs)) for quantity in recorded
    } == trace.SIGNATURES


def test_zeros_shorten_the_program_of_arm7():
    # A vertical first axis, zero offsets and right angles: an arm with none of them needs
    # about 6000 operations.
    model = RobotModel.from_urdf(ARM7)
    assert trace.dynamics(pack(model.tree, model.gravity)).operation_count < 4500


def test_the_payload_variant_contains_no_inertia():
    model = RobotModel.from_urdf(ARM7)
    packed = pack(model.tree, model.gravity).with_payload_code()
    other = packed.numbers.copy()
    for place in trace.input_places(packed):
        other[place] = np.nan
    assert np.isnan(other).sum() == 3 + 11 * packed.body_count
    for record in trace.ALL:
        programs = [record(each).program for each in (packed, replace(packed, numbers=other))]
        assert repr([operation.name for operation in programs[0].operations]) == repr(
            [operation.name for operation in programs[1].operations]
        )
        assert not any(
            isinstance(argument, float) and np.isnan(argument)
            for operation in programs[1].operations
            for argument in operation.arguments
        )


def test_a_robot_with_80_joints_is_not_recorded():
    model = RobotModel.from_urdf(random_urdf(3, joints=80, with_mimic=False))
    with pytest.raises(ProgramTooLongError):
        trace.dynamics(pack(model.tree, model.gravity))


@pytest.fixture
def program():
    return Program(1000)


@pytest.fixture
def x(program):
    return program.input('x', 0)


@pytest.fixture
def y(program):
    return program.input('x', 1)


def test_zeros_and_ones_leave_no_operation(program, x):
    before = len(program.operations)
    assert x * 0.0 == 0.0
    assert x * 1.0 is x
    assert 1.0 * x is x
    assert x + 0.0 is x
    assert 0.0 + x is x
    assert x - 0.0 is x
    assert x - x == 0.0
    assert len(program.operations) == before


def test_repeated_operations_are_recorded_once(program, x, y):
    first = x * y + 2.0
    count = len(program.operations)
    assert y * x + 2.0 is first
    assert len(program.operations) == count


def test_zero_and_minus_zero_are_different_constants(program, x):
    assert 0.0 - x is -x
    assert program.record('add', x, 0.0) is not program.record('add', x, -0.0)


def test_signs_go_into_sums_and_out_of_products(program, x, y):
    negative = -x
    assert -negative is x
    assert x + -y is x - y
    assert x - -y is x + y
    assert -x * -y is x * y
    assert -1.0 * x is -x


def test_operations_are_those_of_floats(program, x, y):
    a, b = 0.7, -1.9
    results = [x + y, x - y, x * y, x / y, -x, np.sin(x), np.cos(y), 1.0 / x, 3.0 - x, 2.5 * y]
    assert run(program, results, x=[a, b]) == [
        a + b,
        a - b,
        a * b,
        a / b,
        -a,
        math.sin(a),
        math.cos(b),
        1.0 / a,
        3.0 - a,
        2.5 * b,
    ]


def test_numpy_scalars_defer_to_symbols(x):
    for result in (np.float64(2.0) * x, np.float64(2.0) + x, np.float64(2.0) - x):
        assert isinstance(result, Symbol)


def test_only_needed_operations_in_a_valid_order(program, x, y):
    wanted = (x + y) * x
    np.sin(y)
    order = program.needed([wanted, 3.0])
    assert len(order) == 4
    for place, index in enumerate(order):
        for argument in program.operations[index].arguments:
            if isinstance(argument, Symbol):
                assert argument.index in order[:place]


def test_a_program_over_its_limit_raises():
    program = Program(10)
    x = program.input('x', 0)
    for _ in range(9):
        x = np.sin(x)
    with pytest.raises(ProgramTooLongError):
        np.sin(x)
