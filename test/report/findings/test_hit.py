"""Alike hits become one finding."""

from dynamics_node.report.findings.effects import Effect
from dynamics_node.report.findings.grouping import group_findings, Occurrence


def hit(subject, weight=0.0, advice='mend it', severity='warning'):
    """Return a hit."""
    return Occurrence(
        severity,
        'grams',
        subject,
        f'{subject} is light',
        '7 g',
        lambda: Effect(f'{subject} sinks', 1.0),
        advice,
        weight,
    )


def test_one_is_told_as_it_is():
    [found] = group_findings([hit('a')], str)
    assert (found.what, found.effect, found.subjects) == ('a is light', 'a sinks', ('a',))


def test_many_are_told_with_the_weightiest_first():
    hits = [hit(name, weight) for weight, name in enumerate('abcdef')]
    [found] = group_findings(hits, lambda count: f'{count} are light')
    assert found.what == ("6 are light: 'f' (7 g), 'e' (7 g), 'd' (7 g), 'c' (7 g) and 2 more")
    assert found.effect == "'f': f sinks" and found.subjects == tuple('fedcba')
    assert found.advice == 'mend it'


def test_advice_that_differs_says_for_whom():
    [found] = group_findings([hit('a', 1.0, 'glue it'), hit('b')], str)
    assert found.advice == "'a': glue it"


def test_severities_are_apart():
    assert len(group_findings([hit('a'), hit('b', severity='note')], str)) == 2
