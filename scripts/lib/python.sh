# shellcheck shell=bash disable=SC2154
# uv, which installs packages, and the Python of the environment. Sourced by setup.sh.

uv_version=0.13.9
# The Python of Jazzy first; those that the wheels are built for.
python_versions=(3.12 3.13 3.11 3.10)

# find_uv: sets the function `uv` up; one on PATH is taken, else it comes from PyPI into log/uv.
find_uv() {
    local python
    uv_program=$(type -P uv || true)
    if [[ ! $uv_program ]]; then
        uv_program=$dynamics_root/log/uv/bin/uv
        if [[ ! -x $uv_program ]]; then
            mkdir -p log
            touch log/COLCON_IGNORE
            for python in ${PYTHON:+"$PYTHON"} python3 "${python_versions[@]/#/python}"; do
                "$python" -m venv --clear log/uv >log/uv.log 2>&1 &&
                    log/uv/bin/python -m pip install --quiet "uv==$uv_version" >>log/uv.log 2>&1 &&
                    break
            done
        fi
        [[ -x $uv_program ]] || die "expected the program uv, and it cannot be had from PyPI" \
            "either ($(tail -n 1 log/uv.log 2>/dev/null | cut -c 1-200)): check the network and" \
            "pip's settings, or apt install python3 python3-venv, or install uv."
    fi
    # uv reads neither pip's settings nor the system's certificates by itself.
    export UV_SYSTEM_CERTS=${UV_SYSTEM_CERTS:-1}
    [[ -z ${PIP_INDEX_URL:-} ]] || export UV_DEFAULT_INDEX=${UV_DEFAULT_INDEX:-$PIP_INDEX_URL}
}

uv() {
    "$uv_program" --no-config "$@" 9<&-
}

# False after a move, a change of ROS 2, an interpreter's removal, and if the user asks for another.
venv_is_usable() {
    [[ -f $venv/.made-for && $(<"$venv/.made-for") == "$mode $dynamics_root ${PYTHON:-}" ]] &&
        "$venv/bin/python" -c '' 2>/dev/null
}

# Prints the first fitting interpreter of this machine, also one of pyenv that is not switched on;
# if there is none, one that uv fetches.
choose_python() {
    local version found
    for version in "${python_versions[@]}"; do
        for found in "$(uv python find --no-project --system --no-python-downloads "$version" 2>/dev/null)" \
            "${PYENV_ROOT:-${HOME:-}/.pyenv}/versions/$version".*/bin/python3; do
            [[ -x $found ]] && has_headers "$found" && echo "$found" && return
        done
    done
    uv python install --quiet 3.12 && uv python find --no-project 3.12
}

has_headers() {
    "$1" -c 'import os, sysconfig as s
raise SystemExit(not os.path.exists(os.path.join(s.get_config_var("INCLUDEPY"), "Python.h")))' 2>/dev/null
}

has_numpy_1() {
    "$venv/bin/python" -c 'import numpy; raise SystemExit(numpy.__version__[0] != "1")' 2>/dev/null
}

make_venv() {
    local python=${PYTHON:-} options=()
    if [[ $mode == wheels ]]; then
        [[ $python ]] || python=$(choose_python) ||
            die "expected a CPython 3.10 to 3.13 with headers, found none, and uv cannot fetch one:" \
                "apt install python3 python3-dev, or make PYTHON=/path/to/python3 ..."
    else
        options=(--system-site-packages)
        [[ $python ]] || python=$(sourced_python)
    fi
    has_headers "$python" || die "$python: expected a Python that runs and has the header Python.h" \
        "(Debian and Ubuntu: apt install python3-dev)."
    # What was built with another Python or another ROS is of no use.
    rm -rf "$venv" "$build_base" "$install_base"
    say "Virtual environment with $python"
    uv venv --quiet --no-project --python "$python" "${options[@]}" "$venv" ||
        die "the virtual environment $venv could not be made; the lines above are uv's."
    touch "$venv/COLCON_IGNORE"
    printf '%s\n' "$mode $dynamics_root ${PYTHON:-}" >"$venv/.made-for"
}

# Prints the Python of the sourced ROS 2: the first that imports rclpy.
sourced_python() {
    local python
    for python in python3 /usr/bin/python3 "${python_versions[@]/#/python}"; do
        "$python" -c 'import rclpy' </dev/null >/dev/null 2>&1 && type -P "$python" && return
    done
    die "ROS_DISTRO=$ROS_DISTRO, so a python3 was expected that imports rclpy (Ubuntu: apt install" \
        "ros-$ROS_DISTRO-ros-base python3-dev), got none; in a shell that has sourced no ROS," \
        "ROS 2 Jazzy is installed into .venv."
}
