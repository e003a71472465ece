#!/usr/bin/env bash
# Reruns the experiments of the paper and writes docs/experiments.md with its pictures. Builds what it
# needs. Takes about ten minutes on two cores.
#
#   scripts/paper.sh [--fandisk FILE] [--only NAME]... [--size SHARE]
#
#   --fandisk FILE   the paper's Fandisk mesh (PLY or Draco); without it a body made here stands in
#   --only NAME      this experiment alone (repeat for several); written to build/paper instead
#   --size SHARE     with fewer points and runs, e.g. 0.1; written to build/paper instead
# BUILD_DIR names another build folder than build/release.
set -euo pipefail
here=$PWD
cd "$(dirname "$0")/.."

build=${BUILD_DIR:-build/release}
output=docs/experiments.md
options=()
while [ $# -gt 0 ]; do
    case "$1" in
        -h | --help) sed -n '2,10s/^# \{0,1\}//p' scripts/paper.sh; exit 0 ;;
        --fandisk | --only | --size) ;;
        *) echo "paper.sh: unknown option $1; --help tells what there is" >&2; exit 2 ;;
    esac
    [ $# -ge 2 ] || { echo "paper.sh: $1 needs a value" >&2; exit 2; }
    value=$2
    if [ "$1" = --fandisk ]; then
        [ "${value#/}" != "$value" ] || value=$here/$value
    else
        output=build/paper/experiments.md
    fi
    options+=("$1" "$value")
    shift 2
done
pictures=docs/pictures/experiments
[ "$output" = docs/experiments.md ] || pictures=build/paper/pictures
mkdir -p "$pictures"

[ -f "$build/build.ninja" ] || cmake --preset release -B "$build" >/dev/null
cmake --build "$build" -j "$(nproc)" --target lpf-paper

model=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)
commit=$(git rev-parse --short HEAD 2>/dev/null || echo unknown)
[ -z "$(git status --porcelain -- core tests/paper tests/support 2>/dev/null)" ] ||
    commit="$commit with changes"
"$build/bin/lpf-paper" --output "$output" --pictures "$pictures" --threads "$(nproc)" \
    --machine "$(nproc) cores of ${model:-an unnamed processor}" --commit "$commit" "${options[@]}"
