"""The SROS2 policies in config permit exactly the names that node, markers and guard use."""

from pathlib import Path
import re
import sys

from dynamics_interfaces.srv import GetDynamics
from dynamics_node.ros.parameters.table import PARAMETERS
import pytest
from rclpy.node import NodeNameNonExistentError
from std_msgs.msg import String
from support.robots import PENDULUM
from support.sros2_policy import POLICY, PolicyError, read
from visualization_msgs.msg import MarkerArray

ROOT = Path(__file__).parents[2]
DOCUMENT = ROOT / 'docs' / 'security.md'
MARKERS_POLICY = POLICY.with_name('sros2_policy_markers.xml')
GUARD_POLICY = POLICY.with_name('sros2_policy_effort_guard.xml')
# Only used while the output is enabled, and with a controller on the command topic.
REQUESTS = ['/forward_effort_controller/get_parameters', '/controller_manager/list_controllers']
ON_ENABLE = [*REQUESTS, '/forward_effort_controller/transition_event']
sys.path.insert(0, str(ROOT / 'scripts'))

from reference import graph as reference_graph  # noqa: E402


def graph(client, namespace='/', name='dynamics_node'):
    """Return the names a node uses, as seen from another node: permission → full names."""
    node = client.node
    queries = {
        'publish': node.get_publisher_names_and_types_by_node,
        'subscribe': node.get_subscriber_names_and_types_by_node,
        'reply': node.get_service_names_and_types_by_node,
        'request': node.get_client_names_and_types_by_node,
    }
    try:
        return {
            permission: {used for used, _ in query(name, namespace)}
            for permission, query in queries.items()
        }
    except NodeNameNonExistentError:
        return {permission: set() for permission in queries}


def without(names, *others):
    return {permission: found - set(others) for permission, found in names.items()}


def difference(names, others):
    return {
        permission: found - others.get(permission, set())
        for permission, found in names.items()
        if found - others.get(permission, set())
    }


def check(client, allowed, *optional, **node):
    """Assert that a node uses all permitted names, except optional ones, and no others."""
    wanted = without(allowed, *optional)
    try:
        client.until(lambda: not difference(wanted, graph(client, **node)))
    except AssertionError:
        unused = difference(wanted, graph(client, **node))
        raise AssertionError(f'allowed, but not used: {unused}') from None
    assert difference(graph(client, **node), allowed) == {}


@pytest.mark.parametrize('namespace', ['/', '/left'])
def test_the_node_uses_exactly_the_permitted_names(client, start, namespace):
    start(f'__ns:={namespace}', use_sim_time='true')
    allowed = read(POLICY.read_text(), namespace=namespace).allowed
    optional = [namespace.rstrip('/') + name for name in ON_ENABLE]
    check(client, allowed, *optional, namespace=namespace)


def test_an_enabled_node_uses_no_other_names(client, start, controller):
    start()
    commands = controller().received
    allowed = read(POLICY.read_text()).allowed
    forbidden = []

    def state():
        client.publish(['hinge'], [0.5])
        forbidden.append(difference(graph(client), allowed))

    client.description.publish(String(data=PENDULUM.read_text()))
    client.until_heard(state)
    assert client.enable(True, state).success
    client.until(lambda: len(commands) > 20, state)
    assert client.ask(GetDynamics, state).success
    assert not any(forbidden), max(forbidden, key=len)
    check(client, allowed, *REQUESTS, '/clock')  # clients end with the answer


@pytest.mark.parametrize('namespace', ['/', '/left'])
def test_the_markers_program_uses_exactly_the_permitted_names(client, start_markers, namespace):
    start_markers(f'__ns:={namespace}', use_sim_time='true')
    client.listen(MarkerArray, f'{namespace.rstrip("/")}/dynamics_node/markers')
    allowed = read(MARKERS_POLICY.read_text(), namespace=namespace).allowed
    check(client, allowed, name='markers', namespace=namespace)


def test_the_document_links_the_policy_of_the_markers_program():
    profile = read(MARKERS_POLICY.read_text())
    assert (profile.enclave, profile.node) == ('/markers', 'markers')
    text = DOCUMENT.read_text()
    assert '(../config/sros2_policy_markers.xml), for an enclave `/markers`' in text


def test_the_guard_uses_exactly_the_permitted_names(client, start, controller):
    controller()
    start(module='dynamics_node.ros.effort_guard.main')
    check(client, read(GUARD_POLICY.read_text()).allowed, name='effort_guard')


def test_the_reference_names_what_the_policy_of_the_guard_permits():
    allowed = read(GUARD_POLICY.read_text()).allowed
    names = [entry.name for entry in reference_graph.EFFORT_GUARD]
    assert {
        name.replace('~', '/effort_guard') if name[0] in '~/' else f'/{name}' for name in names
    } == {
        name
        for permission in ('publish', 'subscribe', 'reply')
        for name in allowed[permission]
        if name not in reference_graph.OF_EVERY_NODE
        and 'parameter' not in name
        and 'type_description' not in name
    }


def test_the_command_topic_in_the_document_is_the_input_of_the_guard():
    assert read(GUARD_POLICY.read_text()).allowed['subscribe'] == {'/effort_guard/commands'}
    text = (ROOT / 'docs' / 'effort_guard.md').read_text()
    assert '-p command_topic:=/effort_guard/commands' in text
    assert GUARD_POLICY.name in text


def test_the_policy_fits_the_default_parameters():
    [topic] = [parameter.default for parameter in PARAMETERS if parameter.name == 'command_topic']
    profile = read(POLICY.read_text())
    assert f'/{topic}' in profile.allowed['publish']
    controller = topic.rpartition('/')[0]
    assert profile.allowed['request'] == set(REQUESTS)
    assert f'/{controller}/get_parameters' in REQUESTS
    assert f'/{controller}/transition_event' in profile.allowed['subscribe']


def test_the_document_names_the_enclave_of_the_file():
    text = DOCUMENT.read_text()
    enclave = read(POLICY.read_text()).enclave
    commands = re.findall(r'ros2 security create_(?:enclave|permission) \S+ (\S+)', text)
    assert commands and set(commands) == {enclave}
    assert re.findall(r'--enclave (\S+)', text) == [enclave]


@pytest.mark.parametrize(
    ('before', 'after'),
    [
        ('0.2.0', '0.1.0'),
        ('publish=', 'write='),
        ('ALLOW', 'PERMIT'),
        (' reply="ALLOW"', ''),
        ('<service>~/enable</service>', '<topic>~/enable</topic>'),
        ('>~/state<', '>~/dynamics<'),
        ('>joint_states<', '>*<'),
        (' node="dynamics_node"', ''),
        ('"/dynamics_node"', '""'),
    ],
    ids=lambda text: text,
)
def test_a_damaged_policy_is_refused(before, after):
    text = POLICY.read_text()
    assert before in text
    with pytest.raises(PolicyError):
        read(text.replace(before, after))
