#!/usr/bin/env bash
# A browser and its driver for the tests that open pages; .ci/run may install them.
# Exit code 0: the tests must find them; 1: the tests may be skipped here.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1

for name in "${DYNAMICS_NODE_BROWSER:-chromium}" chromium-browser google-chrome google-chrome-stable; do
    command -v "$name" >/dev/null && command -v chromedriver >/dev/null && exit 0
done
[[ $EUID == 0 ]] && command -v apt-get >/dev/null || exit 1

mkdir -p log
export DEBIAN_FRONTEND=noninteractive
echo 'installing chromium and its driver, for the tests that open pages ...'
if ! { apt-get update && apt-get install -y --no-install-recommends chromium chromium-driver; } \
    >log/browser.txt 2>&1; then
    echo 'error: chromium could not be installed, see log/browser.txt; the tests that open pages will fail.' >&2
fi
exit 0
