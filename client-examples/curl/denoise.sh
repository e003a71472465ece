#!/bin/sh
# Denoises a scan without knowing anything about it: no unit, no radius, no noise level.
#
#   denoise.sh scan.ply cleaned.ply
#
# The result has the same points in the same order, with all their attributes.
set -eu
. "$(dirname "$0")/lpf.sh"

# Every parameter is "auto" unless it is in the query string, e.g. ?radius=8&radiusUnit=spacing
job=$(submit /v1/processes/denoise/execution "$1")
echo "job $job"

wait_for "$job"

curl -sS --fail-with-body -o "$2" "$LPF_URL/v1/jobs/$job/results/points"
echo "The denoised points are in $2"

# The report says which parameters were chosen and why, and how far points were moved.
curl -sS --fail-with-body "$LPF_URL/v1/jobs/$job/results/report" >"$2.report.json"
echo "The report is in $2.report.json"
