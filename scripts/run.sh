#!/usr/bin/env bash
# Run a program in the environment: scripts/run.sh demo|test|bench COMMAND...; see setup.sh.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
if [[ -n ${ROBOT:-} && ! -f $ROBOT ]]; then
    printf "error: ROBOT: expected a URDF file, got '%s', which is no file (in %s).\n" "$ROBOT" "$PWD" >&2
    exit 1
fi
bash scripts/setup.sh "$1"
# shellcheck source=scripts/env.sh
source scripts/env.sh
# shellcheck source=scripts/isolate.sh
source scripts/isolate.sh
export PYTHONPATH=$PWD/tools:$PWD/test${PYTHONPATH:+:$PYTHONPATH}
exec "${@:2}"
