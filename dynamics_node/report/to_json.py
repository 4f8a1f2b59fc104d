"""The report as dictionaries, lists, numbers and strings for JSON."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

from .report import Report

# Increased when a field changes its meaning or disappears; new fields do not increase it.
FORMAT = 1


def to_json(report: Report) -> dict[str, Any]:
    """
    Return a report as strict input for `json.dumps`.

    Parameters
    ----------
    report : Report

    Returns
    -------
    dict
        With "format"; the keys are the fields and properties of the dataclasses. Missing,
        infinite and NaN values are None.

    """
    return {'format': FORMAT, **_plain(report)}


def _plain(value: Any) -> Any:
    if dataclasses.is_dataclass(value):
        names = [field.name for field in dataclasses.fields(value) if field.compare]
        names += [
            name for name, member in vars(type(value)).items() if isinstance(member, property)
        ]
        return {name: _plain(getattr(value, name)) for name in names}
    if isinstance(value, dict):
        return {key: _plain(part) for key, part in value.items()}
    if isinstance(value, (tuple, list)):
        return [_plain(part) for part in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
