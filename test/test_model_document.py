"""docs/model.md: its code runs, with the stated meaning."""

from pathlib import Path

import numpy as np
import pytest
from test_readme import blocks

ROOT = Path(__file__).parents[1]


def test_its_code_runs(monkeypatch):
    monkeypatch.chdir(ROOT)
    names: dict = {}
    [code] = blocks(ROOT / 'docs' / 'model.md')
    exec(compile(code, 'docs/model.md', 'exec'), names)
    robot, q = names['robot'], names['q']
    assert names['on_wall'].payload.mass == 1.2
    assert names['effort'].shape == names['push'].shape == (8,)
    # Ten newtons upwards take ten newtons of weight from the joints.
    carried = robot.with_payload('tool_center', 10.0 / 9.81).gravity_torque(q)
    assert carried - robot.gravity_torque(q) == pytest.approx(names['push'])
    assert 0.0 < names['mass'] < 100.0 and np.isfinite(names['mass'])
