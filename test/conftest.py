"""For all tests: hypothesis profile, ROS domain, cache folder, processes, and worker groups."""

import contextlib
from operator import itemgetter
import os
from pathlib import Path

from hypothesis import HealthCheck, settings
import pytest
from support.ros_domain import claim

_TEST = Path(__file__).parent

# The same examples in every run: CI=1 make test. More of them, or fewer:
# HYPOTHESIS_EXAMPLES=5000 make test ARGS=test/dynamics
# No deadline: the time of an example depends on the load of the machine.
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
        folder = folder.parent  # shared by the workers
    folder /= 'machine_code'
    folder.mkdir(mode=0o700, exist_ok=True)
    # Also for the processes of tests.
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv('DYNAMICS_NODE_CACHE_DIR', str(folder))
        yield


@pytest.fixture(scope='session', autouse=True)
def own_domain():
    # Another than that of other workers and runs; also for the processes of tests.
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv('ROS_DOMAIN_ID', str(claim()))
        if 'ROS_AUTOMATIC_DISCOVERY_RANGE' not in os.environ:
            patch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
        yield


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
    with contextlib.ExitStack() as stack:  # ends all of them, even after an error

        def start(*remappings, **parameters):
            process = kind(*remappings, **parameters)
            stack.callback(process.close)
            return process

        yield start


@pytest.fixture(scope='module')
def shared_parameters():
    """Return the parameters of the shared node; a module may override them."""
    from support.robots import ARM7

    # A long timeout, for a busy machine.
    return {'robot_description_file': ARM7, 'state_timeout': 1.0}


@pytest.fixture(scope='module')
def shared(shared_parameters):
    """Return a client of a node, its `process`, that the tests of a file share."""
    from support.processes import Client, NodeProcess
    from support.ros_domain import claim

    with contextlib.ExitStack() as stack:
        # In a separate domain: other tests start nodes of the same name.
        with pytest.MonkeyPatch.context() as patch:
            patch.setenv('ROS_DOMAIN_ID', str(claim()))
            node = NodeProcess(**shared_parameters)
            stack.callback(node.close)
            client = Client()
        client.process = node
        stack.callback(client.close)
        yield client


# The rest only matters with pytest-xdist's `-n N --dist loadgroup`, as scripts/test.sh passes
# them: tests of one group run in one worker, groups in collection order.

# These compute each public robot once per process: see support/result_cache.py.
_SHARE_RESULTS = (
    'dynamics/test_extreme_robots.py',
    'dynamics/test_free_swing.py',
    'dynamics/test_public_robots.py',
    'test_accuracy_document.py',
)
# The slowest first: begun last, one of them would run alone. A missing file is no error.
_SLOWEST = (
    'test_code_style.py',
    'benchmarks/test_node_latency.py',
    'demo/test_demo.py',
    'report/html/test_in_browser.py',
    'test_benchmarks.py',
    'dynamics/test_identities.py',
    *_SHARE_RESULTS,
    'demo/test_simulated_robot.py',
    'ros/test_services.py',
    'codegen/test_robots.py',
    'codegen/test_manager.py',
    'kernels/test_jit.py',
)


def _group(file):
    """Return the group of a test file; None: each test starts its own processes, in any worker."""
    if file in _SHARE_RESULTS:
        return 'result_cache'
    shares_a_node = file.endswith(
        ('services.py', '_on_the_arm.py', 'external_torque.py', 'test_node.py', 'output.py')
    )
    return None if file.startswith('ros/') and not shares_a_node else file


def pytest_configure(config):
    if hasattr(config.option, 'loadscopereorder'):  # --no-loadscope-reorder of pytest-xdist
        config.option.loadscopereorder = False


@pytest.hookimpl(tryfirst=True)  # before pytest-xdist reads the marks
def pytest_collection_modifyitems(items):
    if 'PYTEST_XDIST_WORKER' not in os.environ:
        return
    slowest, by_kind = [], {True: [], False: []}
    for item in items:
        file = item.path.relative_to(_TEST).as_posix()
        group = _group(file)
        if group:
            item.add_marker(pytest.mark.xdist_group(group))
        if file in _SLOWEST:
            slowest.append((_SLOWEST.index(file), item))
        else:
            by_kind[group is None].append(item)
    # Waiting for processes and computing in turn: a core does one while the other waits.
    mixed = [
        (place / len(kind), item) for kind in by_kind.values() for place, item in enumerate(kind)
    ]
    items[:] = [item for part in (slowest, mixed) for _, item in sorted(part, key=itemgetter(0))]


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_logreport(report):
    # Without the group that pytest-xdist appends, `--last-failed` finds the test again.
    is_worker = 'PYTEST_XDIST_WORKER' in os.environ
    if not is_worker and report.nodeid.rfind('@') > report.nodeid.rfind(']'):
        report.nodeid = report.nodeid.rpartition('@')[0]
