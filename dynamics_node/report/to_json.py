"""The report as dictionaries, lists, numbers and texts that JSON has."""

import dataclasses
import math

# Raised when a field changes its meaning or goes; new fields may come without.
FORMAT = 1


def to_json(report):
    """
    Return a report as what `json.dumps` takes, strictly.

    Parameters
    ----------
    report : Report

    Returns
    -------
    dict
        With "format"; the fields have the names of the dataclasses, and so have their
        properties. What is infinite, not a number or not there is None.

    """
    return {'format': FORMAT, **_plain(report)}


def _plain(value):
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
