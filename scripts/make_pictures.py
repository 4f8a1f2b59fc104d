#!/usr/bin/env python3
"""
Draw the pictures of the documents; `make pictures` runs it.

floating     docs/floating.png, docs/floating.webp: the demo runs, is rendered and plotted
workspace    docs/workspace.png: gravity torque and payload over the workspace of arm7
report       docs/report_page.png: the page of the model report of an arm with a wrong mass
benchmarks   docs/benchmarks_short.png: from docs/benchmarks.md, measures nothing

Give names to draw only some. The first needs offscreen OpenGL: libegl1, or libosmesa6 and
MUJOCO_GL=osmesa. The report needs chromium and chromium-driver. The demo itself draws its own
figure without.

"""

from pathlib import Path
import sys

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / 'scripts'), str(ROOT / 'test')]
DOCS = ROOT / 'docs'
ARM7 = ROOT / 'config' / 'robots' / 'arm7.urdf'


def floating():
    """Run the demo and draw what happened."""
    from dynamics_node.demo.__main__ import isolate, perform
    from pictures import floating, rendering
    from rich.console import Console

    isolate()
    try:  # before the run, which takes half a minute
        rendering.ArmRenderer(ARM7, 8, 8, (0.0, 0.0, 0.0), 1.0).close()
    except rendering.NoOpenGLError as error:
        sys.exit(f'make_pictures: {error}')
    outcome, arm, _ = perform(ARM7, 10.0, False, Console(width=100))
    failures = outcome.failures()
    if failures:
        sys.exit('make_pictures: ' + '; '.join(failures))
    floating.draw(outcome, arm, ARM7, DOCS / 'floating.png')
    floating.film(outcome, arm, ARM7, DOCS / 'floating.webp')


def workspace():
    """Compute and draw the workspace."""
    from dynamics_node import RobotModel
    from pictures import workspace

    robot = RobotModel.from_urdf(ARM7)
    robot.specialize(with_payload_code=True)
    workspace.draw(robot, DOCS / 'workspace.png')


def report():
    """Take a picture of the report's page."""
    from pictures import report_page

    report_page.draw(ARM7, DOCS / 'report_page.png')


def benchmarks():
    """Draw the first table of the benchmarks."""
    from pictures import benchmarks

    benchmarks.draw(
        (DOCS / 'benchmarks.md').read_text(encoding='utf-8'), DOCS / 'benchmarks_short.png'
    )


PICTURES = {
    'floating': floating,
    'workspace': workspace,
    'report': report,
    'benchmarks': benchmarks,
}


def main(names):
    """Draw the pictures of these names, or all."""
    unknown = set(names) - set(PICTURES)
    if unknown:
        sys.exit(
            f'make_pictures: expected names out of {", ".join(PICTURES)}, got '
            f'{", ".join(sorted(unknown))}'
        )
    for name in names or PICTURES:
        PICTURES[name]()
        print(f'drawn: {name}')


if __name__ == '__main__':
    main(sys.argv[1:])
