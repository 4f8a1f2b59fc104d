#!/usr/bin/env bash
# Renew the pins: requirements/*.in (but bench.in, which has its own) ->
# requirements/lock/*.txt, one per Python version and release of ROS 2.
#
# All purposes are resolved together, so that the demo's and the tests' packages never change
# the version of what runs on the robot. Python 3.12 has a second lock, without the wheels of
# ROS 2 and with the limits of sourced-ros.txt, for Ubuntu 24.04's own ROS 2. The wheels of another
# release than Jazzy have locks with its name, in which the other packages are those of Jazzy's.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
for part in messages release ros_mode find_python; do
    # shellcheck source=/dev/null
    source "scripts/lib/$part.sh"
done

# Prints `name==version` for all that pip would install.
read -r -d '' pins_of_report <<'EOF' || true
import json
import re
import sys

report = json.load(open(sys.argv[1]))
for item in sorted(
    re.sub('[-_.]+', '-', entry['metadata']['name']).lower() + '==' + entry['metadata']['version']
    for entry in report['install']
):
    print(item)
EOF

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# lock NAME VENV REQUIREMENT...: written only when complete.
lock() {
    local name=$1 venv=$2
    shift 2
    "$venv/bin/python" -m pip install --quiet --dry-run --ignore-installed --no-input \
        --report "$work/report.json" "$@" >"$work/log" 2>&1 || {
        tail -n 30 "$work/log" >&2
        die "no set of versions fits $name: change requirements/*.in; the lines above are pip's."
    }
    "$venv/bin/python" -c "$pins_of_report" "$work/report.json" >"$work/lock"
    mv "$work/lock" "requirements/lock/$name.txt"
    say "requirements/lock/$name.txt: $(wc -l <"requirements/lock/$name.txt") packages"
}

without_ros=()
for file in requirements/*.in; do
    case $file in
        # Has its own pins: its packages are large, and optional.
        requirements/bench.in | requirements/ros-*.in) ;;
        *) without_ros+=(-r "$file") ;;
    esac
done

# Look for all interpreters before the first of the long steps.
declare -A interpreters
for minor in 10 11 12 13; do
    readarray -t candidates < <(python_candidates "$minor" | grep "3\.$minor")
    first_good_python sys "${candidates[@]}"
    [[ -n $good_python ]] || die "expected Python 3.$minor, with venv and headers, to lock its" \
        "packages, got: ${rejected:-none that runs}; install it, for example with pyenv."
    interpreters[$minor]=$good_python
done

mkdir -p requirements/lock
for minor in 10 11 12 13; do
    venv=$work/python3.$minor
    "${interpreters[$minor]}" -m venv "$venv"
    # Old versions of pip give up, or search for hours, where the newest finds a solution.
    "$venv/bin/python" -m pip install --quiet --upgrade pip >"$work/log" 2>&1 ||
        die "packages cannot be had from PyPI: check the network and pip's settings."
    lock "python3.$minor" "$venv" "${without_ros[@]}" -r requirements/ros-jazzy.in
    grep -v '^ros-' "requirements/lock/python3.$minor.txt" >"$work/others"
    for release in "${wheel_releases[@]}"; do
        [[ $release != jazzy ]] || continue
        lock "python3.$minor-$release" "$venv" "${without_ros[@]}" \
            -r "requirements/ros-$release.in" -c "$work/others"
    done
    if ((minor == 12)); then
        lock "python3.$minor-numpy1" "$venv" "${without_ros[@]}" \
            -r requirements/sourced-ros.txt
    fi
done
