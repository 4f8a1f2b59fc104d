"""The table of parameters: checks, documents and declaration."""

from pathlib import Path
import re

from dynamics_node.errors import ParameterError
from dynamics_node.ros.parameters.parameters import Parameters
from dynamics_node.ros.parameters.table import check_all, check_lengths, PARAMETERS
import pytest
from rclpy.parameter import Parameter as RosParameter
import yaml

ROOT = Path(__file__).parents[2]


def test_defaults_pass_their_own_checks_and_integers_count_as_doubles():
    values = check_all({})
    assert list(values) == [parameter.name for parameter in PARAMETERS]
    assert values['gravity'] == (0.0, 0.0, -9.81)
    assert check_all({'effort_limits': [87, 12]})['effort_limits'] == (87.0, 12.0)


@pytest.mark.parametrize(
    'name, value, message',
    [
        ('gravity', [0, 0], 'gravity: expected 3 numbers'),
        ('gravity', [0, 0, 'down'], 'gravity: expected a number'),
        (
            'gravity',
            [0.0, 0.0, float('nan')],
            'gravity: expected a number >= -20 and <= 20, got nan',
        ),
        ('gravity', [15.0, 15.0, 0.0], r'gravity: expected at most 20 m/s\^2, got 21.21'),
        ('gravity', 'down', 'gravity: expected a list of numbers'),
        ('state_timeout', 0.0, 'state_timeout: expected a number > 0 and <= 10, got 0.0'),
        ('state_timeout', True, 'state_timeout: expected a number, got True'),
        ('start_ramp', -1, 'start_ramp: expected a number >= 0'),
        ('stop_behavior', 'faint', "expected one of ramp_to_zero, hold, zero, got 'faint'"),
        ('effort_limits', [1.0, 0.0], 'effort_limits: expected a finite number > 0, got 0.0'),
        ('effort_limits', [True], 'effort_limits: expected a number'),
        ('effort_offset', [float('inf')], 'effort_offset: expected a number >= -1e[+]06'),
        ('joints', ['a', ''], 'joints: expected a list of texts that are not empty'),
        ('joints', 'a', "joints: expected a list of texts, got 'a'"),
        ('enable_on_start', 'yes', 'enable_on_start: expected true or false'),
        ('command_topic', 3, 'command_topic: expected a text'),
    ],
)
def test_a_wrong_value_is_refused_with_the_reason(name, value, message):
    with pytest.raises(ParameterError, match=message):
        check_all({name: value})


def test_all_wrong_values_are_named_together():
    with pytest.raises(ParameterError, match=r'state_timeout.*; start_ramp'):
        check_all({'state_timeout': 0, 'start_ramp': -1})


def test_constraints_are_the_accepted_values_in_words():
    constraints = {parameter.name: parameter.constraints() for parameter in PARAMETERS}
    assert constraints['state_timeout'] == 'a number > 0 and <= 10'
    assert constraints['effort_limits'] == 'a finite number > 0'
    assert constraints['stop_behavior'] == 'one of ramp_to_zero, hold, zero'
    assert constraints['joints'] == constraints['publish_dynamics'] == ''


@pytest.mark.parametrize(
    'name, count, is_accepted',
    [
        ('effort_limits', 0, True),
        ('effort_limits', 1, False),
        ('effort_limits', 2, True),
        ('effort_offset', 2, True),
        ('effort_offset', 1, False),
        ('rotor_inertia', 3, False),
        ('friction.smoothing_velocity', 1, True),
        ('friction.smoothing_velocity', 3, False),
    ],
)
def test_a_parameter_per_joint_has_one_number_per_joint(name, count, is_accepted):
    values = check_all({name: [1.0] * count})
    if is_accepted:
        check_lengths(values, ['a', 'b'])
        return
    reason = f'^{name}: expected 2 numbers for a, b, or none; got {count}$'
    with pytest.raises(ParameterError, match=reason):
        check_lengths(values, ['a', 'b'])


def flat(tree, prefix=''):
    """Yield the dotted names and values of nested parameters."""
    for name, value in tree.items():
        if isinstance(value, dict):
            yield from flat(value, f'{prefix}{name}.')
        else:
            yield prefix + name, value


def test_the_parameter_file_has_every_parameter_with_its_default():
    text = (ROOT / 'config' / 'dynamics.yaml').read_text()
    [node] = yaml.safe_load(text).values()
    # Empty ones are comments, with an example.
    written = dict(flat(node['ros__parameters']))
    for parameter in PARAMETERS:
        if parameter.default == ():
            assert re.search(rf'^ +# {re.escape(parameter.name)}: \[', text, re.M), parameter.name
        else:
            value = written.pop(parameter.name)
            assert parameter.check(value) == parameter.default, parameter.name
    assert written == {}


@pytest.fixture
def started_node(participant):
    """Return a node that was started with two undeclared names."""
    overrides = [RosParameter('effort_limit', value=[1.0]), RosParameter('color', value='red')]
    return participant('misspelled', parameter_overrides=overrides).node


def test_a_misspelled_name_gets_a_warning_and_other_names_do_not(started_node, capfd):
    Parameters(started_node)
    log = capfd.readouterr().err
    assert (
        "there is no parameter 'effort_limit', and its value is ignored: is 'effort_limits' meant?"
    ) in log
    assert 'color' not in log
    descriptor = started_node.describe_parameter('state_timeout')
    assert descriptor.additional_constraints == 'a number > 0 and <= 10'
    assert descriptor.description.startswith('Largest age of a joint state, s')
