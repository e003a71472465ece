#!/bin/sh
# Learns what a shape is made of: a dictionary of local shapes, and for each probing field where it
# sits, how it is turned, and which atoms of the dictionary it uses.
#
#   analyze.sh scan.ply dictionary.json fields.ply [ATOMS]
set -eu
. "$(dirname "$0")/lpf.sh"

job=$(submit "/v1/processes/analyze/execution?atoms=${4:-16}" "$1")
echo "job $job"
wait_for "$job"

results=$LPF_URL/v1/jobs/$job/results

# patternPoints: M x 3, atoms: d x M x 3, both in units of the radius; usage; energy per iteration.
curl -sS --fail-with-body -o "$2" "$results/dictionary"
echo "The dictionary is in $2"

# A PLY with one vertex per field: frame, residual, and its sparse code as list properties.
curl -sS --fail-with-body -o "$3" "$results/fields"
echo "The fields are in $3"
