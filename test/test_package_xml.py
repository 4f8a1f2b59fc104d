"""package.xml: what rosdep has to find."""

from pathlib import Path
import re

PACKAGE = (Path(__file__).parents[1] / 'package.xml').read_text()
# Keys of rosdistro's rosdep/python.yaml. One that is not there stops `rosdep install`.
KEYS = {
    'python3-numpy',
    'python3-numba',
    'python3-scipy',
    'python3-yourdfpy-pip',
    'python3-matplotlib',
    'python3-jinja2',
    'python3-rich',
    'python3-mujoco-pip',
    'python3-pytest',
    'python3-hypothesis',
}


def test_every_python_package_has_a_key_of_rosdep():
    assert set(re.findall(r'<\w*depend>(python3-[^<]+)<', PACKAGE)) <= KEYS
