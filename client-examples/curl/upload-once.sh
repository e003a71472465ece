#!/bin/sh
# Uploads a shape once and runs two jobs on it.
#
#   upload-once.sh scan.ply denoised.ply dense.ply
set -eu
. "$(dirname "$0")/lpf.sh"

# The same bytes get the same ID: uploading them again is answered 200 instead of 201.
shape=$(curl -sS --fail-with-body --data-binary "@$1" "$LPF_URL/v1/shapes" | json_value id)
echo "shape $shape"

# run PROCESS INPUTS: starts a job on the shape; prints its ID. The inputs are JSON here, the same
# names as in a query string.
run() {
    curl -sS --fail-with-body -H 'Content-Type: application/json' \
        --data "{\"inputs\": {\"shape\": \"$shape\"$2}}" \
        "$LPF_URL/v1/processes/$1/execution" | json_value jobID
}
denoising=$(run denoise '')
resampling=$(run resample ', "factor": 2, "format": "ply"')
echo "jobs $denoising and $resampling"

wait_for "$denoising"
curl -sS --fail-with-body -o "$2" "$LPF_URL/v1/jobs/$denoising/results/points"
wait_for "$resampling"
curl -sS --fail-with-body -o "$3" "$LPF_URL/v1/jobs/$resampling/results/points"
echo "The results are in $2 and $3"
