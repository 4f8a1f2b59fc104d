"""What the arm can carry, and the conditioning of D, on the page."""

from dynamics_node.report.formatting import count, number, quantity
from support.page_reader import plain, reading
from support.report_pages import arm7_report, unlimited_report


def test_the_payload_is_that_of_the_report():
    payload, words = arm7_report().payload, reading(arm7_report).words
    for said in (
        f'carried by {payload.link}',
        f'at every pose {quantity(payload.everywhere, "kg", 3)} , limited by '
        f'{payload.limiting_joint}',
        f'at the best pose {quantity(payload.best, "kg", 3)} , limited by {payload.best_joint}',
    ):
        # A name may be broken into lines after an underscore.
        assert plain(said).replace('_ ', '_') in words.replace('_ ', '_')


def test_joints_without_limits_are_named():
    words = reading(unlimited_report).words.replace('_ ', '_')
    assert 'no effort limit is in the way' in words
    names = ' , '.join(unlimited_report().payload.unlimited_joints)
    assert f'not counted without an effort limit: {names}' in words


def test_the_conditioning_is_that_of_the_report():
    D, words = arm7_report().conditioning, reading(arm7_report).words.replace('_ ', '_')
    assert f'median {number(D.median, 3)} worst {number(D.worst, 3)}' in words
    assert f'moves the least {D.weakest_joint}' in words
    assert f'positive definite at all of {count(D.samples, "pose")}' in words
    assert D.has_mixed_units and 'some joints turn and some slide' in words
