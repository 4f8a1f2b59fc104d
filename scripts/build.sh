#!/usr/bin/env bash
# Install what is missing and build both packages, as every other command does first.
set -euo pipefail
scripts=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bash "$scripts/setup.sh" demo
echo 'Built: install/dynamics_node and install/dynamics_interfaces. Next: make demo, make test or make shell.'
