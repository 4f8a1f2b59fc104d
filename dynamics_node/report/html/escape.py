"""
Words of a robot description on a page: nothing in them is ever markup.

A URDF may come from anybody, and a name in it may be `</script><script>alert(1)</script>`. So
every text goes through one of these functions on its way to the page, each for one place.

"""

import html
import json


def text(value):
    """
    Return a text as the content of an element or an attribute in double quotes.

    Parameters
    ----------
    value : object
        Whatever `str` makes of it.

    Returns
    -------
    str

    """
    return html.escape(str(value), quote=True)


def span(value):
    """
    Return a name from the URDF as markup; a line may end after an underscore or a slash.

    Parameters
    ----------
    value : object
        Whatever `str` makes of it.

    Returns
    -------
    str

    """
    # No entity has one of these in it.
    breakable = text(value).replace('_', '_<wbr>').replace('/', '/<wbr>')
    return f'<span class="name">{breakable}</span>'


def plot_text(value):
    """
    Return a text as plotly shows it literally.

    plotly understands some tags in every text that it draws, and templates such as `%{x}` in
    some. The braces keep a template from being one: entities are decoded later than templates.

    Parameters
    ----------
    value : object
        Whatever `str` makes of it.

    Returns
    -------
    str

    """
    return html.escape(str(value), quote=False).replace('{', '&#123;').replace('}', '&#125;')


def script_data(value):
    """
    Return data as JSON that may stand inside a script element.

    Parameters
    ----------
    value : dict, list, str, float, int, bool or None
        Without NaN and infinity, which JSON does not have.

    Returns
    -------
    str

    Raises
    ------
    ValueError
        If a number is not finite.

    """
    data = json.dumps(value, allow_nan=False, separators=(',', ':'))
    # json leaves nothing but ASCII; these three could end the element or begin a comment in it.
    for character in '<>&':
        data = data.replace(character, f'\\u{ord(character):04x}')
    return data
