#!/usr/bin/env bash
# The soak: scripts/soak.sh [arguments of `python -m soak`]. Exit code 1 if anything went wrong.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bash scripts/setup.sh demo
# shellcheck source=scripts/env.sh
source scripts/env.sh
# shellcheck source=scripts/isolate.sh
source scripts/isolate.sh
export PYTHONPATH=$PWD/test:$PWD/tools${PYTHONPATH:+:$PYTHONPATH}
exec python -m soak "$@"
