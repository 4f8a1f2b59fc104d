#!/usr/bin/env bash
# The demo: a simulated robot held by the node. ROBOT=path.urdf another robot, VIEW=1 a window.
set -euo pipefail
scripts=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

arguments=()
if [[ -n ${ROBOT:-} ]]; then
    if [[ ! -f $ROBOT ]]; then
        printf "error: ROBOT: expected a URDF file, got '%s', which is no file (in %s).\n" "$ROBOT" "$PWD" >&2
        exit 1
    fi
    arguments+=(--robot "$ROBOT")
fi
case ${VIEW:-} in
    '' | 0 | no | false) ;;
    *) arguments+=(--view) ;;
esac

bash "$scripts/setup.sh" demo
# shellcheck source=scripts/env.sh
source "$scripts/env.sh"
# shellcheck source=scripts/isolate.sh
source "$scripts/isolate.sh"
# Started by way of python: a path with spaces is legal there, not in an executable's first line.
exec python "$dynamics_root/$install_base/dynamics_node/lib/dynamics_node/demo" "${arguments[@]}"
