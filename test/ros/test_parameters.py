"""The table of parameters: checks, and that every document tells the same."""

from pathlib import Path
import re

from dynamics_node.ros.parameters.parameters import Parameters
from dynamics_node.ros.parameters.table import check_all, ParameterError, PARAMETERS
import pytest
from rclpy.parameter import Parameter as RosParameter
from support.processes import Client
import yaml

ROOT = Path(__file__).parents[2]


def test_defaults_pass_their_own_checks():
    values = check_all({})
    assert list(values) == [parameter.name for parameter in PARAMETERS]
    assert values['gravity'] == (0.0, 0.0, -9.81)


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
        ('joints', ['a', ''], 'joints: expected a list of texts that are not empty'),
        ('joints', 'a', "joints: expected a list of texts, got 'a'"),
        ('enable_on_start', 'yes', 'enable_on_start: expected true or false'),
        ('command_topic', 3, 'command_topic: expected a text'),
    ],
)
def test_a_wrong_value_is_refused_with_the_reason(name, value, message):
    with pytest.raises(ParameterError, match=message):
        check_all({name: value})


def test_all_wrong_values_are_named_at_once():
    with pytest.raises(ParameterError, match=r'state_timeout.*; start_ramp'):
        check_all({'state_timeout': 0, 'start_ramp': -1})


def test_the_accepted_values_are_said_in_words():
    said = {parameter.name: parameter.constraints() for parameter in PARAMETERS}
    assert said['state_timeout'] == 'a number > 0 and <= 10'
    assert said['effort_limits'] == 'a finite number > 0'
    assert said['stop_behavior'] == 'one of ramp_to_zero, hold, zero'
    assert said['joints'] == said['publish_dynamics'] == ''


def test_integers_are_taken_for_doubles():
    assert check_all({'effort_limits': [87, 12]})['effort_limits'] == (87.0, 12.0)


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
    # Those that are empty stand in comments, with an example.
    written = dict(flat(node['ros__parameters']))
    for parameter in PARAMETERS:
        if parameter.default == ():
            assert re.search(rf'^ +# {re.escape(parameter.name)}: \[', text, re.M), parameter.name
        else:
            value = written.pop(parameter.name)
            assert parameter.check(value) == parameter.default, parameter.name
    assert written == {}


def test_the_reference_has_every_parameter_with_its_default():
    text = (ROOT / 'docs' / 'reference.md').read_text()
    rows = dict(re.findall(r'^\| `([a-z_.]+)` \| [a-z\[\]]+ \| (.*?) \|', text, re.M))
    for parameter in PARAMETERS:
        default = parameter.default
        if isinstance(default, bool):
            shown = str(default).lower()
        else:
            shown = list(default) if isinstance(default, tuple) else default
            shown = "''" if shown == '' else shown
        assert rows.get(parameter.name) == f'`{shown}`', parameter.name


@pytest.fixture
def given():
    """Return a node that was started with two names that nobody declares."""
    client = Client(
        'misspelled',
        parameter_overrides=[
            RosParameter('effort_limit', value=[1.0]),
            RosParameter('color', value='red'),
        ],
    )
    yield client.node
    client.close()


def test_a_misspelled_name_is_warned_of_and_what_others_use_is_not(given, capfd):
    Parameters(given)
    said = capfd.readouterr().err
    assert (
        "there is no parameter 'effort_limit', and its value is ignored: is 'effort_limits' meant?"
    ) in said
    assert 'color' not in said


def test_what_is_accepted_stands_in_the_description_of_a_parameter(given):
    Parameters(given)
    descriptor = given.describe_parameter('state_timeout')
    assert descriptor.additional_constraints == 'a number > 0 and <= 10'
    assert descriptor.description.startswith('Largest age of a joint state, s')
