"""For all tests: hypothesis draws the same examples in CI, and new ones by hand."""

import os

from hypothesis import settings

# The same examples in every run: CI=1 make test. More of them, or fewer:
# HYPOTHESIS_EXAMPLES=5000 make test ARGS=test/dynamics
settings.register_profile(
    'here', derandomize=bool(os.environ.get('CI')),
    max_examples=int(os.environ.get('HYPOTHESIS_EXAMPLES', settings.default.max_examples)))
settings.load_profile('here')
