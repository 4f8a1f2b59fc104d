"""The digest of an error message: its first words without names and numbers."""

import re

_WORDS = 7


def error_digest(text):
    """Return the first words of a message, with an ellipsis for each name and number."""
    text = re.sub(r"""'(\\.|[^'\\])*'|"(\\.|[^"\\])*"|<.*?>""", '…', text)
    text = re.sub(r'[-+]?[0-9][-+.0-9e]*', '…', text)
    return ' '.join(text.split()[:_WORDS])
