"""Something that was found at one link or joint, and how alike hits become one finding."""

from collections.abc import Callable
from dataclasses import dataclass

from .words import listed
from ..report import Finding

# So many alike hits are told one by one; more become one finding with the weightiest.
_APART = 2
_SHOWN = 4


@dataclass(frozen=True)
class Hit:
    """
    What was found at one link or joint.

    Attributes
    ----------
    severity, kind, subject : str
    what : str
        The whole sentence.
    short : str
        The numbers alone, for a list.
    effect : callable() -> str
        Computed only if it is told.
    advice : str
    weight : float
        The weightiest is told first.

    """

    severity: str
    kind: str
    subject: str
    what: str
    short: str
    effect: Callable[[], str]
    advice: str
    weight: float = 0.0


def told(hits, plural):
    """
    Make findings of hits: alike ones together.

    Parameters
    ----------
    hits : iterable of Hit
    plural : callable(int) -> str
        What so many of them are, e.g. '12 links have ...'; the list of them follows.

    Returns
    -------
    list of Finding

    """
    groups: dict[tuple, list] = {}
    for hit in hits:
        groups.setdefault((hit.severity, hit.kind), []).append(hit)
    findings = []
    for (severity, kind), group in groups.items():
        group.sort(key=lambda hit: -hit.weight)
        if len(group) <= _APART:
            findings += [Finding(severity, kind, (hit.subject,), hit.what, hit.effect(),
                                 hit.advice) for hit in group]
            continue
        shown = [f"'{hit.subject}' ({hit.short})" if hit.short else f"'{hit.subject}'"
                 for hit in group[:_SHOWN]]
        effect = group[0].effect()
        findings.append(Finding(
            severity, kind, tuple(hit.subject for hit in group),
            f'{plural(len(group))}: {listed(shown, len(group))}',
            f"'{group[0].subject}': {effect}" if effect else '', group[0].advice))
    return findings
