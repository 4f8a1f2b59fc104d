"""The tables of links, as they stand in the URDF, and of bodies, as joints move them."""

from .escape import span, text
from .table import amount, Cell, Column, name, table, words
from ..formatting import MISSING, vector


def links_table(links):
    """
    Return the table of all links.

    Parameters
    ----------
    links : sequence of LinkEntry

    Returns
    -------
    str
        Markup.

    """
    columns = (
        Column('link'),
        Column('mass', 'kg', True),
        Column('centre of mass', 'm', True),
        Column('principal moments', 'kg m²', True),
        Column('can exist'),
        Column('moved by'),
    )
    return table('links', columns, [_link(link) for link in links])


def bodies_table(bodies):
    """
    Return the table of what each joint moves as one piece.

    Parameters
    ----------
    bodies : sequence of BodyEntry

    Returns
    -------
    str
        Markup.

    """
    columns = (
        Column('joint'),
        Column('link it moves'),
        Column('fixed to it'),
        Column('mass', 'kg', True),
        Column('centre of mass', 'm', True),
        Column('principal moments', 'kg m²', True),
        Column('can exist'),
    )
    return table('bodies', columns, [_body(body) for body in bodies])


def _link(link):
    mass = amount(link.mass)
    if not link.has_inertial:
        mass = Cell(
            text('0, no <inertial>') if link.has_shape else '0',
            0.0,
            'doubt' if link.has_shape and link.carrier else 'missing',
        )
    return (
        name(link.name),
        mass,
        _vector(link.com),
        _vector(link.principal_moments),
        _exists(link.is_physical, link.has_inertial, link.violations),
        words('stands on the base', 'missing') if link.carrier is None else name(link.carrier),
    )


def _body(body):
    lumped = ', '.join(span(link) for link in body.lumped)
    return (
        name(body.joint),
        name(body.link),
        Cell(lumped or MISSING, tone='' if lumped else 'missing'),
        amount(body.mass, tone='' if body.mass > 0.0 else 'doubt'),
        _vector(body.com),
        _vector(body.principal_moments),
        _exists(body.is_physical, body.mass > 0.0),
    )


def _vector(values):
    return Cell(text(vector(values, 3)), tone='missing' if values is None else '')


def _exists(is_physical, has_mass, violations=()):
    if violations:
        return words('no: ' + '; '.join(violations), 'bad')
    if not is_physical:
        return words('no', 'bad')
    return words('yes', 'fine') if has_mass else words('no mass', 'missing')
