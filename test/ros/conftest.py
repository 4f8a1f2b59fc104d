"""Fixtures of the tests over DDS: everything started here is also ended here."""

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
    processes = []

    def start(*remappings, **parameters):
        processes.append(NodeProcess(*remappings, **parameters))
        return processes[-1]

    yield start
    for process in processes:
        process.close()
