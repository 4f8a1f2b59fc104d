"""For all tests: hypothesis draws the same examples in CI, and new ones by hand."""

import os

from hypothesis import settings

settings.register_profile('ci', derandomize=True)
# More examples by hand: HYPOTHESIS_EXAMPLES=5000 make test ARGS=test/dynamics
if 'HYPOTHESIS_EXAMPLES' in os.environ:
    settings.register_profile('many', max_examples=int(os.environ['HYPOTHESIS_EXAMPLES']))
settings.load_profile('ci' if os.environ.get('CI') else
                      'many' if 'HYPOTHESIS_EXAMPLES' in os.environ else 'default')
