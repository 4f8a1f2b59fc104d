#!/usr/bin/env bash
# The model report of a robot: ROBOT=path.urdf, by default the one of the demo; arguments are those
# of the report (--help).
set -euo pipefail
scripts=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

bash "$scripts/setup.sh" demo
# shellcheck source=scripts/env.sh
source "$scripts/env.sh"
# Started by way of python: a path with spaces is legal there, not in an executable's first line.
exec python "$dynamics_root/$install_base/dynamics_node/lib/dynamics_node/report" \
    "${ROBOT:-$dynamics_root/config/robots/arm7.urdf}" "$@"
