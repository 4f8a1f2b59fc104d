"""Deliberately ill-conditioned robots, as URDF text."""

import numpy as np

from .robots import ARM7, PENDULUM

FEATHER, ANVIL = 1e-6, 100.0


def extreme_robots():
    """Return a dict: description of a robot → its URDF text."""
    light_first = [FEATHER, ANVIL] * 4
    return {
        '8 turning links, 1e-6 kg and 100 kg in turn': chain(light_first),
        '8 turning links, 100 kg and 1e-6 kg in turn': chain(light_first[::-1]),
        '4 links of 1e-6 kg on 4 links of 100 kg': chain([ANVIL] * 4 + [FEATHER] * 4),
        '4 links of 100 kg on 4 links of 1e-6 kg': chain([FEATHER] * 4 + [ANVIL] * 4),
        '8 sliding links, 1e-6 kg and 100 kg in turn': chain(light_first, 'prismatic'),
        '12 sliding links of 1 kg': chain([1.0] * 12, 'prismatic'),
        'sliding and turning in turn, 1e-6 kg and 100 kg': chain(light_first, 'mixed'),
        'arm7, its base 1 km away': far_base(ARM7.read_text(), 1e3),
        'arm7, its base 1000 km away': far_base(ARM7.read_text(), 1e6),
        'pendulum, its base 1000 km away': far_base(PENDULUM.read_text(), 1e6),
        'arm7 on a rail, 1 km along it': on_a_rail(ARM7.read_text(), 1e3),
        'arm7 at the end of a turning boom of 1 km': on_a_boom(ARM7.read_text(), 1e3),
        '1e-6 kg at the end of a turning boom of 10 km': on_a_boom(chain([FEATHER] * 2), 1e4),
        '60 turning links of 1 kg': chain([1.0] * 60),
        'links of 1 mm and 1e-6 kg': chain([FEATHER] * 6, length=1e-3),
        'links of 100 m and 1e6 kg': chain([1e6] * 6, length=100.0),
    }


def chain(masses, kind='continuous', length=0.3):
    """Return a chain of solid bodies about a third as thick as long, joined across."""
    rng = np.random.default_rng(len(masses))
    parts = ['<robot name="chain"><link name="link0"/>']
    for i, mass in enumerate(masses):
        # Second moments about planes: those of a possible, asymmetric body.
        planes = mass * length**2 * np.array([0.08, 0.01, 0.012])
        tensor = planes.sum() - planes
        turn, axis = rng.uniform(-3.0, 3.0, 3), rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        joint = {'mixed': ('prismatic', 'continuous')[i % 2]}.get(kind, kind)
        parts.append(
            f'<link name="link{i + 1}"><inertial><origin xyz="{0.45 * length} {0.1 * length} '
            f'{-0.05 * length}" rpy="0.1 0.2 0.3"/><mass value="{mass}"/><inertia '
            f'ixx="{tensor[0]}" ixy="0" ixz="0" iyy="{tensor[1]}" iyz="0" izz="{tensor[2]}"/>'
            f'</inertial></link><joint name="joint{i + 1}" type="{joint}"><parent '
            f'link="link{i}"/><child link="link{i + 1}"/><origin xyz="{length if i else 0.0} 0 0" '
            f'rpy="{turn[0]} {turn[1]} {turn[2]}"/><axis xyz="{axis[0]} {axis[1]} {axis[2]}"/>'
            '<limit lower="-5" upper="5" effort="1" velocity="1"/></joint>'
        )
    return ''.join(parts) + '</robot>'


def far_base(text, distance):
    """Return a robot whose root link stands far from the origin of a new root."""
    return _carried(text, 'fixed', distance)


def on_a_rail(text, distance):
    """Return a robot on a cart of 100 kg; the rail's zero is far behind it."""
    return _carried(text, 'prismatic', distance, _CART)


def on_a_boom(text, distance):
    """Return a robot at the far end of a boom that turns, without mass of its own."""
    # The boom turns about the origin: the joint stands there and the robot far along its arm.
    return _carried(
        _carried(text, 'fixed', distance, root='boom'), 'continuous', 0.0, inner='boom'
    )


_CART = (
    '<inertial><mass value="100"/><inertia ixx="5" ixy="0" ixz="0" iyy="6" iyz="0" '
    'izz="7"/></inertial>'
)


def _carried(text, kind, distance, inertial='', root='ground', inner=None):
    # Without a cart the joint carries the robot's root link.
    inner = inner or _root(text)
    cart, weld = inner, ''
    if inertial:
        cart = 'cart'
        weld = (
            f'<link name="cart">{inertial}</link><joint name="weld" type="fixed"><parent '
            f'link="cart"/><child link="{inner}"/></joint>'
        )
    return text.replace(
        '</robot>',
        (
            f'<link name="{root}"/>{weld}<joint name="carrier_of_{inner}" type="{kind}"><parent '
            f'link="{root}"/><child link="{cart}"/><origin xyz="{distance} {-0.7 * distance} '
            f'{0.3 * distance}" rpy="0.4 -0.5 0.6"/><axis xyz="0 0.6 0.8"/><limit lower="-5" '
            'upper="5" effort="1" velocity="1"/></joint></robot>'
        ),
    )


def _root(text):
    from xml.etree import ElementTree

    robot = ElementTree.fromstring(text.encode())
    children = {joint.find('child').get('link') for joint in robot.findall('joint')}
    return next(
        link.get('name') for link in robot.findall('link') if link.get('name') not in children
    )
