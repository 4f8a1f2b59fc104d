"""The README: its code runs, and its tables are those of the code."""

from pathlib import Path
import re

from dynamics_node.kernels.specialised import is_supported
import pytest

ROOT = Path(__file__).parents[1]
DOCUMENTS = [ROOT / name for name in ('README.md', 'ARCHITECTURE.md', 'CONTRIBUTING.md',
                                  'SECURITY.md')]
DOCUMENTS += sorted((ROOT / 'docs').glob('*.md'))


def blocks(path):
    """Return the Python blocks of a document."""
    return re.findall(r'^```python\n(.*?)^```', path.read_text(), re.M | re.S)


def test_the_code_of_the_readme_runs(monkeypatch, capsys):
    monkeypatch.chdir(ROOT)
    names = {}
    for code in blocks(ROOT / 'README.md'):
        exec(compile(code, 'README.md', 'exec'), names)
    assert names['robot'].is_specialised == is_supported()
    assert '(8, 8) (1000, 8, 8)' in capsys.readouterr().out


@pytest.mark.parametrize('path', DOCUMENTS, ids=lambda path: path.name)
def test_links_lead_somewhere(path):
    text = path.read_text()
    for target in re.findall(r'\]\(([^)#]+)(?:#[^)]*)?\)', text):
        assert (path.parent / target).exists(), target


def test_the_table_of_services_is_that_of_the_interfaces():
    text = (ROOT / 'README.md').read_text()
    named = set(re.findall(r'dynamics_interfaces/srv/(\w+) \|', text))
    assert named == {path.stem for path in (ROOT / 'dynamics_interfaces/srv').glob('*.srv')}
    named = set(re.findall(r'dynamics_interfaces/(\w+) \|', text))
    assert named == {path.stem for path in (ROOT / 'dynamics_interfaces/msg').glob('*.msg')}


def test_every_equation_that_the_code_refers_to_exists():
    numbers = set(re.findall(r'\((\d+)\)$', (ROOT / 'docs/mathematics.md').read_text(), re.M))
    for path in (ROOT / 'dynamics_node').rglob('*.py'):
        for sentence in re.findall(r'docs/mathematics\.md, equations? ([^.:]*)', path.read_text()):
            for first, last in re.findall(r'\((\d+)\)(?: to \((\d+)\))?', sentence):
                assert {first, last or first} <= numbers, f'{path}: {sentence}'
