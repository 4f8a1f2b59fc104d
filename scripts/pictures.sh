#!/usr/bin/env bash
# The pictures of the documents: scripts/pictures.sh [names; see scripts/make_pictures.py].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bash scripts/setup.sh demo
# shellcheck source=scripts/env.sh
source scripts/env.sh
# shellcheck source=scripts/isolate.sh
source scripts/isolate.sh
exec python scripts/make_pictures.py "$@"
