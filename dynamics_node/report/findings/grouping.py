"""Occurrences of a problem at single links or joints, and their grouping into findings."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from .effects import Effect
from ..formatting import enumeration
from ..report import Finding

# Number of subjects that a grouped finding names with their numbers.
_NAMED = 4


@dataclass(frozen=True)
class Occurrence:
    """
    A problem at one link or joint.

    Attributes
    ----------
    severity, kind, subject : str
    what : str
        The whole sentence.
    short : str
        The numbers alone, for a list.
    effect : Effect or callable() -> Effect
        A callable is called only if the effect is shown.
    advice : str
    weight : float
        The occurrence with the largest weight comes first.

    """

    severity: str
    kind: str
    subject: str
    what: str
    short: str
    effect: Effect | Callable[[], Effect]
    advice: str
    weight: float = 0.0

    def effect_text(self) -> str:
        """Return the effect as a sentence."""
        return (self.effect if isinstance(self.effect, Effect) else self.effect()).text

    @property
    def known_effect(self) -> Effect:
        """The effect, for occurrences that were made with one."""
        assert isinstance(self.effect, Effect)
        return self.effect


def group_findings(
    occurrences: Iterable[Occurrence], plural: Callable[[int], str]
) -> list[Finding]:
    """
    Group occurrences of the same kind and severity into one finding each.

    Parameters
    ----------
    occurrences : iterable of Occurrence
    plural : callable(int) -> str
        Beginning of the sentence for several, e.g. '12 links have ...'; their list follows.

    Returns
    -------
    list of Finding

    """
    groups: dict[tuple[str, str], list[Occurrence]] = {}
    for occurrence in occurrences:
        groups.setdefault((occurrence.severity, occurrence.kind), []).append(occurrence)
    for group in groups.values():
        group.sort(key=lambda occurrence: -occurrence.weight)
    return [
        _single(group[0]) if len(group) == 1 else _several(group, plural)
        for group in groups.values()
    ]


def relevant(occurrences: Iterable[Occurrence], share: float) -> list[Occurrence]:
    """Return the occurrences whose effect is at least a share, or unknown (NaN)."""
    return [one for one in occurrences if not one.known_effect.share < share]


def _single(occurrence: Occurrence) -> Finding:
    return Finding(
        severity=occurrence.severity,
        kind=occurrence.kind,
        subjects=(occurrence.subject,),
        what=occurrence.what,
        effect=occurrence.effect_text(),
        advice=occurrence.advice,
    )


def _several(group: list[Occurrence], plural: Callable[[int], str]) -> Finding:
    first = group[0]
    texts = [
        f"'{occurrence.subject}' ({occurrence.short})"
        if occurrence.short
        else f"'{occurrence.subject}'"
        for occurrence in group[:_NAMED]
    ]
    effect = first.effect_text()
    is_same_advice = all(occurrence.advice == first.advice for occurrence in group)
    return Finding(
        severity=first.severity,
        kind=first.kind,
        subjects=tuple(occurrence.subject for occurrence in group),
        what=f'{plural(len(group))}: {enumeration(texts, len(group))}',
        effect=f"'{first.subject}': {effect}" if effect else '',
        advice=first.advice if is_same_advice else f"'{first.subject}': {first.advice}",
    )
