#!/usr/bin/env bash
# Fuzzes what reads bytes of strangers, with clang's libFuzzer, address and undefined-behaviour
# sanitizers. Ends with exit code 1 at a finding, which is left in build/fuzz/findings/TARGET.
#
#   scripts/fuzz.sh TARGET|all [SECONDS]     seconds of each target; 60 if not given
#
# Targets: ply draco json head multipart range. What was found belongs into tests/fuzz/corpus/TARGET
# together with its repair: every test run replays it.
# BUILD_DIR names another build folder than build/fuzz.
set -euo pipefail
cd "$(dirname "$0")/.."

targets=(ply draco json head multipart range)
chosen=${1:-}
seconds=${2:-60}
usage() { sed -n '5,10s/^# \{0,1\}//p' "$0" >&2; exit 2; }
case " ${targets[*]} all " in
    *" $chosen "*) [ -n "$chosen" ] || usage ;;
    *) usage ;;
esac
[[ "$seconds" =~ ^[1-9][0-9]*$ ]] || usage
[ "$chosen" = all ] || targets=("$chosen")

for tool in clang++ cmake ninja; do
    command -v "$tool" >/dev/null || {
        echo "fuzz.sh: $tool is missing; run scripts/install-dependencies.sh --dev" >&2
        exit 2
    }
done

build=${BUILD_DIR:-build/fuzz}
[ -f "$build/build.ninja" ] || cmake --preset fuzz -B "$build" >/dev/null
# shellcheck disable=SC2068  # the words are to be split
ninja -C "$build" ${targets[@]/#/fuzz-} ${targets[@]/#/replay-} >"$build/fuzz-build.log" || {
    tail -n 40 "$build/fuzz-build.log" >&2
    exit 2
}

export ASAN_OPTIONS=detect_leaks=1
export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1

# An input may take 10 s and 1 GiB, and one allocation 256 MiB: limits are checked before that.
fuzz() {
    local target=$1 corpus=$build/corpus/$1 findings=$build/findings/$1 log=$build/$1.log
    mkdir -p "$corpus" "$findings"
    "$build/bin/replay-$target" --write-seeds "$build/seeds/$target"
    "$build/bin/fuzz-$target" "$corpus" "$build/seeds/$target" "tests/fuzz/corpus/$target" \
        -dict="tests/fuzz/dictionaries/$target.dict" -max_total_time="$seconds" -max_len=4096 \
        -timeout=10 -rss_limit_mb=1024 -malloc_limit_mb=256 -print_final_stats=1 \
        -artifact_prefix="$findings/" >"$log" 2>&1
}

status=0
for target in "${targets[@]}"; do
    begin=$SECONDS
    verdict="no finding"
    fuzz "$target" || { verdict="A FINDING"; status=1; }
    runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$build/$target.log")
    echo "$target: ${runs:-?} executions in $((SECONDS - begin)) s, $verdict"
    [ "$verdict" = "no finding" ] || tail -n 60 "$build/$target.log"
done
exit "$status"
