"""Fixtures of the tests over DDS: everything started here is also ended here."""

import contextlib

import pytest


@pytest.fixture
def client():
    """Return a client of the node."""
    from support.processes import Client

    client = Client()
    yield client
    client.close()


@pytest.fixture
def start():
    """Return a function that starts the node with parameters."""
    from support.processes import NodeProcess

    with _starting(NodeProcess) as start:
        yield start


@pytest.fixture
def start_markers():
    """Return a function that starts the markers program with parameters."""
    from support.processes import MarkersProcess

    with _starting(MarkersProcess) as start:
        yield start


@contextlib.contextmanager
def _starting(kind):
    with contextlib.ExitStack() as stack:  # which ends all, also when the end of one goes wrong

        def start(*remappings, **parameters):
            process = kind(*remappings, **parameters)
            stack.callback(process.close)
            return process

        yield start


@pytest.fixture(scope='module')
def shared():
    """Return a client of a node with arm7, for all tests of a file that only ask."""
    from support.domains import claim
    from support.processes import Client, NodeProcess
    from support.robots import ARM7

    with contextlib.ExitStack() as stack:
        # In a domain of its own: other tests here start nodes of the same name.
        with pytest.MonkeyPatch.context() as patch:
            patch.setenv('ROS_DOMAIN_ID', str(claim()))
            # A busy machine does not trip it while states come.
            node = NodeProcess(robot_description_file=ARM7, state_timeout=1.0)
            stack.callback(node.close)
            client = Client()
        stack.callback(client.close)
        yield client
