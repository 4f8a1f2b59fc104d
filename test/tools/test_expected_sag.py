"""The expected sag, compared with the equation of the pendulum."""

import numpy as np
from soak.expected_sag import expected_sag
from support.robots import ARM7, PENDULUM

G, LENGTH = 9.81, 0.7  # of pendulum.urdf: its torque at 0 is m G LENGTH / 2


def test_what_is_held_by_the_right_effort_falls_only_as_that_fades():
    text = PENDULUM.read_text()
    _, _, fast = expected_sag(text, np.zeros(1), np.zeros(1), 1.0, 0.5)
    times, _, slow = expected_sag(text, np.zeros(1), np.array([0.5 * 3 * LENGTH * G]), 1.0, 0.5)
    # With a torque that lacks a share t of what is needed, the speed grows with t^2 / 2
    # instead of t: both at the same acceleration, as long as the way is short.
    early = (times > 0.05) & (times < 0.15)
    np.testing.assert_allclose(slow[early] / fast[early], times[early] / 2, rtol=0.03)


def test_an_arm_that_nothing_holds_falls_at_once():
    _, positions, speeds = expected_sag(ARM7.read_text(), np.full(8, 0.5), np.zeros(8), 1.0, 0.01)
    assert positions.shape == (20, 9) and speeds.shape == (20,)
    assert (np.diff(speeds) > 0.0).all()
