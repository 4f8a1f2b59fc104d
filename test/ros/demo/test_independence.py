"""The simulation judges the node, so it must not share its mathematics."""

import ast
from pathlib import Path

import dynamics_node.ros.demo
import pytest

FILES = sorted(Path(dynamics_node.ros.demo.__file__).parent.glob('*.py'))


@pytest.mark.parametrize('path', FILES, ids=lambda path: path.stem)
def test_no_file_of_the_demo_imports_the_core(path):
    """Only its neighbours, by relative imports of one dot."""
    for statement in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
        if isinstance(statement, ast.ImportFrom):
            assert statement.level <= 1, ast.unparse(statement)
            assert not (statement.module or '').startswith('dynamics_node'), statement.module
        if isinstance(statement, ast.Import):
            assert not any(name.name.startswith('dynamics_node') for name in statement.names)
