#!/usr/bin/env bash
# The tests: scripts/test.sh [arguments of pytest]. Without a path among them: all of test/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# More arguments for every run, for example `-n 2` where pytest-xdist is installed.
read -r -a arguments <<<"${PYTEST_OPTIONS:-}"
arguments+=("$@")
has_path=
for argument in "${arguments[@]}"; do
    if [[ $argument != -* && -e ${argument%%::*} ]]; then
        has_path=yes
    fi
done
[[ $has_path ]] || arguments+=(test)

mkdir -p log
rm -f log/test_exit_code
bash scripts/setup.sh test
# shellcheck source=scripts/env.sh
source scripts/env.sh
# shellcheck source=scripts/isolate.sh
source scripts/isolate.sh

code=0
python "$VIRTUAL_ENV/bin/pytest" "${arguments[@]}" || code=$?
# For .ci/run: make turns every failure into 2.
echo "$code" >log/test_exit_code
exit "$code"
