"""For all tests: what hypothesis draws, what they have for themselves, and who runs what."""

import os

from hypothesis import HealthCheck, settings
import pytest
from support.domains import claim

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
