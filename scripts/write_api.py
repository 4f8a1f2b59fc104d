#!/usr/bin/env python3
"""
Write docs/api.md from the public names of the library, their signatures and docstrings.

After a change of one of them, in `make shell`:

    python scripts/write_api.py

"""

from pathlib import Path
import sys

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / 'scripts')]

from api_page.page import PATH, render  # noqa: E402

if __name__ == '__main__':
    PATH.write_text(render(), encoding='utf-8')
    print(f'wrote {PATH.relative_to(ROOT)}')
