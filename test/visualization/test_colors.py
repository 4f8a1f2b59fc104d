"""Colors of loads: from green over yellow to red."""

from dynamics_node.visualization import colors
import numpy as np
import pytest


def test_from_green_over_yellow_to_red():
    green, yellow, red = (colors.of_load(load) for load in (0.0, 0.5, 0.999999))
    assert green[1] > 0.8 and green[0] == 0.0
    assert yellow[0] > 0.8 and yellow[1] > 0.8
    assert red[0] > 0.9 and red[1] < 0.01


@pytest.mark.parametrize('load', [1.0, 1.5, 1e9])
def test_over_the_limit_is_red(load):
    assert colors.of_load(load) == colors.OVER_THE_LIMIT


def test_colors_are_continuous_and_valid():
    values = np.array([colors.of_load(load) for load in np.linspace(0.0, 1.2, 500)])
    assert np.abs(np.diff(values, axis=0)).max() < 0.11
    assert values.min() >= 0.0 and values.max() <= 1.0
    assert (values[:, 3] == 1.0).all()
