"""What a refusal is about, without what is different in each: names, numbers, places."""

import re

_WORDS = 7


def first_words(text):
    """Return the first words of a message; names and numbers as an ellipsis."""
    text = re.sub(r"""'(\\.|[^'\\])*'|"(\\.|[^"\\])*"|<.*?>""", '…', text)
    text = re.sub(r'[-+]?[0-9][-+.0-9e]*', '…', text)
    return ' '.join(text.split()[:_WORDS])
