"""Install the package where ament, colcon and `ros2 run` look for it."""

from pathlib import Path

from setuptools import find_packages, setup

package_name = 'dynamics_node'


def files(folder, pattern):
    """Return the files of a folder as setuptools wants them: relative paths as text."""
    return sorted(str(path) for path in Path(folder).glob(pattern))


setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(include=[package_name, f'{package_name}.*']),
    # What the page of the model report is made of: styles, scripts, parts of its markup.
    package_data={package_name: ['py.typed'], f'{package_name}.report.html': ['assets/*']},
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
    install_requires=['setuptools', 'numpy', 'numba', 'llvmlite', 'scipy', 'yourdfpy'],
    extras_require={
        'demo': ['mujoco', 'matplotlib', 'rich'],
        'report': ['rich', 'plotly'],
        'test': ['pytest', 'pytest-xdist', 'hypothesis', 'pin', 'mujoco', 'example-robot-data'],
    },
    python_requires='>=3.10',
    zip_safe=True,
    maintainer='dynamics_node maintainers',
    maintainer_email='maintainers@users.noreply.h-seed-ba9bdbfb.example',
    description='Mass matrix, Coriolis matrix and gravity torque of a robot from its URDF',
    license='Apache-2.0',
    entry_points={
        'console_scripts': [
            'dynamics_node = dynamics_node.ros.main:main',
            'effort_guard = dynamics_node.ros.effort_guard.main:main',
            'simulated_robot = dynamics_node.demo.simulated_robot:main',
            'demo = dynamics_node.demo.__main__:main',
            'report = dynamics_node.report.__main__:main',
            'markers = dynamics_node.visualization.markers.__main__:main',
        ]
    },
)
