#!/usr/bin/env bash
# Runs the tests of the web page in a real browser: run.sh WORK_FOLDER [TEST ...]
# LPF_SERVER_BINARY and LPF_PAGE_DIR name what is tested, LPF_CHROMIUM the browser.
# Exit code 77: this machine has no npm or no Chromium, so that nothing could be tested.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=$1
shift

export LPF_CHROMIUM=${LPF_CHROMIUM:-/usr/bin/chromium}
command -v npm >/dev/null || { echo "skipped: npm is not there"; exit 77; }
[ -x "$LPF_CHROMIUM" ] || { echo "skipped: there is no browser $LPF_CHROMIUM"; exit 77; }

# In a copy, so that the source tree stays as it is.
mkdir -p "$work"
cp "$here"/*.mjs "$here"/package.json "$here"/package-lock.json "$here"/.npmrc "$work"
cd "$work"
if ! cmp -s package-lock.json installed-lock.json; then
    npm ci || { echo "npm ci failed: is there a network?"; exit 1; }
    cp package-lock.json installed-lock.json
fi
exec node run.mjs "$@"
