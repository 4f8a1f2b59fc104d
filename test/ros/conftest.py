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
    with contextlib.ExitStack() as stack:  # which ends all, also when the end of one goes wrong
        def start(*remappings, **parameters):
            process = NodeProcess(*remappings, **parameters)
            stack.callback(process.close)
            return process

        yield start
