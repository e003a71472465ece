#!/usr/bin/env bash
# Builds with sanitizers and runs every test under them. Takes far longer than scripts/test.sh, so
# continuous integration leaves it out; run it before a release and after work on memory or threads.
#
#   scripts/sanitize.sh asan [CTEST OPTION ...]    addresses and undefined behaviour (the default)
#   scripts/sanitize.sh tsan [CTEST OPTION ...]    data races
#
# Fails when a test fails, and also when a program reported something to a file and no test looked,
# such as a leak of a server whose exit code no test asks for. Undefined behaviour ends its program
# and is told on standard error, in the output of the failed test.
set -euo pipefail
cd "$(dirname "$0")/.."

preset=${1:-asan}
shift || true
case "$preset" in
    asan | tsan) ;;
    *) echo "usage: scripts/sanitize.sh [asan|tsan] [ctest option ...]" >&2; exit 2 ;;
esac

scripts/install-dependencies.sh

# Each program writes what it finds to a file of its own here.
reports=$PWD/build/$preset/reports
rm -rf "$reports"
mkdir -p "$reports"
export ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1:detect_stack_use_after_return=1
export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
export TSAN_OPTIONS=halt_on_error=1:second_deadlock_stack=1:suppressions=$PWD/tests/tsan.supp

# Under the wide address randomisation of new kernels, g++ 12's thread sanitizer finds its memory
# taken and gives up; its programs also run while building, when the tests are listed.
run=()
[ "$preset" = tsan ] && run=(setarch "$(uname -m)" --addr-no-randomize)
begin=$SECONDS
"${run[@]}" cmake --preset "$preset"
"${run[@]}" cmake --build --preset "$preset" -j "$(nproc)"
built=$SECONDS

ASAN_OPTIONS+=:log_path=$reports/address
TSAN_OPTIONS+=:log_path=$reports/thread
status=0
"${run[@]}" ctest --preset "$preset" -j "$(nproc)" --timeout 1800 --no-tests=error "$@" \
    </dev/null || status=$?

found=$(find "$reports" -type f -size +0 | wc -l)
echo
echo "$preset: built in $((built - begin)) s, tested in $((SECONDS - built)) s."
if [ "$found" -ne 0 ]; then
    grep -hE '^SUMMARY|runtime error:|ERROR: |WARNING: ' -r "$reports" | sort | uniq -c || true
    echo "The sanitizers wrote $found reports to $reports." >&2
elif [ "$status" -eq 0 ]; then
    echo "All tests passed, and the sanitizers have nothing to report."
else
    echo "Tests failed; the sanitizers have nothing to report." >&2
fi
[ "$status" -eq 0 ] && [ "$found" -eq 0 ]
