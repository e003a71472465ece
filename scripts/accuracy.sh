#!/usr/bin/env bash
# Measures the error that is left on scans with a known answer, denoised and resampled with no
# parameter given, and prints a table in Markdown. Half a minute for each seed. docs/accuracy.md
# keeps what it printed.
#
#   scripts/accuracy.sh --fandisk fandisk.ply --seeds 1,2,3,4,5
#   scripts/accuracy.sh --only cube,resampling
#   scripts/accuracy.sh --help                                 all options and cases
set -euo pipefail
here=$PWD
cd "$(dirname "$0")/.."

scripts/install-dependencies.sh >&2
cmake --preset release >&2
cmake --build --preset release --target lpf-accuracy >&2
program=$PWD/build/release/bin/lpf-accuracy
cd "$here"
exec "$program" "$@"
