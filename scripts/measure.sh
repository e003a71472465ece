#!/usr/bin/env bash
# Measures the service as it is built: denoises simulated scans with automatic parameters over HTTP and
# prints a table for the README, with the machine and the commit. Takes about a minute.
#
#   scripts/measure.sh
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=scripts/demo-steps.sh
. scripts/demo-steps.sh

out=build/measure
rm -rf "$out"
mkdir -p "$out"
[ -x "$bin/lpf-server" ] || fail "there is no $bin/lpf-server yet; scripts/demo.sh --once builds it"
trap stop_server EXIT
start_server >&2

# measure SHAPE POINTS NOISE: one row.
measure() {
    local scan=$out/$1-$3.ply job before after
    "$bin/lpf-scan" simulate --shape "$1" --points "$2" --noise "$3" -o "$scan" >/dev/null
    job=$(submit denoise "$scan")
    follow "$job" >&2
    curl -sS -f -o "$out/after.ply" "$url/v1/jobs/$job/results/points"
    curl -sS -f -o "$out/report.json" "$url/v1/jobs/$job/results/report"
    before=$("$bin/lpf-scan" error "$scan" --shape "$1" | json_value rmse)
    after=$("$bin/lpf-scan" error "$out/after.ply" --shape "$1" | json_value rmse)
    awk -v shape="$1" -v points="$2" -v noise="$3" -v before="$before" -v after="$after" \
        -v seconds="$(total_seconds)" 'BEGIN {
        printf "| %s | %d | %s | %.4f | %.4f | %.1f | %.1f |\n",
            shape, points, noise, before, after, before / after, seconds }'
}

# The job's own time: the last "seconds" of the report (those of its phases come before it).
total_seconds() {
    grep -oE '"seconds":[0-9.e+-]+' "$out/report.json" | tail -n 1 | cut -d : -f 2
}

echo "| shape | points | noise | RMSE before | RMSE after | divided by | seconds |"
echo "|---|---|---|---|---|---|---|"
measure curvenet 400000 0.124
measure curvenet 400000 0.25
measure curvenet 400000 0.38
measure cube 150000 0.05
measure cube_with_curve 80000 0.01
measure sphere 100000 0.02

model=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)
echo
echo "$(nproc) cores of ${model:-an unnamed processor}, commit $(git rev-parse --short HEAD 2>/dev/null)"
