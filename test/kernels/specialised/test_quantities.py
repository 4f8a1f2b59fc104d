"""Straight-line programs compute what the general kernel does."""

from dynamics_node import RobotModel
from dynamics_node.kernels.packing import pack
from dynamics_node.kernels.specialised import quantities
from dynamics_node.kernels.specialised.symbols import ProgramTooLongError
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from support.carried import random_body
from support.interpreter import run
from support.robots import ARM7, PENDULUM, random_state, random_urdf


def evaluate(quantity, model, **inputs):
    results = [value for output in quantity.outputs for value in output.flat]
    numbers = model._evaluation.packed[1].ravel()
    values = iter(run(quantity.program, results, numbers=numbers, **inputs))
    return [
        np.array([next(values) for _ in output.flat]).reshape(output.shape)
        for output in quantity.outputs
    ]


def assert_close(actual, expected):
    scale = max(np.abs(expected).max(initial=0.0), 1e-3)
    np.testing.assert_allclose(actual, expected, rtol=0, atol=1e-13 * scale)


def hold_against_the_general_kernel(model, rng, recorded_from=None):
    """Record a robot, or one for any inertia that differs in it, and run it as `model`."""
    q, qd = random_state(rng, model)
    qdd = rng.normal(size=q.size)
    packed = model._evaluation.packed
    if recorded_from is not None:
        packed = *recorded_from._evaluation.packed, True
    D, C, G = model._evaluation.dynamics(q, qd)
    tau = model._evaluation.inverse_dynamics(q, qd, qdd)
    for actual, expected in zip(
        evaluate(quantities.dynamics(*packed), model, q=q, qd=qd), (D, C, G), strict=True
    ):
        assert_close(actual, expected)
    assert_close(evaluate(quantities.mass_matrix(*packed), model, q=q)[0], D)
    assert_close(evaluate(quantities.coriolis_matrix(*packed), model, q=q, qd=qd)[0], C)
    assert_close(evaluate(quantities.gravity_torque(*packed), model, q=q)[0], G)
    assert_close(
        evaluate(quantities.inverse_dynamics(*packed), model, q=q, qd=qd, qdd=qdd)[0], tau
    )
    # What comes back is as exact as D is well-conditioned.
    back = evaluate(quantities.forward_dynamics(*packed), model, q=q, qd=qd, tau=tau)[0]
    np.testing.assert_allclose(D @ back, D @ qdd, rtol=0, atol=1e-11 * np.abs(tau).max())


# A third of the examples that others take: recording six programs of a robot takes time.
@settings(deadline=None, max_examples=settings.default.max_examples // 3)
@given(st.integers(0, 2**32 - 1))
def test_every_quantity_on_random_trees(seed):
    model = RobotModel.from_urdf(random_urdf(seed, joints=1 + seed % 3))
    hold_against_the_general_kernel(model, np.random.default_rng(seed))


@settings(deadline=None, max_examples=settings.default.max_examples // 3)
@given(st.integers(0, 2**32 - 1))
def test_every_quantity_for_any_inertia_on_random_trees(seed):
    rng = np.random.default_rng(seed)
    text = random_urdf(seed, joints=1 + seed % 3)
    # Recorded from one robot, run as another: with other masses, a payload and rotors.
    recorded_from = RobotModel.from_urdf(text)
    links = recorded_from.link_names
    model = RobotModel.from_urdf(text.replace('mass value="', 'mass value="1'))
    model = model.with_gravity(rng.normal(0.0, 6.0, 3)).with_rotor_inertia(rng.uniform())
    model = model.with_payload(links[int(rng.integers(len(links)))], *random_body(rng))
    hold_against_the_general_kernel(model, rng, recorded_from)


@pytest.mark.parametrize('path', [ARM7, PENDULUM], ids=['arm7', 'pendulum'])
def test_every_quantity_on_our_robots(path):
    hold_against_the_general_kernel(RobotModel.from_urdf(path), np.random.default_rng(5))


def test_the_signatures_are_those_of_the_programs():
    model = RobotModel.from_urdf(PENDULUM)
    recorded = [record(*pack(model.tree, model.gravity)) for record in quantities.ALL]
    assert {
        quantity.name: (quantity.inputs, len(quantity.outputs)) for quantity in recorded
    } == quantities.SIGNATURES


def test_a_straight_line_is_shorter_than_the_loops():
    # A vertical first axis, zero offsets and right angles: an arm with none of them needs
    # about 6000 operations.
    model = RobotModel.from_urdf(ARM7)
    assert quantities.dynamics(*pack(model.tree, model.gravity)).operation_count < 4500


def test_for_any_inertia_no_number_of_the_recorded_robot_is_left():
    model = RobotModel.from_urdf(ARM7)
    structure, numbers = pack(model.tree, model.gravity)
    other = numbers.copy()
    for place in quantities.input_places(len(structure), True):
        other[place] = np.nan
    assert np.isnan(other).sum() == 3 + 11 * len(structure)
    for record in quantities.ALL:
        programs = [record(structure, values, True).program for values in (numbers, other)]
        assert repr([operation.name for operation in programs[0].operations]) == repr(
            [operation.name for operation in programs[1].operations]
        )
        assert not any(
            isinstance(argument, float) and np.isnan(argument)
            for operation in programs[1].operations
            for argument in operation.arguments
        )


def test_robots_with_very_many_joints_are_not_recorded():
    model = RobotModel.from_urdf(random_urdf(3, joints=80, with_mimic=False))
    with pytest.raises(ProgramTooLongError):
        quantities.dynamics(*pack(model.tree, model.gravity))
