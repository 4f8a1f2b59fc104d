#!/usr/bin/env bash
# The tests: scripts/test.sh [arguments of pytest]. Without a path among them: all of test/, or, if
# ROS names another release of ROS 2 than Jazzy, those that need ROS 2.
# Without any argument they run in several workers; their start does not pay for a part.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# The others test the library, which is the same on every release.
ros_tests=(test/ros test/tools test/benchmarks/test_node_latency.py test/demo test/visualization test/safety/test_state_machine.py
    test/test_{commands_in_documents,launch,mass_matrix_document,reference_document}.py
    test/test_{robot_configs,safety_document,trajectory_document}.py)

arguments=()
if (($# == 0)); then
    # One more than cores: many tests wait for processes most of the time. More than a few would
    # only starve those that measure time.
    workers=$(($(nproc) + 1))
    arguments+=("-n$((workers < 5 ? workers : 5))" --dist=loadgroup)
fi
# More arguments for every run, for example `-n 0`: all in one process.
read -r -a options <<<"${PYTEST_OPTIONS:-}"
arguments+=("${options[@]}" "$@")
has_path=
for argument in "${arguments[@]}"; do
    if [[ $argument != -* && -e ${argument%%::*} ]]; then
        has_path=yes
    fi
done
if [[ ! $has_path ]]; then
    if [[ ${ROS:-jazzy} == jazzy ]]; then arguments+=(test); else arguments+=("${ros_tests[@]}"); fi
fi

mkdir -p log
rm -f log/test_exit_code
bash scripts/setup.sh test
# shellcheck source=scripts/env.sh
source scripts/env.sh
# shellcheck source=scripts/isolate.sh
source scripts/isolate.sh

code=0
python "$VIRTUAL_ENV/bin/pytest" "${arguments[@]}" || code=$?
# Beside others, tests over DDS may be starved by a busy machine: what failed is judged alone.
if ((code == 1)) && [[ ${arguments[0]} == -n* ]]; then
    echo 'The tests that failed run once more, one at a time.'
    code=0
    python "$VIRTUAL_ENV/bin/pytest" "${arguments[@]:2}" --last-failed || code=$?
fi
# For .ci/run: make turns every failure into 2.
echo "$code" >log/test_exit_code
exit "$code"
