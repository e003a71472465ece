#!/bin/sh
# The shortest way: one request, the points come back in its answer.
#
#   one-liner.sh scan.ply cleaned.ply
#
# "Prefer: wait=60" asks the service to answer with the result if it is done within 60 seconds.
# If it is not, the answer is 201 and describes the job: then go on as in denoise.sh.
set -eu
. "$(dirname "$0")/lpf.sh"

status=$(curl -sS -o "$2" -w '%{http_code}' -H 'Prefer: wait=60' \
    --data-binary "@$1" "$LPF_URL/v1/processes/denoise/execution")

case $status in
    200) echo "The denoised points are in $2" ;;
    201) echo "Not done yet; this is the job:"; cat "$2" ;;
    *) echo "The service answered $status: $(json_value detail <"$2")" >&2; exit 1 ;;
esac
