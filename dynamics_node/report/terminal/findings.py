"""Findings, each as what, effect and advice."""

from rich.padding import Padding
from rich.text import Text


def findings(report, colors):
    """
    Yield the findings, the notes first and the problems last: near the verdict.

    Parameters
    ----------
    report : Report
    colors : dict of str to str
        Style by severity.

    """
    if report.findings:
        yield Text('\nFindings', style='bold')
    for finding in reversed(report.findings):
        text = Text()
        text.append(finding.severity, style=colors[finding.severity])
        text.append(f' [{finding.kind}] ', style='dim')
        text.append(_sentence(finding.what))
        yield text
        if finding.effect:
            yield Padding(Text.assemble(('effect: ', 'dim'), finding.effect), (0, 0, 0, 2))
        if finding.advice:
            yield Padding(Text.assemble(('to do: ', 'dim'), finding.advice), (0, 0, 0, 2))


def _sentence(text):
    return text[:1].upper() + text[1:]
