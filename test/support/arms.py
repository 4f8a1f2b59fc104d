"""Arms for the report: correct ones, and changes of them."""

import math
from xml.etree import ElementTree

G = 9.81


def arm(
    masses=(3.0, 2.5, 2.0, 1.2, 0.8),
    lengths=(0.3, 0.3, 0.25, 0.2, 0.15),
    *,
    tool=True,
    axes=('0 0 1', '0 1 0', '0 1 0', '0 1 0', '1 0 0'),
    limits=(-2.5, 2.5),
    effort=300,
    visual=True,
    name='arm',
):
    """
    Return a serial arm as URDF text: links 'base', 'link1'... along x, joints 'joint1'...

    Each link is a homogeneous rod of its length, 6 cm thick, with its center of mass in the
    middle; 'gripper' of 0.7 kg is fixed to the last one.

    """
    shape = '<visual><geometry><box size="1 1 1"/></geometry></visual>' if visual else ''
    parts = [f'<link name="base">{shape}{rod(4.0, 0.2)}</link>']
    before = 0.1
    for i, (mass, length) in enumerate(zip(masses, lengths, strict=True), start=1):
        parent = 'base' if i == 1 else f'link{i - 1}'
        parts.append(f'<link name="link{i}">{shape}{rod(mass, length)}</link>')
        parts.append(
            f'<joint name="joint{i}" type="revolute"><parent link="{parent}"/>'
            f'<child link="link{i}"/><origin xyz="{before} 0 0"/><axis xyz="{axes[i - 1]}"/>'
            f'<limit lower="{limits[0]}" upper="{limits[1]}" effort="{effort}" velocity="2"/>'
            '</joint>'
        )
        before = length
    if tool:
        parts.append(f'<link name="gripper">{shape}{rod(0.7, 0.1)}</link>')
        parts.append(
            f'<joint name="mount" type="fixed"><parent link="link{len(masses)}"/>'
            f'<child link="gripper"/><origin xyz="{before} 0 0"/></joint>'
        )
    return f'<robot name="{name}">' + ''.join(parts) + '</robot>'


def rod(mass, length, thickness=0.06):
    """Return the <inertial> of a homogeneous box along x."""
    along, across = mass * thickness**2 / 6.0, mass * (length**2 + thickness**2) / 12.0
    return (
        f'<inertial><origin xyz="{length / 2.0!r} 0 0"/><mass value="{mass!r}"/>'
        f'<inertia ixx="{along!r}" ixy="0" ixz="0" iyy="{across!r}" iyz="0" '
        f'izz="{across!r}"/></inertial>'
    )


def changed(
    text,
    name,
    *,
    inertial=True,
    mass=None,
    com=None,
    tensor=None,
    shape=True,
    axis=True,
    limit=None,
    kind=None,
):
    """
    Return URDF text with a changed link or joint.

    inertial, shape, axis: False removes it. tensor: dict of entries, or one number for the
    diagonal. limit: dict of attributes; None removes one.

    """
    robot = ElementTree.fromstring(text)
    element = next(part for part in robot if part.get('name') == name)
    own = element.find('inertial')
    if mass is not None:
        own.find('mass').set('value', repr(mass))
    if com is not None:
        origin = own.find('origin')
        if origin is None:
            origin = ElementTree.SubElement(own, 'origin')
        origin.set('xyz', ' '.join(map(repr, com)))
    if tensor is not None:
        if not isinstance(tensor, dict):
            tensor = {
                key: tensor if key in ('ixx', 'iyy', 'izz') else 0.0
                for key in ('ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz')
            }
        for key, value in tensor.items():
            own.find('inertia').set(key, repr(value))
    if not inertial and own is not None:
        element.remove(own)
    if not shape:
        for tag in ('visual', 'collision'):
            for part in element.findall(tag):
                element.remove(part)
    if not axis:
        element.remove(element.find('axis'))
    for key, value in (limit or {}).items():
        element.find('limit').attrib.pop(key, None)
        if value is not None:
            element.find('limit').set(key, str(value))
    if kind is not None:
        element.set('type', kind)
    return ElementTree.tostring(robot, encoding='unicode')


def scaled_tensor(text, name, factor):
    """Return URDF text with the tensor of a link times a factor."""
    robot = ElementTree.fromstring(text)
    inertia = robot.find(f"link[@name='{name}']/inertial/inertia")
    return changed(
        text, name, tensor={key: factor * float(value) for key, value in inertia.attrib.items()}
    )


def pendulum(mass=2.0, com=0.4, lower=-math.pi, upper=math.pi, effort=20.0):
    """Return a point mass on one horizontal joint; angle 0 is along x, so G = m g r cos q."""
    return (
        f'<robot name="pendulum"><link name="base"/><link name="rod"><inertial>'
        f'<origin xyz="{com} 0 0"/><mass value="{mass}"/><inertia ixx="0.01" ixy="0" ixz="0" '
        'iyy="0.01" iyz="0" izz="0.01"/></inertial></link><joint name="swing" '
        'type="revolute"><parent link="base"/><child link="rod"/><axis xyz="0 -1 0"/>'
        f'<limit lower="{lower}" upper="{upper}" effort="{effort}" velocity="1"/></joint>'
        '</robot>'
    )
