"""
In which order, and which together, pytest-xdist's workers run the whole suite.

Tests that wait for processes and tests that compute are mixed, so that a core does one while
the other waits. What shares something costly stays in one worker.

"""

from xdist.scheduler import LoadScopeScheduling

# Files whose tests start processes of their own: each test may run in any worker.
_WITH_PROCESSES = 'test/ros/test_'
# But for these, whose tests share them.
_SHARING = {
    'test/ros/test_services.py',
    'test/ros/test_payload_gravity_services.py',
    'test/ros/test_trajectory_services.py',
    'test/ros/test_faults_on_the_arm.py',
    'test/ros/test_payload_on_the_arm.py',
    'test/ros/test_external_torque_on_the_arm.py',
}

# Files that share what a process computes only once: see support/sweep.py.
_TOGETHER = {
    f'test/{name}.py': 'sweep'
    for name in (
        'dynamics/test_extreme_robots',
        'dynamics/test_free_swing',
        'dynamics/test_public_robots',
        'test_accuracy_document',
    )
}

# What takes longest comes first: begun last, it would keep one worker busy while the others
# have nothing left. A file that is missing here is no error, it only costs time.
_FIRST = (
    'test/test_code_style.py',
    'test/benchmarks/test_node_latency.py',
    'test/demo/test_demo.py',
    'test/report/html/test_in_browser.py',
    'test/test_benchmarks.py',
    'test/dynamics/test_identities.py',
    'sweep',
    'test/demo/test_simulated_robot.py',
    'test/ros/test_services.py',
    'test/codegen/test_robots.py',
    'test/codegen/test_manager.py',
    'test/kernels/test_jit.py',
)


def unit(nodeid):
    """Return the name of what stays in one worker: a test, a file, or some files."""
    file = nodeid.partition('::')[0]
    if file.startswith(_WITH_PROCESSES) and file not in _SHARING:
        return nodeid
    return _TOGETHER.get(file, file)


def in_order(nodeids):
    """Return positions of tests, units in the order in which workers shall take them."""
    units = {}
    for position, nodeid in enumerate(nodeids):
        units.setdefault(unit(nodeid), []).append(position)
    first = [name for name in _FIRST if name in units]
    rest = [name for name in units if name not in first]
    return [position for name in first + _mixed(rest) for position in units[name]]


def _mixed(names):
    # Single tests and files, spread evenly: each as far along as its share of its own kind.
    places = {}
    for is_test in (True, False):
        kind = [name for name in names if ('::' in name) == is_test]
        places.update((name, place / len(kind)) for place, name in enumerate(kind))
    return sorted(names, key=places.get)


class Schedule(LoadScopeScheduling):
    """Hands out units in the order in which the tests come."""

    def __init__(self, config, log=None):
        config.option.loadscopereorder = False
        super().__init__(config, log)

    def _split_scope(self, nodeid):
        return unit(nodeid)
