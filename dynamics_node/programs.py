"""
The programs of the package: each is loaded when it starts, and says in one line what it lacks.

A new program is a function here, a line in setup.py and one in docs/reference.md.

"""

import importlib
import sys

# Missing module → what to do, for people.
_REMEDIES = {
    'rclpy': (
        'ROS 2 was not found: source /opt/ros/<release>/setup.bash; the library and the model '
        'report need no ROS'
    ),
    'dynamics_interfaces': (
        'its messages are not built: ln -s dynamics_node/dynamics_interfaces in the src folder '
        'of the workspace, then colcon build and source install/setup.bash'
    ),
    'mujoco': "install what the demo needs: pip install 'dynamics_node[demo]'",
    'matplotlib': "install what the demo needs: pip install 'dynamics_node[demo]'",
    'rich': "install what reports need: pip install 'dynamics_node[report]'",
}


def _run(program: str, module: str) -> int:
    try:
        main = importlib.import_module(f'.{module}', __package__).main
        return main() or 0
    except ModuleNotFoundError as error:
        missing = (error.name or '').partition('.')[0]
        remedy = _REMEDIES.get(missing)
        if remedy is None:
            raise
        print(f"{program}: no module '{missing}': {remedy}", file=sys.stderr)
        return 1


def dynamics_node() -> int:
    """Run the node."""
    return _run('dynamics_node', 'ros.main')


def effort_guard() -> int:
    """Run the effort guard."""
    return _run('effort_guard', 'ros.effort_guard.main')


def markers() -> int:
    """Run the program that draws masses and torques in RViz."""
    return _run('markers', 'visualization.markers.__main__')


def simulated_robot() -> int:
    """Run the simulated robot."""
    return _run('simulated_robot', 'demo.simulated_robot')


def demo() -> int:
    """Run the demo."""
    return _run('demo', 'demo.__main__')


def report() -> int:
    """Run the model report."""
    return _run('report', 'report.__main__')
