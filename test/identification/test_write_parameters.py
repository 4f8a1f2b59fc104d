"""The parameter file: what is in it, and that YAML and the node read the same numbers."""

from dynamics_node import RobotModel
from dynamics_node.errors import ArgumentError
from dynamics_node.identification.write_parameters import write_parameters, WRITTEN
from dynamics_node.ros.parameters.table import check_all, check_lengths, PARAMETERS
import numpy as np
import pytest
from rcl_interfaces.srv import GetParameters
from support.processes import Client, NodeProcess
from support.robots import ARM7
import yaml

JOINTS = RobotModel.from_urdf(ARM7).joint_names
N = len(JOINTS)
VALUES = {
    'viscous': np.linspace(0.0, 2.0, N) / 3.0,
    'coulomb': np.linspace(1.0, 0.1, N) / 7.0,
    'smoothing_velocity': np.full(N, 0.05),
    'rotor_inertia': np.logspace(-8, 0, N),
    'effort_offset': np.linspace(-1.0, 1.0, N) / 3.0,
    'effort_scale': np.linspace(0.9, 1.1, N),
}


def read(text):
    """Return the parameters of a file."""
    [(node, content)] = yaml.safe_load(text).items()
    assert node == '/**/dynamics_node'
    return content['ros__parameters']


def test_every_number_is_read_back_equal():
    values = read(write_parameters(JOINTS, **VALUES))
    assert values.pop('joints') == list(JOINTS)
    assert list(values) == [parameter.name for parameter in WRITTEN]
    for parameter in WRITTEN:
        assert values[parameter.name] == VALUES[parameter.argument].tolist()


@pytest.mark.parametrize('number', [0.0, -0.0, 1e-5, -1e-300, 1e5, 123456.0, 1 / 3, 1e22 / 1e17])
def test_every_double_is_a_number_of_yaml(number):
    [value] = read(write_parameters(['a'], effort_offset=[number]))['effort_offset']
    assert isinstance(value, float)
    assert value == number


def test_what_is_not_given_is_not_in_the_file():
    assert read(write_parameters(['a', 'b'], coulomb=[1.0, 2.0])) == {
        'joints': ['a', 'b'],
        'friction.coulomb': [1.0, 2.0],
    }


def test_friction_compensation_is_never_switched_on():
    assert 'compensate' not in str(read(write_parameters(JOINTS, **VALUES)))


def test_one_smoothing_velocity_is_for_all_joints():
    values = read(write_parameters(JOINTS, smoothing_velocity=0.05))
    assert values['friction.smoothing_velocity'] == [0.05]


@pytest.mark.parametrize(
    'name', ['yes', 'NaN', 'a: b', '1', '-', "it's", 'a"b', 'é', '~', '# a', 'a\\b', '\U0001f9be']
)
def test_any_name_of_a_joint_stays_a_text(name):
    assert read(write_parameters([name], viscous=[1.0]))['joints'] == [name]


def test_the_comment_is_a_comment_whatever_it_contains():
    text = write_parameters(['a'], viscous=[1.0], comment='from run.mcap:\n\n\x07/**: {}\u2028b')
    assert text.startswith('# from run.mcap:\n#\n# ?/**: {}\n# b\n#     ros2 run')
    assert read(text) == {'joints': ['a'], 'friction.viscous': [1.0]}


@pytest.mark.parametrize(
    'values, message',
    [
        ({'viscous': [1.0]}, r'viscous: expected shape \(2,\), one number per joint, got \(1,\)'),
        ({'coulomb': 1.0}, r'coulomb: expected shape \(2,\), one number per joint, got \(\)'),
        ({'coulomb': [1.0, -0.1]}, 'coulomb: expected finite numbers >= 0 and <= 1e[+]06, got -0'),
        ({'smoothing_velocity': 0.0}, 'smoothing_velocity: expected finite numbers > 0, got 0'),
        ({'effort_scale': [1.0, 11.0]}, 'effort_scale: expected finite numbers >= 0 and <= 10'),
        ({'effort_offset': [1.0, np.nan]}, 'effort_offset: expected finite numbers .* got nan'),
    ],
)
def test_wrong_values_are_refused(values, message):
    with pytest.raises(ArgumentError, match=message):
        write_parameters(['a', 'b'], **values)


def test_a_file_without_joints_is_refused():
    with pytest.raises(ArgumentError, match='expected at least one joint'):
        write_parameters([])


def test_the_ranges_are_those_of_the_node():
    table = {parameter.name: parameter for parameter in PARAMETERS}
    for parameter in WRITTEN:
        known = table[parameter.name]
        assert (parameter.low, parameter.high) == (known.low, known.high), parameter.name
        assert parameter.is_positive == known.low_open, parameter.name
        assert known.per_joint


def test_the_checks_of_the_node_accept_the_file():
    values = read(write_parameters(JOINTS, **VALUES))
    assert values.keys() <= {parameter.name for parameter in PARAMETERS}
    check_lengths(check_all(values), JOINTS)


@pytest.mark.timeout(120)
def test_the_node_has_the_numbers_of_the_file(tmp_path):
    path = tmp_path / 'arm.yaml'
    chosen = JOINTS[2::-1]
    values = {name: value[:3] for name, value in VALUES.items()}
    path.write_text(write_parameters(chosen, **values), encoding='utf-8')
    names = ['joints', *(parameter.name for parameter in WRITTEN), 'compensate.friction']
    node = NodeProcess(parameters_file=path, robot_description_file=ARM7)
    client = Client()
    try:
        answer = client.call(
            GetParameters, '/dynamics_node/get_parameters', GetParameters.Request(names=names)
        )
    finally:
        client.close()
        node.close()
    joints, *numbers, friction = answer.values
    assert joints.string_array_value == list(chosen)
    for parameter, value in zip(WRITTEN, numbers, strict=True):
        assert value.double_array_value.tolist() == values[parameter.argument].tolist()
    assert not friction.bool_value
