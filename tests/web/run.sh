#!/usr/bin/env bash
# Runs the tests of the web page in a real browser: run.sh WORK_FOLDER [TEST ...]
# LPF_SERVER_BINARY and LPF_PAGE_DIR name what is tested, LPF_CHROMIUM the browser.
# Exit code 77: this machine has no npm or no Chromium, so that nothing could be tested.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
# shellcheck source=tests/npm_copy.sh
. "$here/../npm_copy.sh"
work=$1
shift

export LPF_CHROMIUM=${LPF_CHROMIUM:-/usr/bin/chromium}
[ -x "$LPF_CHROMIUM" ] || { echo "skipped: there is no browser $LPF_CHROMIUM"; exit 77; }

enter_npm_copy "$here" "$work"
exec node run.mjs "$@"
