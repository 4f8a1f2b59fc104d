"""Something that was found at one link or joint, and how alike hits become one finding."""

from collections.abc import Callable
from dataclasses import dataclass

from .effects import Effect
from .words import listed
from ..report import Finding

# So many alike hits are told one by one; more become one finding with the weightiest.
_APART = 1
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
    effect : Effect or callable() -> Effect
        Called only if it is told.
    advice : str
    weight : float
        The weightiest is told first.

    """

    severity: str
    kind: str
    subject: str
    what: str
    short: str
    effect: Effect | Callable[[], Effect]
    advice: str
    weight: float = 0.0

    def effect_text(self):
        """Return what it does, in words."""
        return (self.effect if isinstance(self.effect, Effect) else self.effect()).text


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
            findings += [
                Finding(severity, kind, (hit.subject,), hit.what, hit.effect_text(), hit.advice)
                for hit in group
            ]
            continue
        shown = [
            f"'{hit.subject}' ({hit.short})" if hit.short else f"'{hit.subject}'"
            for hit in group[:_SHOWN]
        ]
        effect = group[0].effect_text()
        findings.append(
            Finding(
                severity,
                kind,
                tuple(hit.subject for hit in group),
                f'{plural(len(group))}: {listed(shown, len(group))}',
                f"'{group[0].subject}': {effect}" if effect else '',
                _advice(group),
            )
        )
    return findings


def _advice(group):
    advice = group[0].advice
    same = all(hit.advice == advice for hit in group)
    return advice if same else f"'{group[0].subject}': {advice}"
