"""
The programs of the package: each is loaded when it starts, and says in one line what it lacks.

A new program is a function here, a line in setup.py and one in docs/reference.md.

"""

import importlib
import importlib.util
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


_ROS = ('rclpy',)
_NODE = (*_ROS, 'dynamics_interfaces.msg')


def _run(program: str, module: str, needs: tuple[str, ...] = ()) -> int:
    # First, because each program reports an import that fails later in its own way.
    missing = next((name for name in needs if not _is_installed(name)), None)
    if missing is not None:
        return _refuse(program, missing)
    try:
        main = importlib.import_module(f'.{module}', __package__).main
        return main() or 0
    except ModuleNotFoundError as error:
        if _package(error.name or '') not in _REMEDIES:
            raise
        return _refuse(program, error.name or '')


def _is_installed(module: str) -> bool:
    try:
        spec = importlib.util.find_spec(module)
    except ModuleNotFoundError:
        return False
    # Without a file: the sources of the messages, found from the folder of the checkout.
    return spec is not None and spec.origin is not None


def _refuse(program: str, missing: str) -> int:
    package = _package(missing)
    print(f"{program}: no module '{package}': {_REMEDIES[package]}", file=sys.stderr)
    return 1


def _package(module: str) -> str:
    return module.partition('.')[0]


def dynamics_node() -> int:
    """Run the node."""
    return _run('dynamics_node', 'ros.main', _NODE)


def effort_guard() -> int:
    """Run the effort guard."""
    return _run('effort_guard', 'ros.effort_guard.main', _NODE)


def markers() -> int:
    """Run the program that draws masses and torques in RViz."""
    return _run('markers', 'visualization.markers.__main__', _ROS)


def simulated_robot() -> int:
    """Run the simulated robot."""
    return _run('simulated_robot', 'demo.simulated_robot', _ROS)


def demo() -> int:
    """Run the demo."""
    return _run('demo', 'demo.__main__', _NODE)


def report() -> int:
    """Run the model report."""
    return _run('report', 'report.__main__')
