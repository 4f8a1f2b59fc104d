#!/usr/bin/env python3
"""
Write docs/reference.md from the code, the interface files and the launch files.

After a change of a parameter, a topic (scripts/reference/graph.py), a service or a launch
argument, in `make shell`:

    python scripts/write_reference.py

"""

from pathlib import Path
import sys

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / 'scripts')]

from reference.page import PATH, render  # noqa: E402

if __name__ == '__main__':
    PATH.write_text(render(), encoding='utf-8')
    print(f'wrote {PATH.relative_to(ROOT)}')
