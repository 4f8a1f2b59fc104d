"""Install the package where ament, colcon and `ros2 run` look for it; see also pyproject.toml."""

from pathlib import Path
import re
import sys

from setuptools import find_packages, setup

package_name = 'dynamics_node'
# `ros2 run dynamics_node NAME`; pip installs them for everything on PATH, as dynamics-NAME.
programs = ('dynamics_node', 'effort_guard', 'markers', 'simulated_robot', 'demo', 'report')
# colcon runs these commands; pip builds a wheel.
is_for_ros = bool({'develop', 'install'} & set(sys.argv))


def command(program):
    """Return the entry point of a program under the name that it has here."""
    name = program.replace('_', '-').removeprefix('dynamics-')
    return f'{program if is_for_ros else "dynamics-" + name} = dynamics_node.programs:{program}'


def version():
    """Return the version of the package, without importing it."""
    return re.search(r"__version__ = '(.+)'", Path(package_name, '__init__.py').read_text())[1]


def files(folder, pattern):
    """Return the files of a folder as setuptools wants them: relative paths as text."""
    return sorted(str(path) for path in Path(folder).glob(pattern))


distribution = setup(
    # Here too, because `colcon build --symlink-install` does not see pyproject.toml.
    name=package_name,
    version=version(),
    packages=find_packages(include=[package_name, f'{package_name}.*']),
    # The page of the model report is made of these: styles, scripts, templates.
    package_data={
        package_name: ['py.typed'],
        f'{package_name}.report.html': ['assets/*', 'templates/*'],
    },
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{package_name}']),
        (f'share/{package_name}', ['package.xml']),
        (f'share/{package_name}/launch', files('launch', '*.launch.py')),
        (
            f'share/{package_name}/config',
            files('config', '*.yaml') + files('config', '*.xml') + files('config', '*.rviz'),
        ),
        (
            f'share/{package_name}/config/robots',
            files('config/robots', '*.urdf') + files('config/robots', '*.yaml'),
        ),
    ],
    zip_safe=True,
    license='Apache-2.0',
    entry_points={'console_scripts': [command(program) for program in programs]},
)
# colcon reads the attributes back as Python literals, which a parsed version specifier is not.
for owner in (distribution, distribution.metadata):
    owner.python_requires = str(distribution.python_requires)
