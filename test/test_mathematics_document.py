"""docs/mathematics.md: the worked example prints the stated values, and they are true."""

from pathlib import Path
import re

import pytest

ROOT = Path(__file__).parents[1]
PAGE = ROOT / 'docs' / 'mathematics.md'
PAIRS = re.findall(r'^```python\n(.*?)^```\n```text\n(.*?)^```$', PAGE.read_text(), re.M | re.S)


def test_its_code_prints_what_the_page_says(monkeypatch, capsys):
    monkeypatch.chdir(ROOT)
    names: dict = {}
    for code, stated in PAIRS:
        exec(compile(code, PAGE.name, 'exec'), names)
        assert capsys.readouterr().out == stated
    assert len(PAIRS) == PAGE.read_text().count('```python') == 2
    assert names['right'] == pytest.approx(names['slope'], rel=1e-9)
    assert names['wrong'] == pytest.approx(-names['slope'], rel=1e-9)
    assert names['pendulum'].gravity_torque([names['q']])[0] == pytest.approx(names['right'])
    assert names['pendulum'].mass_matrix([names['q']])[0, 0] == pytest.approx(names['D'])
