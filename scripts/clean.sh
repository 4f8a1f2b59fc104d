#!/usr/bin/env bash
# Remove everything that the other scripts have made; the next command makes it anew.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
rm -rf .venv .venv-* build build-* install install-* log .pytest_cache .hypothesis .mypy_cache .ruff_cache demo.png
# __pycache__ also holds the compiled kernels.
find . -name .git -prune -o -type d \( -name __pycache__ -o -name '*.egg-info' \) -prune -print0 |
    xargs -0 rm -rf --
