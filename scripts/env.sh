# shellcheck shell=bash
# Sourced (bash): the environment in which this checkout's packages, node executables, launch
# files, colcon and pytest work. `scripts/setup.sh` makes what it points to.

dynamics_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/lib/base_env.sh
source "$dynamics_root/scripts/lib/base_env.sh"

if [[ -f $dynamics_root/$install_base/local_setup.bash ]]; then
    # colcon's files read unset variables, and start Python by a path without quotes: give
    # them one that has no spaces even if the checkout's has some.
    _options=$-
    set +u
    # shellcheck disable=SC2034
    COLCON_PYTHON_EXECUTABLE=$(readlink -f "$VIRTUAL_ENV/bin/python")
    # shellcheck source=/dev/null
    source "$dynamics_root/$install_base/local_setup.bash"
    unset COLCON_PYTHON_EXECUTABLE
    [[ $_options != *u* ]] || set -u
    unset _options
fi
