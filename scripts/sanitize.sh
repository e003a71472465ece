#!/usr/bin/env bash
# Builds with sanitizers and runs every test under them.
#
#   scripts/sanitize.sh asan [CTEST OPTION ...]    addresses and undefined behaviour (the default)
#   scripts/sanitize.sh tsan [CTEST OPTION ...]    data races
set -euo pipefail
cd "$(dirname "$0")/.."

preset=${1:-asan}
shift || true
case "$preset" in
    asan | tsan) ;;
    *) echo "usage: scripts/sanitize.sh [asan|tsan] [ctest option ...]" >&2; exit 2 ;;
esac

scripts/install-dependencies.sh
export ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1:detect_stack_use_after_return=1
export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
export TSAN_OPTIONS=halt_on_error=1:second_deadlock_stack=1

# Under the wide address randomisation of new kernels, g++ 12's thread sanitizer finds its memory
# taken and gives up; its programs also run while building, when the tests are listed.
run=()
[ "$preset" = tsan ] && run=(setarch "$(uname -m)" --addr-no-randomize)
"${run[@]}" cmake --preset "$preset"
"${run[@]}" cmake --build --preset "$preset" -j "$(nproc)"
"${run[@]}" ctest --preset "$preset" -j "$(nproc)" --timeout 1800 --no-tests=error "$@" </dev/null
