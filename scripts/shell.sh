#!/usr/bin/env bash
# A bash in which this checkout's packages are active.
set -euo pipefail
scripts=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bash "$scripts/setup.sh" demo
exec bash --rcfile "$scripts/lib/shell_rc.sh" -i
