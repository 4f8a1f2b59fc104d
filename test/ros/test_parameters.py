"""Parameters as rclpy declares them."""

from dynamics_node.ros.parameters import Parameters
import pytest
from rclpy.parameter import Parameter as RosParameter
from support.processes import Client


@pytest.fixture
def given():
    """Return a node that was started with two names that nobody declares."""
    client = Client(
        'misspelt',
        parameter_overrides=[
            RosParameter('effort_limit', value=[1.0]),
            RosParameter('colour', value='red'),
        ],
    )
    yield client.node
    client.close()


def test_a_misspelt_name_is_warned_of_and_what_others_use_is_not(given, capfd):
    Parameters(given)
    said = capfd.readouterr().err
    assert (
        "there is no parameter 'effort_limit', and its value is ignored: is 'effort_limits' meant?"
    ) in said
    assert 'colour' not in said


def test_what_is_accepted_stands_in_the_description_of_a_parameter(given):
    Parameters(given)
    descriptor = given.describe_parameter('state_timeout')
    assert descriptor.additional_constraints == 'a number > 0 and <= 10'
    assert descriptor.description.startswith('Largest age of a joint state, s')
