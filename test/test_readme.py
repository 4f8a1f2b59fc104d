"""The README and all documents: their code runs, their links lead somewhere."""

from pathlib import Path
import re

from dynamics_node.codegen import is_supported
import pytest

ROOT = Path(__file__).parents[1]
DOCUMENTS = [
    ROOT / name for name in ('README.md', 'ARCHITECTURE.md', 'CONTRIBUTING.md', 'SECURITY.md')
]
DOCUMENTS += sorted((ROOT / 'docs').rglob('*.md'))
# They need a node, and have a test of their own.
WITH_A_NODE = {
    'docs/trajectory.md': 'test_trajectory_document.py',
    'docs/tutorial.md': 'test_tutorial_document.py',
    'docs/how_to/mass_matrix.md': 'test_mass_matrix_document.py',
}


def blocks(path, language='python'):
    """Return the blocks of a document in a language."""
    return re.findall(rf'^```{language}\n(.*?)^```', path.read_text(), re.M | re.S)


def name_of(path):
    """Return the path of a document as people write it."""
    return path.relative_to(ROOT).as_posix()


def run(path):
    """Run the Python blocks of a document, one after the other; returns the names."""
    names: dict = {'__name__': path.stem}
    for code in blocks(path):
        exec(compile(code, name_of(path), 'exec'), names)
    return names


def test_the_code_of_the_readme_runs(monkeypatch, capsys):
    monkeypatch.chdir(ROOT)
    names = run(ROOT / 'README.md')
    assert names['loaded'].moving_mass - names['robot'].moving_mass == pytest.approx(1.2)
    assert '(8, 8) (1000, 8, 8)' in capsys.readouterr().out
    assert len(names['robot'].joint_names) == 8


def test_machine_code_is_there_when_its_page_says_so(monkeypatch):
    monkeypatch.chdir(ROOT)
    assert run(ROOT / 'docs/how_to/speed.md')['robot'].is_specialized == is_supported()


@pytest.mark.parametrize('path', [path for path in DOCUMENTS if blocks(path)], ids=name_of)
def test_the_code_of_every_document_runs(monkeypatch, path):
    if name_of(path) in WITH_A_NODE:
        assert path.stem in (Path(__file__).parent / WITH_A_NODE[name_of(path)]).read_text()
        return
    monkeypatch.chdir(ROOT)
    assert len(run(path)) > 1


def test_the_first_screen_has_its_parts_in_order():
    top = (ROOT / 'README.md').read_text().splitlines()[:45]
    assert top[0] == '# dynamics_node'
    beginnings = ['The dynamics of', '[![', '![', '    pip install', '    make demo', '```python']
    places = [
        next(number for number, line in enumerate(top) if line.startswith(beginning))
        for beginning in [*beginnings, '| ROS 2']
    ]
    assert places == sorted(places)


@pytest.mark.parametrize('path', DOCUMENTS, ids=name_of)
def test_links_lead_somewhere(path):
    text = path.read_text()
    for target, anchor in re.findall(r'\]\(([^)#]*)(#[^)]*)?\)', text):
        if target.startswith(('http:', 'https:')):
            continue
        found = path.parent / target if target else path
        assert found.exists(), target
        if anchor and found.suffix == '.md':
            assert anchor in anchors(found), f'{target}{anchor}'


def anchors(path):
    """Return the places of a document to which a link can lead, as GitHub names them."""
    text = path.read_text()
    headings = re.findall(r'^#+ (.*)$', text, re.M)
    return {
        '#' + re.sub(r'[^\w\- ]', '', heading.lower()).replace(' ', '-') for heading in headings
    } | {f'#{name}' for name in re.findall(r'<a name="(.*?)">', text)}


def test_every_document_is_in_the_index():
    index = ROOT / 'docs' / 'README.md'
    listed = {
        (index.parent / target).resolve()
        for target in re.findall(r'\]\(([^)#]+)', index.read_text())
    }
    for path in (ROOT / 'docs').rglob('*.md'):
        assert path == index or path.resolve() in listed, f'{name_of(path)} is not in the index'


def test_every_picture_is_shown_and_small():
    shown = ''.join(path.read_text() for path in DOCUMENTS)
    for path in (ROOT / 'docs').iterdir():
        if path.suffix in ('.png', '.webp'):
            assert f'{path.name})' in shown, f'{path.name} is in no document'
            assert path.stat().st_size < 300_000, f'{path.name} is too large'


def test_every_equation_that_the_code_refers_to_exists():
    numbers = set(re.findall(r'\((\d+)\)$', (ROOT / 'docs/mathematics.md').read_text(), re.M))
    for path in (ROOT / 'dynamics_node').rglob('*.py'):
        for sentence in re.findall(r'docs/mathematics\.md, equations? ([^.:]*)', path.read_text()):
            for first, last in re.findall(r'\((\d+)\)(?: to \((\d+)\))?', sentence):
                assert {first, last or first} <= numbers, f'{path}: {sentence}'
