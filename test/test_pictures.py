"""The pictures of the documents: their numbers, and errors without OpenGL."""

import os
from pathlib import Path
import sys

from dynamics_node import RobotModel
import numpy as np
from PIL import Image
import pytest
from support.python_process import run_python
from support.robots import ARM7

ROOT = Path(__file__).parents[1]
SCRIPT = ROOT / 'scripts' / 'make_pictures.py'
sys.path.insert(0, str(ROOT / 'scripts'))

from pictures import benchmarks, workspace  # noqa: E402

ARM = RobotModel.from_urdf(ARM7)
# One frame with the arm at its neutral position, in a process of its own: it chooses its OpenGL.
RENDER = f"""
import sys
sys.path.insert(0, {str(ROOT / 'scripts')!r})
from pictures.rendering import ArmRenderer, NoOpenGLError, over
import numpy as np
try:
    renderer = ArmRenderer({str(ARM7)!r}, 60, 80, (0.0, 0.0, 0.6), 2.5)
except NoOpenGLError as error:
    sys.exit(f'no OpenGL: {{error}}')
frame = renderer.frame({{}})
turned = renderer.frame({{'shoulder_pitch': 1.5}})
assert frame.shape == (80, 60, 4)
assert 0.02 < frame[:, :, 3].mean() < 0.3, frame[:, :, 3].mean()
assert not frame[0, :, 3].any()                            # nothing but the arm
upright, lying = (np.flatnonzero(f[:, :, 3].any(1)) for f in (frame, turned))
assert np.ptp(upright) > 1.3 * np.ptp(lying)
white = over(np.ones((80, 60, 3)), frame)
assert np.all(white[0] == 1.0) and white.min() < 0.5
renderer.close()
"""


def render(**environment):
    """Render with other environment variables; returns the finished process."""
    return run_python('-c', RENDER, env={**os.environ, **environment}, timeout=120.0)


def test_the_arm_is_rendered():
    run = render()
    if run.returncode == 1 and run.stderr.startswith('no OpenGL:'):
        pytest.skip(run.stderr)
    assert run.returncode == 0, run.stderr


def test_without_opengl_the_error_names_the_package_to_install():
    run = render(MUJOCO_GL='disabled')
    assert run.returncode == 1
    assert 'install libegl1 (then MUJOCO_GL=egl) or libosmesa6' in run.stderr


def test_an_unknown_name_is_refused():
    run = run_python(SCRIPT, 'landscape')
    assert run.returncode == 1
    assert 'expected names out of floating, workspace, report, benchmarks, got landscape' in (
        run.stderr
    )


@pytest.fixture(scope='module')
def few():
    """Return postures of a coarse grid, and the worst ones of its cells."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(workspace, 'STEPS', (41, 41, 9))
        patch.setattr(workspace, 'CELL', 0.1)
        yield workspace.postures(ARM), workspace.worst_by_place(ARM)


def test_the_tool_is_where_its_jacobian_says(few):
    q = few[0][::97]
    x, z = workspace.tool_places(ARM, q)
    h = 1e-6
    for row in map(ARM.joint_names.index, workspace.PITCHES):
        step = np.zeros(8)
        step[row] = h
        forth, back = (workspace.tool_places(ARM, q + sign * step) for sign in (1.0, -1.0))
        J = np.array([ARM.jacobian(one, workspace.TOOL) for one in q])
        np.testing.assert_allclose((forth[0] - back[0]) / (2 * h), J[:, 0, row], atol=1e-7)
        np.testing.assert_allclose((forth[1] - back[1]) / (2 * h), J[:, 2, row], atol=1e-7)
    upright = np.zeros((1, 8))
    assert workspace.tool_places(ARM, upright)[1][0] == pytest.approx(1.3, abs=0.05)
    assert np.ptp(z) > 1.5 and np.abs(x).max() < 1.1


def test_no_posture_is_worse_than_its_cell(few):
    q, (reach, height, share, payload) = few
    x, z = workspace.tool_places(ARM, q)
    for k in range(0, len(q), 501):
        if x[k] < 0.0 or x[k] >= reach[-1]:
            continue
        cell = tuple(
            np.searchsorted(edges, place, 'right') - 1
            for edges, place in ((height, z[k]), (reach, x[k]))
        )
        assert share[cell] >= np.max(np.abs(ARM.gravity_torque(q[k])) / ARM.effort_limits) - 1e-12
        assert payload[cell] <= ARM.max_payload(q[k], workspace.TOOL)[0] + 1e-9
    assert 0.3 < np.nanmax(share) < 1.0 and 2.0 < np.nanmin(payload) < 10.0


def test_the_benchmarks_are_those_of_the_page():
    page = (ROOT / 'docs' / 'benchmarks.md').read_text()
    robots, times, complete, machine = benchmarks.read(page)
    assert robots == ['UR5', 'Panda', 'arm7']
    row = next(line for line in page.splitlines() if line.startswith('| Pinocchio | D, C, G |'))
    assert all(f'{time:.3g} µs' in row for time in times['Pinocchio'])
    assert {'dynamics_node', 'Pinocchio'} <= complete and 'MuJoCo' not in complete
    assert all(
        max(times['dynamics_node']) < min(times[name])
        for name in times
        if not name.startswith('dynamics_node')
    )
    assert f'| CPU | {machine} |' in page


def test_the_picture_of_the_benchmarks_is_drawn(tmp_path):
    path = tmp_path / 'picture.png'
    benchmarks.draw((ROOT / 'docs' / 'benchmarks.md').read_text(), path)
    with Image.open(path) as picture, Image.open(ROOT / 'docs/benchmarks_short.png') as committed:
        assert picture.size == committed.size
