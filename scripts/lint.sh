#!/usr/bin/env bash
# The linters: ruff on everything, mypy on the package and the benchmarks. Runs both, fails if one does.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bash scripts/setup.sh test
# shellcheck source=scripts/env.sh
source scripts/env.sh

code=0
ruff check . || code=1
ruff format --check . || code=1
python -m mypy dynamics_node benchmarks || code=1
exit "$code"
