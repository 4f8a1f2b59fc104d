"""The findings, the worst first: colour, word and order say how bad each is."""

from .escape import span, text
from ..formatting import count

_FEW = 4  # names in a headline
WORDS = {'problem': 'Problem', 'warning': 'Warning', 'note': 'Note'}


def findings_section(report):
    """
    Return the section of the findings.

    Parameters
    ----------
    report : Report

    Returns
    -------
    str
        Markup.

    """
    parts = ['<section id="findings"><h2>Findings</h2>']
    if report.verdict == 'refused':
        parts.append(
            '<p class="quiet">This description cannot be used as it is. Mend what '
            'is wrong with it and make the report again.</p>'
        )
        parts.append(_refusals(report))
    elif not report.findings:
        parts.append('<p class="none">Nothing looks wrong.</p>')
    elif report.is_clean:
        parts.append('<p class="none">No problems and no warnings.</p>')
    if len({finding.severity for finding in report.findings}) > 1:
        parts.append(_choice(report))
    parts += [_finding(finding) for finding in report.findings]
    return '\n'.join([*parts, '</section>'])


def headline(report):
    """Return how many findings there are, '2 problems, 1 note'."""
    words = [count(amount, severity) for severity, amount in report.counts.items() if amount]
    return ', '.join(words) or 'nothing found'


def _refusals(report):
    items = ''.join(f'<p>{text(_sentence(reason))}</p>' for reason in report.refusals)
    return (
        f'<article class="finding problem"><h3><span class="word">Refused</span></h3>'
        f'{items}</article>'
    )


def _choice(report):
    chips = [
        '<button type="button" class="chip" aria-pressed="true" data-severity="">'
        f'all {len(report.findings)}</button>'
    ]
    chips += [
        f'<button type="button" class="chip" aria-pressed="false" '
        f'data-severity="{severity}">{count(amount, severity)}</button>'
        for severity, amount in report.counts.items()
        if amount
    ]
    return f'<div class="tools severities" hidden>{"".join(chips)}</div>'


def _sentence(words):
    return words[:1].upper() + words[1:]


def _finding(finding):
    subjects = ', '.join(span(name) for name in finding.subjects[:_FEW])
    others = finding.subjects[_FEW:]
    if others:
        subjects += (
            f' <details><summary>and {len(others)} more</summary>'
            f'{", ".join(span(name) for name in others)}</details>'
        )
    said = [
        (label, sentence)
        for label, sentence in (('effect', finding.effect), ('what to do', finding.advice))
        if sentence
    ]
    details = ''.join(
        f'<dt>{label}</dt><dd>{text(_sentence(sentence))}</dd>' for label, sentence in said
    )
    return (
        f'<article class="finding {text(finding.severity)}"><h3>'
        f'<span class="word">{WORDS[finding.severity]}</span>'
        f'<span>{subjects or "the whole robot"}</span>'
        f'<span class="kind">{text(finding.kind)}</span></h3>'
        f'<p>{text(_sentence(finding.what))}</p>'
        + (f'<dl>{details}</dl>' if details else '')
        + '</article>'
    )
