"""All `ros2 service call` commands of the documents: services, types and fields exist."""

import importlib
from pathlib import Path
import re

import pytest
from test_readme import DOCUMENTS, ROOT
import yaml

CALL = re.compile(r"ros2 service call (\S+) (\S+)(?:\s*\\\n)?\s*('[^']*'|\{\})?")
CALLS = [(path.name, *match) for path in DOCUMENTS for match in CALL.findall(path.read_text())]


def fill(message, values):
    """Set fields of a message as ros2cli does: nested, and none that there is not."""
    for name, value in values.items():
        current = getattr(message, name)  # AttributeError: no such field
        if isinstance(value, dict):
            fill(current, value)
        else:
            kind = message.get_fields_and_field_types()[name]
            setattr(message, name, float(value) if kind == 'double' else value)


@pytest.mark.parametrize(('document', 'service', 'kind', 'request_text'), CALLS)
def test_the_node_serves_it(document, service, kind, request_text):
    package, folder, name = kind.split('/')
    service_type = getattr(importlib.import_module(f'{package}.{folder}'), name)
    fill(service_type.Request(), yaml.safe_load(request_text.strip("'") or '{}'))
    code = ''.join(path.read_text() for path in (ROOT / 'dynamics_node').rglob('*.py'))
    # Its name stands in the code, beside its type.
    own = re.escape(Path(service).name)
    assert re.search(rf"\b{name}, '(~/)?{own}'|service\({name}\)\s+def {own}\(", code)


def test_all_calls_are_found():
    count = sum(path.read_text().count('ros2 service call') for path in DOCUMENTS)
    assert len(CALLS) == count > 5
