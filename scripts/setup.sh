#!/usr/bin/env bash
# Bring the environment up to date: a virtual environment with all
# packages, and this checkout built by colcon. ROS=kilted makes those of another ROS 2 release.
#
#     scripts/setup.sh demo    what `make demo` needs
#     scripts/setup.sh test    that, and what `make test` and `make lint` need
#     scripts/setup.sh bench   that, and what `make bench` measures beside
#
# Says nothing if nothing is to be done. A step is done again when its inputs have changed.
set -euo pipefail

purpose=${1:?expected demo, test or bench}
cd "$(dirname "${BASH_SOURCE[0]}")/.."
dynamics_root=$PWD
for part in messages release stamps progress ros_mode find_python preflight steps rivals; do
    # shellcheck source=/dev/null
    source "scripts/lib/$part.sh"
done

# Settings of the make that started this, or of the user's colcon, are not meant for our build.
unset MAKEFLAGS MFLAGS MAKELEVEL MAKEOVERRIDES COLCON_DEFAULTS_FILE
export COLCON_HOME=$dynamics_root/log/colcon_home

# One set-up at a time; the lock goes with the process.
exec 9<"$dynamics_root"
if ! flock -n 9; then
    say 'Another set-up of this checkout is running: waiting for it.'
    flock 9
fi

# Read by the functions in lib/.
# shellcheck disable=SC2034
mode=$(ros_mode)
plan_steps "$purpose"
# shellcheck disable=SC2154
((${#pending[@]})) || exit 0
check_first
begin_steps ${#pending[@]}
for step in "${pending[@]}"; do
    "do_$step"
done
