"""Digests of error messages."""

from fuzz.error_digest import error_digest


def test_names_and_numbers_are_left_out():
    assert error_digest("link 'a b': <mass> value: expected a finite number, got '1e999'") == (
        'link …: … value: expected a finite'
    )
    assert error_digest('link "it\'s": mass is -2.5 kg, must be >= 0') == (
        'link …: mass is … kg, must'
    )
    assert error_digest(r"link 'a\'b' is defined 2 times") == 'link … is defined … times'
