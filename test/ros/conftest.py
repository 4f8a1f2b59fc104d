"""Fixtures of the tests over DDS: everything started here is also ended here."""

import os

import pytest

# A domain of one's own, unless whoever starts the tests has chosen one.
os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
os.environ.setdefault('ROS_DOMAIN_ID', str(os.getpid() % 100 + 1))


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
