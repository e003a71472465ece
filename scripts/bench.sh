#!/usr/bin/env bash
# Measures whole jobs and the stages they are made of, and prints both as Markdown: CPU and wall
# seconds, memory, points a second, the share of each phase, nanoseconds of each stage, the share of
# the peak rate. About two minutes. docs/performance.md keeps what it printed.
#
#   scripts/bench.sh                     the usual cases
#   scripts/bench.sh --cases net,large   others; --help lists them
#   scripts/bench.sh --peers             PCL's moving least squares on the same file in the same run
set -euo pipefail
cd "$(dirname "$0")/.."

bin=build/release/bin
options=()
peers=no
for argument in "$@"; do
    case "$argument" in
        --peers) peers=yes ;;
        -h | --help) sed -n '2,8s/^# \{0,1\}//p' "$0"; exec python3 tests/bench/jobs/bench.py cost --help ;;
        *) options+=("$argument") ;;
    esac
done

as_root=()
[ "$(id -u)" -eq 0 ] || as_root=(sudo)
scripts/install-dependencies.sh >&2
if [ "$(dpkg-query -W -f='${db:Status-Status}' libbenchmark-dev 2>/dev/null || true)" != installed ]; then
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q install -y libbenchmark-dev >&2
fi
cmake --preset release >&2
cmake --build --preset release --target lpf-job-cost lpf-decode lpf-scan lpf-stages >&2
if [ "$peers" = yes ]; then
    scripts/bench-peers.sh --build >&2
    options+=(--pcl build/peers/programs/pcl-peer)
fi

model=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)
echo "$(nproc) cores of ${model:-an unnamed processor}, commit $(git rev-parse --short HEAD 2>/dev/null)"
echo
python3 tests/bench/jobs/bench.py cost "$bin" ${options[@]+"${options[@]}"}
echo
echo '```'
"$bin/lpf-stages" 2>/dev/null
echo '```'
