#!/bin/sh
# Makes a cloud denser (or sparser), evenly spaced.
#
#   resample.sh scan.ply dense.ply [FACTOR]
#
# The wish is one of: factor (times the number of points), targetPoints (their number), or
# targetSpacing (their least distance, in the unit of the file). Attributes such as colours come
# from the nearest point of the scan.
set -eu
. "$(dirname "$0")/lpf.sh"

job=$(submit "/v1/processes/resample/execution?factor=${3:-4}" "$1")
echo "job $job"
wait_for "$job"
curl -sS --fail-with-body -o "$2" "$LPF_URL/v1/jobs/$job/results/points"
echo "The resampled points are in $2"
