#!/usr/bin/env python3
"""
Write docs/accuracy.md: differences from Pinocchio, MuJoCo and 80-bit arithmetic.

It runs the same sweep as `make test`. After a change of the kernels or of a library, in
`make shell`:

    python scripts/write_accuracy.py

"""

from pathlib import Path
import sys

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / 'test')]

from support.accuracy_document import PATH, render  # noqa: E402

if __name__ == '__main__':
    PATH.write_text(render(), encoding='utf-8')
    print(f'wrote {PATH.relative_to(ROOT)}')
