"""
Identified values into the text of a URDF.

Only <inertial> of the given links and <dynamics> of the given joints change; every other byte
stays: comments, indentation, order, line breaks.

"""

from collections.abc import Iterable, Mapping, Sequence
import math
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from .xml_text import Element, parse_places, TextEdits
from ..errors import ArgumentError, quoted, suggestion
from ..inertia import inertia_tensor_at_com, mass_and_com
from ..inertia.pseudo_inertia import rotation_from_rpy, symmetric
from ..urdf import examine_urdf, read_urdf

Array = NDArray[np.float64]

# Attribute of <inertia> → row and column of the tensor.
_ENTRIES = {
    'ixx': (0, 0),
    'ixy': (0, 1),
    'ixz': (0, 2),
    'iyy': (1, 1),
    'iyz': (1, 2),
    'izz': (2, 2),
}
# Largest difference by rounding, relative to the size of J: such a number stays as it is written.
_ROUNDING = 16.0 * np.finfo(float).eps


def write_urdf(
    text: str | bytes,
    inertia: Mapping[str, Array],
    friction: Mapping[str, tuple[float, float]] = MappingProxyType({}),
) -> str:
    """
    Return URDF text with other inertias of links and other friction of joints.

    A number that does not change stays as it is written. The inertial frame keeps its rotation:
    the tensor is written in its axes. A missing element is inserted with the indentation around
    it. Read again, the text gives the same J to rounding.

    Parameters
    ----------
    text : str or bytes
        URDF text, UTF-8.
    inertia : mapping of str to numpy.ndarray, shape (4, 4)
        Link → pseudo-inertia J of that link alone, without links that are fixed to it, about
        the link frame's origin: kg m², kg m, kg.
    friction : mapping of str to (float, float)
        Joint → damping (N m s/rad or N s/m) and friction (N m or N) of that joint alone, >= 0.

    Returns
    -------
    str

    Raises
    ------
    RobotDescriptionError
        If the text is not a URDF, or not one that `read_urdf` accepts after the change: also if
        a J has a negative mass, or a tensor of no body.
    ArgumentError
        If a link or joint is missing in the text, or a value has the wrong shape or range.

    References
    ----------
    docs/mathematics.md, equations (2) to (5).

    """
    content = text.encode('utf-8', errors='surrogatepass') if isinstance(text, str) else text
    # Refuses what is not safe to parse: size, document type, encoding.
    examine_urdf(content)
    robot = parse_places(content)
    edits = TextEdits(content)
    links, joints = _named(robot, 'link'), _named(robot, 'joint')
    _check_names('link', inertia, links)
    _check_names('joint', friction, joints)
    for name, matrix in inertia.items():
        _write_inertial(edits, links[name], _checked_inertia(name, matrix))
    for name, values in friction.items():
        _write_friction(edits, joints[name], _checked_friction(name, values))
    result = edits.apply()
    read_urdf(result)
    return result.decode()


def _named(robot: Element, tag: str) -> dict[str | None, Element]:
    return {child.values.get('name'): child for child in robot.children if child.tag == tag}


def _check_names(tag: str, given: Iterable[str], known: Mapping[str | None, Element]) -> None:
    names = [name for name in known if name is not None]
    missing = [name for name in given if name not in known]
    if missing:
        raise ArgumentError(
            f'expected {tag}s of the URDF, got '
            + ', '.join(quoted(name) + suggestion(name, names) for name in missing)
        )


def _checked_inertia(name: str, matrix: Array) -> Array:
    matrix = np.asarray(matrix, dtype=float)
    if matrix.shape != (4, 4) or not np.isfinite(matrix).all():
        raise ArgumentError(
            f'link {quoted(name)}: expected a pseudo-inertia of shape (4, 4), finite, '
            f'got {matrix.tolist()}'
        )
    if np.abs(matrix - matrix.T).max() > _ROUNDING * np.abs(matrix).max():
        raise ArgumentError(
            f'link {quoted(name)}: expected a symmetric pseudo-inertia, got one that differs '
            f'from its transpose by {np.abs(matrix - matrix.T).max():.3g}'
        )
    return symmetric(matrix)


