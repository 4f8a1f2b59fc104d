"""package.xml: keys that rosdep finds."""

from pathlib import Path
import re

import pytest

ROOT = Path(__file__).parents[1]
# Keys of rosdep/python.yaml in https://github.com/ros/rosdistro. rosdep stops at an unknown one:
# python3-plotly does not exist, so the report says what to install for --html.
PYTHON_KEYS = {
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
# Packages released in jazzy/distribution.yaml and kilted/distribution.yaml of the same repository.
ROS_PACKAGES = {
    'ament_cmake',
    'ament_index_python',
    'builtin_interfaces',
    'diagnostic_msgs',
    'geometry_msgs',
    'launch',
    'launch_ros',
    'rcl_interfaces',
    'rclpy',
    'rosidl_default_generators',
    'rosidl_default_runtime',
    'sensor_msgs',
    'service_msgs',
    'std_msgs',
    'std_srvs',
    'trajectory_msgs',
    'visualization_msgs',
}
OWN_PACKAGES = {'dynamics_interfaces'}


@pytest.mark.parametrize(
    'folder', [ROOT, ROOT / 'dynamics_interfaces'], ids=lambda path: path.name
)
def test_rosdep_finds_every_key(folder):
    keys = set(re.findall(r'<\w*depend>([^<]+)<', (folder / 'package.xml').read_text()))
    assert keys and keys <= PYTHON_KEYS | ROS_PACKAGES | OWN_PACKAGES
