"""For the tests of the node: further participants, and a pendulum whose output is on."""

import contextlib
import functools

import pytest
from support.controller import Controller
from support.processes import Client
from support.robots import PENDULUM


@pytest.fixture
def participant():
    """Return a function that starts another client, such as a controller; see `Client`."""
    with contextlib.ExitStack() as stack:

        def start(name, **options):
            client = Client(name, **options)
            stack.callback(client.close)
            return client

        yield start


@pytest.fixture
def publish(client):
    """Return an action that publishes the pendulum at rest, level."""
    return functools.partial(client.publish, ['hinge'], [0.0], [0.0])


@pytest.fixture
def level(shared):
    """Return an action that publishes the pendulum at rest, level, to the shared node."""
    return functools.partial(shared.publish, ['hinge'], [0.0], [0.0])


@pytest.fixture
def change(shared):
    """Return a function that sets a parameter of the shared node until the end of the test."""
    before = {}

    def change(name, value, action=None):
        before.setdefault(name, shared.node_parameter(name))
        result = shared.set_node_parameter(name, value, action)
        assert result.successful, result.reason

    yield change
    for name, value in before.items():
        assert shared.set_node_parameter(name, value).successful


@pytest.fixture
def drive_shared(shared, level, change):
    """Return a function that sets parameters of the shared node and enables its output."""
    if not shared.outputs:
        shared.record_commands()
        shared.until(lambda: shared.outputs)

    def drive(action=level, **changes):
        for name, value in changes.items():
            change(name, value)
        shared.commands.clear()
        shared.activate(action)

    yield drive
    shared.enable(False, level)
    shared.until(lambda: shared.output in ('READY', 'FAULT'), level)


@pytest.fixture
def drive(client, start, publish):
    """Return a function that starts a node with a pendulum and enables its output."""

    def drive(action=publish, **parameters):
        # The timeout is for a busy machine.
        process = start(robot_description_file=PENDULUM, **{'state_timeout': 0.5, **parameters})
        client.record_commands()
        client.activate(action)
        return process

    return drive


@pytest.fixture
def controller(client):
    """Return a function that starts an effort controller beside the client; see `Controller`."""
    with contextlib.ExitStack() as stack:

        def start(*arguments, **parameters):
            controller = Controller(client, *arguments, **parameters)
            stack.callback(controller.close)
            return controller

        yield start
