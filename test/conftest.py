"""For all tests: what hypothesis draws, what they have for themselves, and who runs what."""

import contextlib
import os

from hypothesis import HealthCheck, settings
import pytest
from support.ros_domain import claim

# The same examples in every run: CI=1 make test. More of them, or fewer:
# HYPOTHESIS_EXAMPLES=5000 make test ARGS=test/dynamics
# How long an example takes depends on what else runs here, and is not what they judge.
settings.register_profile(
    'here',
    derandomize=bool(os.environ.get('CI')),
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
    max_examples=int(os.environ.get('HYPOTHESIS_EXAMPLES', settings.default.max_examples)),
)
settings.load_profile('here')


@pytest.fixture(scope='session', autouse=True)
def machine_code_folder(tmp_path_factory):
    folder = tmp_path_factory.getbasetemp()
    if 'PYTEST_XDIST_WORKER' in os.environ:
        folder = folder.parent  # which the workers share, as programs on one machine do
    folder /= 'machine_code'
    folder.mkdir(mode=0o700, exist_ok=True)
    # Processes that tests start find it too.
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv('DYNAMICS_NODE_CACHE_DIR', str(folder))
        yield


@pytest.fixture(scope='session', autouse=True)
def own_domain():
    # The one that was chosen, unless another worker or another run is in it. Processes that
    # tests start are in it too.
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv('ROS_DOMAIN_ID', str(claim()))
        if 'ROS_AUTOMATIC_DISCOVERY_RANGE' not in os.environ:
            patch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
        yield


# Over DDS: everything started here is also ended here.
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
    from support.processes import Client, NodeProcess
    from support.robots import ARM7
    from support.ros_domain import claim

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


# Both only with pytest-xdist, as scripts/test.sh starts it.


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    if config.getvalue('dist') != 'load':
        return None  # somebody wants it otherwise
    from support.schedule import Schedule

    return Schedule(config, log)


def pytest_collection_modifyitems(items):
    if 'PYTEST_XDIST_WORKER' in os.environ:
        from support.schedule import in_order

        items[:] = [items[place] for place in in_order([item.nodeid for item in items])]
