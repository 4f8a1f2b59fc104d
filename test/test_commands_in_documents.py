"""All commands of the documents: programs, launch arguments, topics and parameters exist."""

import importlib
import importlib.util
import re
import sys

from dynamics_node import programs
from dynamics_node.ros.effort_guard.parameters import GUARD_PARAMETERS
from dynamics_node.ros.parameters.table import PARAMETERS
from dynamics_node.ros.support.command_line import parser
import pytest
from test_readme import DOCUMENTS, name_of, ROOT
import yaml

sys.path.insert(0, str(ROOT / 'scripts'))

from reference import graph, launch_files

SOURCES = [
    *DOCUMENTS,
    *sorted((ROOT / 'config').rglob('*.yaml')),
    *sorted((ROOT / 'launch').glob('*.py')),
]
BY_NAME = {parameter.name: parameter for parameter in PARAMETERS}
OF_THE_GUARD = {parameter.name: parameter for parameter in GUARD_PARAMETERS}
TOPICS = {
    entry.name.replace('~', '/dynamics_node') for entry in graph.SUBSCRIBED + graph.PUBLISHED
} | {entry.name.replace('~', '/effort_guard') for entry in graph.EFFORT_GUARD}
# Of other packages, in the versions of Jazzy; their arguments are theirs.
OTHER_PROGRAMS = {
    'plotjuggler': {'plotjuggler'},
    'controller_manager': {'ros2_control_node', 'spawner'},
    'robot_state_publisher': {'robot_state_publisher'},
    'mass_matrix_client': {'mass_matrix_client'},
}
VERBS = {
    'bag play',
    'bag record',
    'service call',
    'pkg prefix',
    'topic echo',
    'topic info',
    'param get',
    'param set',
    'interface show',
    'run',
    'launch',
    'control switch_controllers',
    'control load_controller',
    'control list_controllers',
    'security create_keystore',
    'security create_enclave',
    'security create_permission',
}


def commands(beginning):
    """Return (document, rest of the line) of every command that begins so."""
    pattern = re.compile(rf'(?:^ +|`|^#? +|\$ |: )({re.escape(beginning)} [^`\n]*)', re.M)
    return [
        (name_of(path), match.removeprefix(beginning).strip())
        for path in SOURCES
        for match in pattern.findall(path.read_text().replace('\\\n', ' '))
    ]


RUN, LAUNCH = commands('ros2 run'), commands('ros2 launch')
PARAMS = commands('ros2 param')
ECHO, SHOW = commands('ros2 topic'), commands('ros2 interface show')
MAKE = commands('make')
MODULES = [(document, words) for document, words in commands('python -m') if words != '...']


def check_parameters(words, by_name=BY_NAME):
    """Demand that every `-p name:=value` is a parameter of the node, with a fitting value."""
    for name, value in re.findall(r"-p ([\w.]+):=('[^']*'|\S+)", words):
        value = yaml.safe_load(value.strip("'"))
        if name == 'use_sim_time':  # of every node
            assert value is True
        else:
            by_name[name].check(value)


@pytest.mark.parametrize(('document', 'words'), RUN)
def test_a_program_that_is_run_exists_with_its_options(document, words):
    package, program, *rest = words.split()
    if package != 'dynamics_node':
        assert program in OTHER_PROGRAMS[package]
        return
    assert callable(getattr(programs, program, None))
    if program == 'dynamics_node':
        own, _, of_ros = ' '.join(rest).partition('--ros-args')
        _, unknown = parser().parse_known_args(own.split())
        assert not unknown
        check_parameters(of_ros)
    elif program == 'effort_guard':
        check_parameters(' '.join(rest), OF_THE_GUARD)


@pytest.mark.parametrize(('document', 'words'), LAUNCH)
def test_a_launch_file_exists_with_its_arguments(document, words):
    package, file, *arguments = words.split()
    assert package == 'dynamics_node'
    _, known = launch_files.read(ROOT / 'launch' / file)
    assert {argument.split(':=')[0].rstrip(':') for argument in arguments if ':=' in argument} <= {
        argument.name for argument in known
    }


@pytest.mark.parametrize(('document', 'words'), PARAMS)
def test_a_parameter_that_is_read_or_set_exists(document, words):
    verb, node, name, *value = words.split(maxsplit=3)
    assert verb in ('get', 'set') and node == '/dynamics_node'
    if value:
        BY_NAME[name].check(yaml.safe_load(value[0].strip('\'"')))
    assert name in BY_NAME


@pytest.mark.parametrize(('document', 'words'), ECHO)
def test_a_topic_that_is_listened_to_exists(document, words):
    [topic] = [word for word in words.split()[1:] if word.startswith('/')]
    assert topic in TOPICS | {'/joint_states', '/robot_description'}


@pytest.mark.parametrize(('document', 'words'), SHOW)
def test_an_interface_that_is_shown_exists(document, words):
    package, folder, name = words.split()[0].split('/')
    assert hasattr(importlib.import_module(f'{package}.{folder}'), name)


@pytest.mark.parametrize(('document', 'words'), MODULES)
def test_a_module_that_is_run_exists(document, words):
    module, _, rest = words.partition(' ')
    assert importlib.util.find_spec(module) is not None, module
    check_parameters(rest)


@pytest.mark.parametrize(('document', 'words'), MAKE)
def test_a_target_of_make_exists(document, words):
    target = words.split()[0].strip('.,;')
    phony = re.search(r'^\.PHONY: (.*)$', (ROOT / 'Makefile').read_text(), re.M)[1].split()
    assert target in phony, words


def test_every_script_that_is_named_exists():
    for path in SOURCES:
        for script in re.findall(r'\bscripts/[\w/]+\.(?:py|sh)', path.read_text()):
            assert (ROOT / script).exists(), f'{name_of(path)}: {script}'


@pytest.mark.parametrize(('document', 'words'), commands('ros2 bag'))
def test_a_topic_of_a_recording_exists(document, words):
    topics = {word for word in words.split() if word.startswith('/')}
    assert topics and topics <= TOPICS | {'/joint_states', '/robot_description', '/tf_static'}


def test_no_other_verb_of_ros2_is_used():
    for path in SOURCES:
        for words in re.findall(r'(?:^#? {4,}|`)ros2 ([a-z]+ [a-z_]+)', path.read_text(), re.M):
            assert words in VERBS or words.split()[0] in VERBS, f'{name_of(path)}: {words}'


def test_all_commands_are_found():
    assert len(RUN) > 5 and len(LAUNCH) > 2 and len(MODULES) > 5 and len(MAKE) > 5
    count = sum(
        len(re.findall(r'\bros2 launch dynamics_node \w', path.read_text())) for path in SOURCES
    )
    assert len(LAUNCH) == count
