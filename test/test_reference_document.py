"""docs/reference.md: up to date, and the same as a node that runs in a process of its own."""

from pathlib import Path
import re
import sys

from dynamics_node.ros.parameters.table import PARAMETERS
import pytest
from rcl_interfaces.msg import ParameterType
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters
from rclpy.parameter import parameter_value_to_python
from support.processes import Client, NodeProcess
from support.sros2_policy import read

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / 'scripts'))

from reference import graph, interfaces, page  # noqa: E402

NAME = '/dynamics_node'
KINDS = {
    ParameterType.PARAMETER_BOOL: 'bool',
    ParameterType.PARAMETER_DOUBLE: 'double',
    ParameterType.PARAMETER_STRING: 'string',
    ParameterType.PARAMETER_DOUBLE_ARRAY: 'double[]',
    ParameterType.PARAMETER_STRING_ARRAY: 'string[]',
}


def rows(title):
    """Return the cells of the first table under a heading of the page as it lies there."""
    section = page.PATH.read_text().split(f'# {title}\n', 1)[1]
    table = re.search(r'^\|.*\n\|[-|]+\n((?:\|.*\n)+)', section, re.M)[1]
    return [[cell.strip() for cell in line.strip('|').split(' | ')] for line in table.splitlines()]


def plain(cell):
    """Return a cell without the marks of code and links."""
    return re.sub(r'\[([^]]+)\]\(#[^)]*\)', r'\1', cell).replace('`', '').strip('| ')


def full(name):
    """Return a name of the page as the graph has it."""
    return name.replace('~', NAME) if name[0] in '~/' else f'/{name}'


def stated(title):
    """Return the names and types of a table of topics or services."""
    return {full(plain(name)): plain(kind) for name, kind, *_ in rows(title)}


@pytest.fixture(scope='module')
def running():
    """Return a client beside a node with its defaults."""
    node = NodeProcess()
    client = Client('reference_client')
    yield client
    client.close()
    node.close()


def test_it_is_up_to_date():
    assert page.PATH.read_text() == page.render(), 'run python scripts/write_reference.py'


@pytest.mark.timeout(120)
@pytest.mark.parametrize(
    ('title', 'question'),
    [
        ('Subscribed', 'get_subscriber_names_and_types_by_node'),
        ('Published', 'get_publisher_names_and_types_by_node'),
        ('Services', 'get_service_names_and_types_by_node'),
    ],
)
def test_a_running_node_has_these_and_no_others(running, title, question):
    def found():
        names = getattr(running.node, question)('dynamics_node', '/')
        return {
            name: kind
            for name, [kind] in names
            if name not in graph.OF_EVERY_NODE
            and 'rcl_interfaces/' not in kind
            and 'type_description' not in kind
        }

    expected = stated(title)
    running.until(lambda: 'dynamics_node' in running.node.get_node_names())
    try:
        running.until(lambda: found() == expected, timeout=20.0)
    except AssertionError:
        assert found() == expected  # which shows the difference
    assert len(expected) > 1


@pytest.mark.timeout(120)
def test_a_running_node_has_these_parameters_and_defaults(running):
    def ask(kind, service, **request):
        return running.call(kind, f'{NAME}/{service}', kind.Request(**request))

    table = {
        plain(name): (kind, plain(default), words)
        for name, kind, default, words in rows('Parameters')
    }
    listed = set(ask(ListParameters, 'list_parameters').result.names)
    # These, and the overrides of the quality of service, are those of every node.
    listed -= {'use_sim_time', 'start_type_description_service'}
    assert {name for name in listed if not name.startswith('qos_overrides')} == set(table)
    names = list(table)
    values = ask(GetParameters, 'get_parameters', names=names).values
    for name, value, said in zip(
        names,
        values,
        ask(DescribeParameters, 'describe_parameters', names=names).descriptors,
        strict=True,
    ):
        kind, default, words = table[name]
        assert KINDS[said.type] == kind, name
        assert said.read_only == words.strip('| ').endswith('Read-only'), name
        assert plain(words).startswith(said.description), name
        if said.additional_constraints:
            assert f'Accepts {said.additional_constraints}' in plain(words), name
        is_now = parameter_value_to_python(value)
        assert page.shown(is_now if isinstance(is_now, (bool, float, str)) else tuple(is_now)) == (
            default
        ), name
    assert len(names) == len(PARAMETERS) > 20


def test_every_interface_file_is_on_it_with_every_field():
    text = page.PATH.read_text()
    files = [
        path
        for folder in ('msg', 'srv')
        for path in (ROOT / 'dynamics_interfaces' / folder).iterdir()
    ]
    assert set(re.findall(r'^### (\w+)$', text, re.M)) - {'Subscribed', 'Published'} == {
        path.stem for path in files
    }
    for path in files:
        section = text.split(f'### {path.stem}\n')[1].split('\n#')[0]
        fields = [item for part in interfaces.read(path).parts for item in part]
        assert len(fields) == section.count('\n| `')
        for item in fields:
            assert item.words, f'{path.name}: {item.name} has no comment'


def test_every_program_that_is_installed_is_on_it():
    (names,) = re.findall(r'^programs = \((.*)\)$', (ROOT / 'setup.py').read_text(), re.M)
    installed = re.findall(r"'(\w+)'", names)
    assert {plain(cells[0]).split()[3] for cells in rows('Programs and launch files')} == set(
        installed
    )


def test_the_markers_program_uses_these_topics():
    # Its policy is held against the graph of the running program.
    allowed = set().union(
        *read(ROOT.joinpath('config', 'sros2_policy_markers.xml').read_text()).allowed.values()
    )
    named = {plain(name) for name, *_ in rows('Markers program')}
    used = {
        f'/{name}' if name[0] != '/' else name
        for name in (name.replace('<node>', 'dynamics_node') for name in named)
    }
    assert used == {name for name in allowed if not name.startswith('/markers/')} - {
        '/rosout',
        '/clock',
    }
    assert named == {entry.name for entry in graph.MARKERS}


def test_the_service_table_is_that_of_the_interfaces():
    named = {
        entry.kind.rpartition('/')[2]
        for entry in graph.SERVICES + graph.PUBLISHED
        if entry.kind.startswith('dynamics_interfaces/')
    }
    assert named == {
        path.stem
        for folder in ('msg', 'srv')
        for path in (ROOT / 'dynamics_interfaces' / folder).iterdir()
    }


@pytest.mark.parametrize('line', ['float64 mass kg', '// mass', 'float64'])
def test_a_line_that_is_no_field_is_refused(tmp_path, line):
    path = tmp_path / 'Broken.msg'
    path.write_text(f'# About.\n\n{line}\n')
    with pytest.raises(ValueError, match=r'Broken.msg, line 3: expected a field'):
        interfaces.read(path)
