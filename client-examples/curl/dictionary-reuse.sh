#!/bin/sh
# Learns a dictionary on one shape and denoises another with it, as it is.
#
#   dictionary-reuse.sh teacher.ply scan.ply cleaned.ply
set -eu
. "$(dirname "$0")/lpf.sh"

job=$(submit /v1/processes/analyze/execution "$1")
wait_for "$job"

# Every analysis leaves its dictionary behind, newest first in the list; its own says the job.
dictionary=$(curl -sS --fail-with-body "$LPF_URL/v1/jobs/$job/results/dictionary" | json_value id)
echo "dictionary $dictionary"
curl -sS --fail-with-body "$LPF_URL/v1/dictionaries" >/dev/null

# dictionaryMode=fixed keeps it; dictionaryMode=start (the default) only begins with it.
job=$(submit "/v1/processes/denoise/execution?dictionary=$dictionary&dictionaryMode=fixed" "$2")
wait_for "$job"
curl -sS --fail-with-body -o "$3" "$LPF_URL/v1/jobs/$job/results/points"
echo "The denoised points are in $3"
