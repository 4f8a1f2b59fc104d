#!/usr/bin/env bash
# Broken inputs for the node: scripts/fuzz.sh [arguments of `python -m fuzz`].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=scripts/lib/messages.sh
source scripts/lib/messages.sh
bash scripts/setup.sh test
# shellcheck source=scripts/env.sh
source scripts/env.sh
# shellcheck source=scripts/isolate.sh
source scripts/isolate.sh
export PYTHONPATH=$PWD/test:$PWD/tools${PYTHONPATH:+:$PYTHONPATH}

code=0
python -m fuzz "$@" || code=$?
# 128 and the number of a signal: not Python's own end.
if ((code > 128)); then
    die "signal $((code - 128)) ended the process; its last input is in log/fuzz/running.*:" \
        "make fuzz ARGS='--replay FILE'"
fi
exit "$code"
