"""For tests of a robot's own machine code, which Python 3.10 cannot call."""

from dynamics_node.codegen import is_supported
import pytest

needs_machine_code = pytest.mark.skipif(
    not is_supported(), reason='machine code of robots needs CPython 3.11 or later'
)
