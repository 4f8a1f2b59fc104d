#!/usr/bin/env bash
# Install what is missing and build both packages, as every other command does first.
set -euo pipefail
scripts=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bash "$scripts/setup.sh" demo
# shellcheck source=scripts/env.sh
source "$scripts/env.sh"
echo "Built: $install_base/dynamics_node and $install_base/dynamics_interfaces. Next: make demo, make test or make shell."
