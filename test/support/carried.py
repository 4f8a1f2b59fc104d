"""A payload as the judges see it: one more link in the URDF's text, on a fixed joint."""


def with_payload_link(text, link, mass, com, inertia):
    """
    Return URDF text in which a link carries one more.

    Parameters
    ----------
    text : str
    link : str
    mass : float
        kg.
    com : sequence of float
        In the link's frame, m.
    inertia : numpy.ndarray, shape (3, 3)
        About the centre of mass, kg m².

    Returns
    -------
    str

    """
    tensor = ' '.join(f'i{row}{column}="{inertia[i][j]:.17g}"'
                      for i, row in enumerate('xyz') for j, column in enumerate('xyz') if i <= j)
    place = ' '.join(f'{value:.17g}' for value in com)
    end = text.rindex('</robot>')
    return (f'{text[:end]}<link name="carried"><inertial><origin xyz="{place}"/>'
            f'<mass value="{mass:.17g}"/><inertia {tensor}/></inertial></link>'
            f'<joint name="carries" type="fixed"><parent link="{link}"/><child link="carried"/>'
            '</joint></robot>')
