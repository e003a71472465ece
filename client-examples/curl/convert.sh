#!/bin/sh
# Fetches one result in several formats: binary PLY, readable PLY, Draco.
#
#   convert.sh scan.ply RESULT    writes RESULT.ply, RESULT.ascii.ply and RESULT.drc
#
# Draco files are smaller by several times. Points keep their order in all of them.
set -eu
. "$(dirname "$0")/lpf.sh"

job=$(submit /v1/processes/denoise/execution "$1")
wait_for "$job"

points=$LPF_URL/v1/jobs/$job/results/points
curl -sS --fail-with-body -o "$2.ply" "$points?format=ply"
curl -sS --fail-with-body -o "$2.ascii.ply" "$points?format=ply-ascii"

# The same by content negotiation.
curl -sS --fail-with-body -o "$2.drc" -H 'Accept: application/vnd.draco' "$points"

wc -c "$2.ply" "$2.ascii.ply" "$2.drc"
