# shellcheck shell=bash
# Which Python the environment is made with. Sourced by setup.sh and lock.sh.

# What the interpreter in front of it is good for: `ok PATH` or `no WHAT IS MISSING`.
# PATH is the interpreter below any virtual environment.
read -r -d '' python_probe <<'EOF' || true
import importlib.util
import os
import sys
import sysconfig

version = '%d.%d' % sys.version_info[:2]
package = 'python' + version


def missing():
    if sys.implementation.name != 'cpython' or sysconfig.get_config_var('Py_GIL_DISABLED'):
        return 'is not an ordinary CPython'
    if not (3, 10) <= sys.version_info[:2] <= (3, int(sys.argv[1])):
        return 'is Python ' + version
    for module in ('venv', 'ensurepip'):
        if importlib.util.find_spec(module) is None:
            return 'has no module %s (Debian and Ubuntu: apt install %s-venv)' % (module, package)
    if not os.path.exists(os.path.join(sysconfig.get_config_var('INCLUDEPY'), 'Python.h')):
        return 'has no header Python.h (Debian and Ubuntu: apt install %s-dev)' % package
    return None


reason = missing()
print('no ' + reason if reason else 'ok ' + (getattr(sys, '_base_executable', '') or sys.executable))
EOF

# The newest minor version of Python 3 that is taken.
newest_minor=13

# probe_python PATH [MODULE]: the probe's answer; nothing if PATH does not run (a shim of pyenv
# may stand for a version that is not switched on) or cannot import MODULE.
probe_python() {
    local module=${2:-sys}
    "$1" -c "import $module" </dev/null >/dev/null 2>&1 || return 0
    "$1" -c "$python_probe" "$newest_minor" </dev/null 2>/dev/null || true
}

# python_candidates MINOR...: every file that may be such a Python, those on PATH first.
python_candidates() {
    local minor folder
    local pyenv=${PYENV_ROOT:-${HOME:-}/.pyenv}
    for minor; do
        type -a -P "python3.$minor" || true
        for folder in "$pyenv/versions/3.$minor".*/bin; do
            [[ -x $folder/python3 ]] && echo "$folder/python3"
        done
    done
    type -a -P python3 || true
}

# first_good_python MODULE CANDIDATE...: prints the first that is good for us; sets
# `rejected` to what is wrong with the others.
first_good_python() {
    local module=$1 candidate answer
    shift
    good_python=
    rejected=
    for candidate; do
        answer=$(probe_python "$candidate" "$module")
        case $answer in
            'ok '*)
                good_python=${answer#ok }
                return
                ;;
            'no '*) rejected+="${rejected:+; }$candidate ${answer#no }" ;;
        esac
    done
}

# find_python: sets `good_python` to a CPython 3.10 to 3.13 with venv and headers, 3.12 (the
# one of Jazzy) first, or ends the script.
find_python() {
    local -a candidates
    if [[ -n ${PYTHON:-} ]]; then
        candidates=("$PYTHON")
    else
        readarray -t candidates < <(python_candidates 12 13 11 10)
    fi
    first_good_python sys "${candidates[@]}"
    [[ -n $good_python ]] || die "expected a CPython 3.10 to 3.13 that runs, with venv and" \
        "headers (Debian and Ubuntu: apt install python3 python3-venv python3-dev;" \
        "or make PYTHON=/path/to/python3 ...), got: ${rejected:-none that runs}."
}

# find_ros_python: sets `good_python` to the Python of the sourced ROS, or ends the script.
find_ros_python() {
    local -a candidates
    # The Python that this ROS 2 was built for is the only one that fits, also a newer one.
    newest_minor=99
    if [[ -n ${PYTHON:-} ]]; then
        candidates=("$PYTHON")
    else
        readarray -t candidates < <(type -a -P python3; python_candidates 12; echo /usr/bin/python3)
    fi
    first_good_python rclpy "${candidates[@]}"
    [[ -n $good_python ]] || die "ROS_DISTRO=$ROS_DISTRO, so a python3 was expected that imports" \
        "rclpy and has venv and headers (Ubuntu: apt install ros-$ROS_DISTRO-ros-base python3-venv" \
        "python3-dev), got: ${rejected:-none that imports rclpy}; in a shell that has sourced no" \
        "ROS, ROS 2 Jazzy is installed into .venv."
}
