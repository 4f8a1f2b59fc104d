"""The launch files: nodes, arguments, name spaces, RViz."""

import importlib.util
from pathlib import Path
import re

from dynamics_node import programs
import pytest
from support.robots import ARM7, PENDULUM

ROOT = Path(__file__).parents[1]
LAUNCH_FILES = sorted((ROOT / 'launch').glob('*.launch.py'))


def read(path):
    """Return a launch file as a module; skip the test where launch is not installed."""
    # launch and launch_ros are not on PyPI; where ROS 2 is installed they are there.
    pytest.importorskip('launch_ros.actions')
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    module.get_package_share_directory = lambda package: str(ROOT)
    return module


def started(path, are_viewers_installed=None, **arguments):
    """Return the nodes that a launch file starts with arguments, and its messages."""
    module = read(path)
    if are_viewers_installed is not None:
        module.is_installed = lambda package: are_viewers_installed
    from launch import LaunchContext
    from launch.actions import DeclareLaunchArgument, LogInfo, OpaqueFunction
    from launch_ros.actions import Node

    context, entities = LaunchContext(), []
    context.launch_configurations.update(arguments)
    for entity in module.generate_launch_description().entities:
        if isinstance(entity, DeclareLaunchArgument):
            entity.visit(context)
        elif entity.condition is None or entity.condition.evaluate(context):
            is_function = isinstance(entity, OpaqueFunction)
            entities += (entity.execute(context) if is_function else [entity]) or []
    nodes = [entity for entity in entities if isinstance(entity, Node)]
    messages = ' '.join(
        ''.join(part.perform(context) for part in entity.msg)
        for entity in entities
        if isinstance(entity, LogInfo)
    )
    for node in nodes:
        try:
            node._perform_substitutions(context)
        except LookupError:
            pass  # the package is not installed; the arguments are known all the same
    return nodes, messages


@pytest.mark.parametrize('path', LAUNCH_FILES, ids=lambda path: path.name)
def test_a_launch_file_starts_executables_of_this_package(path):
    nodes, messages = started(path)
    assert nodes and not messages
    for node in nodes:
        assert node.node_package == 'dynamics_node'
        assert callable(getattr(programs, node.node_executable, None))


@pytest.mark.parametrize('path', LAUNCH_FILES, ids=lambda path: path.name)
def test_everything_is_in_the_namespace(path):
    nodes, _ = started(path, namespace='left')
    assert nodes
    assert all(node.node_name.startswith('/left/') for node in nodes)


@pytest.mark.parametrize(('given', 'expected'), [({}, 1), ({'robot': str(PENDULUM)}, 2)])
def test_a_robot_overrides_the_parameter_file(given, expected):
    [node], _ = started(ROOT / 'launch' / 'dynamics.launch.py', **given)
    assert len(node._Node__parameters) == expected


def test_the_effort_guard_stands_between_the_node_and_the_controller():
    guard, node = started(
        ROOT / 'launch' / 'dynamics.launch.py',
        effort_guard='true',
        namespace='left',
        controller_topic='mine/commands',
    )[0]
    assert (guard.node_executable, guard.node_name) == ('effort_guard', '/left/effort_guard')
    assert len(guard._Node__parameters) == 2
    [[text]] = node._Node__parameters[-1].values()
    assert text.text.splitlines()[0] == 'effort_guard/commands'  # it is YAML


@pytest.mark.parametrize('path', LAUNCH_FILES, ids=lambda path: path.name)
@pytest.mark.parametrize('argument', ['params_file', 'robot'])
def test_a_file_that_is_not_there_starts_nothing(path, argument):
    # The node would start with defaults: the URDF's full effort limits, say.
    expected = f"{argument}: no such file: '/.*nope.yaml'"
    with pytest.raises(FileNotFoundError, match=expected):
        started(path, **{argument: 'nope.yaml'})


def test_the_demo_waits_longer_for_states_unless_a_file_says_how_long(tmp_path):
    path = ROOT / 'launch' / 'demo.launch.py'
    [_, node], _ = started(path)
    assert '0.5' in str(node._Node__parameters[0])
    file = tmp_path / 'mine.yaml'
    file.write_text('/**: {ros__parameters: {state_timeout: 0.2}}')
    [_, node], _ = started(path, params_file=str(file))
    assert len(node._Node__parameters) == 1 and '0.5' not in str(node._Node__parameters[0])


def test_without_rviz_the_demo_starts_with_a_message():
    path = ROOT / 'launch' / 'demo.launch.py'
    plain, _ = started(path)
    with_rviz, messages = started(path, rviz='true')
    if len(with_rviz) == len(plain):  # as here, where ROS comes from PyPI
        assert 'rviz2' in messages and 'ros-$ROS_DISTRO-rviz2' in messages
    else:
        assert {node.node_package for node in with_rviz} == {
            'dynamics_node',
            'rviz2',
            'robot_state_publisher',
        }


def test_rviz_comes_with_the_markers_program_in_the_same_namespace():
    path = ROOT / 'launch' / 'demo.launch.py'
    nodes, messages = started(path, are_viewers_installed=True, rviz='true', namespace='left')
    assert not messages
    names = [node.node_name for node in nodes if node.node_executable == 'markers']
    assert names == ['/left/markers']
    nodes, _ = started(path, are_viewers_installed=False, rviz='true')
    assert 'markers' not in {node.node_executable for node in nodes}


@pytest.mark.parametrize('robot', [ARM7, PENDULUM], ids=lambda path: path.stem)
def test_rviz_looks_from_the_root_link(robot):
    from dynamics_node import RobotModel

    module = read(ROOT / 'launch' / 'demo.launch.py')
    assert module.root_link(robot.read_text()) == RobotModel.from_urdf(robot).tree.root


def test_every_argument_that_is_used_in_the_documents_exists():
    used = {'dynamics.launch.py': set(), 'demo.launch.py': set()}
    for document in (ROOT / 'README.md', *(ROOT / 'docs').glob('*.md'), *LAUNCH_FILES):
        for file, arguments in re.findall(
            r'ros2 launch dynamics_node (\S+\.py)((?: \w+:=\S+)*)', document.read_text()
        ):
            used[file] |= set(re.findall(r'(\w+):=', arguments))
    assert used['demo.launch.py'] >= {'namespace', 'rviz'}
    for file, arguments in used.items():
        declared = set(
            re.findall(r"DeclareLaunchArgument\(\s*'(\w+)'", (ROOT / 'launch' / file).read_text())
        )
        assert arguments <= declared
