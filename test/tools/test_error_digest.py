"""Refusals about the same thing read the same."""

from fuzz.error_digest import first_words


def test_names_and_numbers_are_left_out():
    assert first_words("link 'a b': <mass> value: expected a finite number, got '1e999'") == (
        'link …: … value: expected a finite'
    )
    assert first_words('link "it\'s": mass is -2.5 kg, must be >= 0') == (
        'link …: mass is … kg, must'
    )
    assert first_words(r"link 'a\'b' is defined 2 times") == 'link … is defined … times'
