"""For all tests: which examples hypothesis draws, and a cache of machine code of their own."""

import os

from hypothesis import settings
import pytest

# The same examples in every run: CI=1 make test. More of them, or fewer:
# HYPOTHESIS_EXAMPLES=5000 make test ARGS=test/dynamics
settings.register_profile(
    'here', derandomize=bool(os.environ.get('CI')),
    max_examples=int(os.environ.get('HYPOTHESIS_EXAMPLES', settings.default.max_examples)))
settings.load_profile('here')


@pytest.fixture(scope='session', autouse=True)
def machine_code_folder(tmp_path_factory):
    # Processes that tests start find it too.
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv('DYNAMICS_NODE_CACHE_DIR', str(tmp_path_factory.mktemp('machine_code')))
        yield
