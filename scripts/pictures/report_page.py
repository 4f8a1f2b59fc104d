"""docs/report_page.png: a browser's screenshot of the top of the model report's page."""

from pathlib import Path
import subprocess
import sys
import tempfile
import time

from PIL import Image
from support.browser import browser

SIZE = 1280, 612  # pixels: down to the end of the finding
DRAWING_TIME = 3.0  # s, of the 3D view
# The forearm in tonnes instead of kilograms: mass and inertia.
MISTAKES = (
    ('<mass value="1.40208" />', '<mass value="0.00140208" />'),
    ('ixx="0.00241145"', 'ixx="2.41145e-06"'),
    ('iyy="0.00241145"', 'iyy="2.41145e-06"'),
    ('izz="0.00127592"', 'izz="1.27592e-06"'),
)


def draw(robot, path):
    """
    Write the picture.

    Parameters
    ----------
    robot : Path
        arm7: contains the first text of each mistake once; it is replaced by the second.
    path : Path
        PNG file.

    """
    text = robot.read_text(encoding='utf-8')
    for right, wrong in MISTAKES:
        if text.count(right) != 1:
            raise ValueError(f'{robot}: expected {right} once, got it {text.count(right)} times')
        text = text.replace(right, wrong)
    with tempfile.TemporaryDirectory() as folder:
        urdf, page = Path(folder) / 'my_arm.urdf', Path(folder) / 'page.html'
        urdf.write_text(text, encoding='utf-8')
        subprocess.run(
            [sys.executable, '-m', 'dynamics_node.report', urdf.name, '--html', page.name],
            cwd=folder,
            check=True,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        with browser() as tab:
            tab.open(page, *SIZE)
            tab.settle()
            time.sleep(DRAWING_TIME)
            tab.screenshot(path)
    with Image.open(path) as picture:
        picture.convert('RGB').quantize(128, dither=Image.Dither.NONE).save(path, optimize=True)
