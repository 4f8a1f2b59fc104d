"""Robots for the tests: those of this repository, public ones, and random trees."""

from importlib.metadata import distribution
from pathlib import Path

import numpy as np

ROBOTS = Path(__file__).parents[2] / 'config' / 'robots'
PENDULUM = ROBOTS / 'pendulum.urdf'
ARM7 = ROBOTS / 'arm7.urdf'
HOLD = 0.5 * 3 * 0.7 * 9.81  # gravity torque of the pendulum at 0, level, N m


def public_robots():
    """Return the names of all URDFs of example-robot-data: their paths there, sorted."""
    folder = _public_folder()
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob('*.urdf'))


def public_robot(name):
    """Return the path of a public robot's URDF, by its name in `public_robots`."""
    return _public_folder() / name


def _public_folder():
    package = distribution('example-robot-data')
    return Path(package.locate_file('cmeel.prefix/share/example-robot-data/robots'))


def random_urdf(seed, joints=None, with_mimic=True, mass_scale=1.0, prismatic=0.3):
    """
    Return a random branching robot as URDF text.

    It has revolute, continuous and prismatic joints about arbitrary axes, fixed links in the
    middle, at the tips and at the root, links without inertial, inertials with rpy, and mimic
    joints (one of them mimics a mimic joint, if there are enough).

    """
    rng = np.random.default_rng(seed)
    joints = int(rng.integers(2, 9)) if joints is None else joints
    elements = [
        _link('base', rng, mass_scale),
        _link('stand', rng, mass_scale),
        _joint('mount', 'fixed', 'base', 'stand', rng),
    ]
    carriers = ['stand']
    independent, mimics = [], []
    for i in range(joints):
        parent = carriers[int(rng.integers(max(0, len(carriers) - 3), len(carriers)))]
        kind = (
            'prismatic'
            if rng.random() < prismatic
            else ('revolute', 'continuous')[int(rng.integers(2))]
        )
        mimic = ''
        if with_mimic and len(independent) >= 2 and rng.random() < 0.25:
            leader = (mimics or independent)[-1] if rng.random() < 0.5 else independent[0]
            mimic = (
                f'<mimic joint="{leader}" multiplier="{rng.normal():.17g}" '
                f'offset="{rng.normal() * 0.2:.17g}"/>'
            )
            mimics.append(f'joint{i}')
        else:
            independent.append(f'joint{i}')
        elements.append(_link(f'link{i}', rng, mass_scale))
        elements.append(_joint(f'joint{i}', kind, parent, f'link{i}', rng, mimic))
        carriers.append(f'link{i}')
        if rng.random() < 0.4:
            elements.append(_link(f'tool{i}', rng, mass_scale, rng.random() < 0.7))
            elements.append(_joint(f'fixed{i}', 'fixed', f'link{i}', f'tool{i}', rng))
            carriers.append(f'tool{i}')
    # Links and joints in random order, which URDF allows.
    rng.shuffle(elements)
    return '<robot name="random">\n' + '\n'.join(elements) + '\n</robot>'


def random_state(rng, model):
    """Return q and qd of a model: shape (n,) each."""
    count = len(model.joint_names)
    return rng.uniform(-2.0, 2.0, count), rng.normal(0.0, 1.5, count)


def _numbers(values):
    return ' '.join(f'{value:.17g}' for value in values)


def _origin(rng):
    return (
        f'<origin xyz="{_numbers(rng.normal(0.0, 0.3, 3))}" '
        f'rpy="{_numbers(rng.uniform(-3.0, 3.0, 3))}"/>'
    )


def _link(name, rng, mass_scale, with_inertial=True):
    if not with_inertial:
        return f'<link name="{name}"/>'
    mass = rng.uniform(0.1, 5.0) * mass_scale
    # Second moments about planes are positive: the tensor is physically possible.
    planes = mass * rng.uniform(0.001, 0.02, 3)
    about_axes = planes.sum() - planes
    rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    tensor = rotation @ np.diag(about_axes) @ rotation.T
    tensor = 0.5 * (tensor + tensor.T)
    entries = ' '.join(
        f'{key}="{tensor[i, j]:.17g}"'
        for key, i, j in (
            ('ixx', 0, 0),
            ('ixy', 0, 1),
            ('ixz', 0, 2),
            ('iyy', 1, 1),
            ('iyz', 1, 2),
            ('izz', 2, 2),
        )
    )
    return (
        f'<link name="{name}"><inertial>{_origin(rng)}<mass value="{mass:.17g}"/>'
        f'<inertia {entries}/></inertial></link>'
    )


def _joint(name, kind, parent, child, rng, mimic=''):
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    # Drawn for all joints: a change of one property leaves all other numbers unchanged.
    axis_text = '' if kind == 'fixed' else f'<axis xyz="{_numbers(axis)}"/>'
    limit = '' if kind == 'fixed' else '<limit lower="-3" upper="3" effort="90" velocity="3"/>'
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/>'
        f'<child link="{child}"/>{_origin(rng)}{axis_text}{limit}{mimic}</joint>'
    )