def _checked_friction(name: str, values: tuple[float, float]) -> tuple[float, float]:
    numbers = np.asarray(values, dtype=float)
    if numbers.shape != (2,) or not np.isfinite(numbers).all() or (numbers < 0.0).any():
        raise ArgumentError(
            f'joint {quoted(name)}: expected damping and friction, finite and >= 0, got {values}'
        )
    return float(numbers[0]), float(numbers[1])


# --------------------------------------------------------------------------- inertial of a link


def _write_inertial(edits: TextEdits, link: Element, matrix: Array) -> None:
    inertial = link.find('inertial')
    if inertial is None:
        if matrix.any():
            lines = ['<inertial>', *('  ' + line for line in _new_parts(matrix)), '</inertial>']
            edits.insert_first(link, lines)
        return
    if not inertial.children:
        edits.insert_first(inertial, _new_parts(matrix))
        return
    origin = inertial.find('origin')
    mass, com = mass_and_com(matrix)
    if mass != 0.0:  # without mass there is no center of mass
        _write_origin(edits, inertial, origin, com)
    if (element := inertial.find('mass')) is not None:
        _write_numbers(edits, element, 'value', [mass], _ROUNDING * abs(mass))
    if (element := inertial.find('inertia')) is not None:
        rotation = rotation_from_rpy(_numbers(origin, 'rpy', 3))
        tensor = symmetric(rotation.T @ inertia_tensor_at_com(matrix) @ rotation)
        # Its rounding is that of the tensor about the frame's origin.
        tolerance = _ROUNDING * float(np.trace(matrix[:3, :3]))
        for name, place in _ENTRIES.items():
            _write_numbers(edits, element, name, [tensor[place]], tolerance)


def _write_origin(edits: TextEdits, inertial: Element, origin: Element | None, com: Array) -> None:
    tolerance = _ROUNDING * float(np.abs(com).max())
    if origin is not None:
        _write_numbers(edits, origin, 'xyz', com.tolist(), tolerance, missing=0.0)
    elif com.any():
        edits.insert_first(inertial, [_new_origin(com)])


def _new_parts(matrix: Array) -> list[str]:
    mass, com = mass_and_com(matrix)
    tensor = inertia_tensor_at_com(matrix)
    entries = ' '.join(f'{name}="{_text(tensor[place])}"' for name, place in _ENTRIES.items())
    return [_new_origin(com), f'<mass value="{_text(mass)}"/>', f'<inertia {entries}/>']


def _new_origin(com: Array) -> str:
    return f'<origin xyz="{" ".join(map(_text, com))}" rpy="0 0 0"/>'


# -------------------------------------------------------------------------- dynamics of a joint


def _write_friction(edits: TextEdits, joint: Element, values: tuple[float, float]) -> None:
    names = ('damping', 'friction')
    element = joint.find('dynamics')
    if element is not None:
        for name, value in zip(names, values, strict=True):
            _write_numbers(edits, element, name, [value], _ROUNDING * value, missing=0.0)
    elif any(values):
        damping, friction = map(_text, values)
        edits.insert_last(joint, [f'<dynamics damping="{damping}" friction="{friction}"/>'])


# -------------------------------------------------------------------------------------- numbers


def _write_numbers(
    edits: TextEdits,
    element: Element,
    name: str,
    values: Sequence[float],
    tolerance: float,
    missing: float = math.nan,
) -> None:
    # Only the numbers that differ; `missing` is the value of an attribute that is not written.
    before = _numbers(element, name, len(values), missing)
    # A number that cannot be read is NaN, and differs.
    is_equal = [abs(value - old) <= tolerance for value, old in zip(values, before, strict=True)]
    if all(is_equal):
        return
    if edits.is_plain(element, name) and np.isfinite(before).all():
        words = [
            None if equal else _text(value) for value, equal in zip(values, is_equal, strict=True)
        ]
        edits.replace_words(element, name, words)
    else:
        edits.set_value(element, name, ' '.join(map(_text, values)))


def _numbers(element: Element | None, name: str, count: int, missing: float = 0.0) -> Array:
    # NaN where the attribute does not have that many numbers.
    if element is None or name not in element.values:
        return np.full(count, missing)
    try:
        numbers = np.array([float(word) for word in element.values[name].split()])
    except ValueError:
        return np.full(count, math.nan)
    return numbers if len(numbers) == count else np.full(count, math.nan)


def _text(value: float) -> str:
    # The shortest decimal number that is read as the same double; never -0.0.
    return repr(float(value) + 0.0)
