#!/usr/bin/env bash
# Installs what is missing, builds everything with warnings as errors, and runs every test: units,
# wire, server, end to end, curl examples, and the checks of the source tree.
#
#   scripts/test.sh [CTEST OPTION ...]     e.g. scripts/test.sh -R Denoise
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install-dependencies.sh
cmake --preset release -DLPF_WERROR=ON
cmake --build --preset release -j "$(nproc)"

begin=$SECONDS
log=build/release/tests.log
status=0
ctest --preset release -j "$(nproc)" --timeout 600 --no-tests=error "$@" </dev/null 2>&1 |
    tee "$log" || status=$?

# "96% tests passed, 2 tests failed out of 51"
summary=$(grep -E 'tests passed, [0-9]+ tests failed out of [0-9]+' "$log" | tail -n 1 || true)
total=${summary##*out of }
failed=$(sed -E 's/.*, ([0-9]+) tests failed.*/\1/' <<<"$summary")
echo
if [ "$status" -eq 0 ]; then
    echo "All $total tests passed in $((SECONDS - begin)) s."
else
    echo "${failed:-?} of ${total:-?} tests failed in $((SECONDS - begin)) s; the log is $log." >&2
fi
exit "$status"
