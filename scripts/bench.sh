#!/usr/bin/env bash
# The benchmarks: scripts/bench.sh [arguments of `python -m benchmarks`]. Writes docs/benchmarks.md.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bash scripts/setup.sh bench
# shellcheck source=scripts/env.sh
source scripts/env.sh
# shellcheck source=scripts/isolate.sh
source scripts/isolate.sh
exec python -m benchmarks "$@"
