#!/usr/bin/env bash
# Shows the service at work: installs what is missing, builds, starts the server on an empty data
# folder, denoises FILE (or a noisy scan that it simulates), says what was achieved and where the
# results are, and keeps serving until Ctrl-C.
#
#   scripts/demo.sh [FILE] [--once]
#
#   FILE     a PLY or Draco shape of yours
#   --once   stop the server at the end
set -euo pipefail
here=$PWD
cd "$(dirname "$0")/.."
# shellcheck source=scripts/demo-steps.sh
. scripts/demo-steps.sh

file='' once=no
for argument in "$@"; do
    case "$argument" in
        --once) once=yes ;;
        -h | --help) sed -n '2,9s/^# \{0,1\}//p' scripts/demo.sh; exit 0 ;;
        -*) fail "unknown option $argument (--once is all there is)" ;;
        /*) file=$argument ;;
        *) file=$here/$argument ;;
    esac
done
[ -z "$file" ] || [ -r "$file" ] || fail "the file $file cannot be read"

out=build/demo
rm -rf "$out"
mkdir -p "$out"

step "Installing what is missing"
scripts/install-dependencies.sh

step "Building"
cmake --preset release >"$out/configure.log" || fail "CMake failed; see $out/configure.log"
cmake --build --preset release -j "$(nproc)" --target lpf-server lpf-decode lpf-scan web

simulated=no
if [ -z "$file" ]; then
    step "Simulating a scan of a wavy sheet under a net of curves, with noise of 0.5 % of its size"
    file=$out/noisy.ply simulated=yes
    "$bin/lpf-scan" simulate --shape curvenet --points 200000 --noise 0.25 --seed 1 \
        -o "$file" --clean "$out/clean.ply" >"$out/simulated.json"
fi

step "Starting the server"
trap stop_server EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
start_server
echo "It listens on $url"

step "Denoising $(basename "$file") ($(wc -c <"$file") bytes), all parameters automatic"
begin=$SECONDS
job=$(submit denoise "$file")
echo "POST $url/v1/processes/denoise/execution -> job $job"
follow "$job"
took=$((SECONDS - begin))

step "Fetching the results"
fetch_results "$job" "$file"

step "What was achieved, in $took s"
if [ "$simulated" = yes ]; then
    print_errors "$file" "$points"
else
    print_displacement "$out/report.json"
fi
cat <<TEXT

Points      $points
Dictionary  $out/dictionary.json
Report      $out/report.json
TEXT
[ "$simulated" = no ] || echo "Before      $file (without noise: $out/clean.ply)"

if [ "$once" = yes ]; then
    exit 0
fi
cat <<TEXT
Web page    $url/
Try         curl --data-binary @scan.ply '$url/v1/processes/denoise/execution'

Serving until Ctrl-C.
TEXT
trap 'exit 0' INT
wait "$server" || true
fail "the server has stopped by itself; its log is $out/server.log"
