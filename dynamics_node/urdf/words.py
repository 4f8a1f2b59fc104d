"""How a text from outside is shown in a message: short, in quotes, on one line."""

_SHOWN = 60


def quoted(text):
    """
    Return a text as it may stand in an error message or a log.

    Parameters
    ----------
    text : str or None

    Returns
    -------
    str
        In quotes; line breaks and what cannot be printed as escapes, shortened if it is long.

    """
    text = str(text)
    return repr(text if len(text) <= _SHOWN else text[:_SHOWN - 3] + '...')
