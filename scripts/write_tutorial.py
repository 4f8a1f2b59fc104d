#!/usr/bin/env python3
"""
Write the present output of its commands into docs/tutorial.md.

It runs the whole page: two programs and a Python session. After a change of the page or of the
node's log lines, in `make shell`:

    python scripts/write_tutorial.py

A line that ends with ' ...' is replaced by the program's line with the same beginning.

"""

from pathlib import Path
import sys

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / 'scripts')]

from tutorial.page import join, PATH, split  # noqa: E402
from tutorial.session import Session  # noqa: E402

if __name__ == '__main__':
    session = Session()
    try:
        parts = session.run(split(PATH.read_text(encoding='utf-8')))
    finally:
        session.close()
    PATH.write_text(join(parts), encoding='utf-8')
    print(f'wrote {PATH.relative_to(ROOT)}')
