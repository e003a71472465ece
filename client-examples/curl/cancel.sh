#!/bin/sh
# Starts a long job and takes it back. A running job stops within a second.
#
#   cancel.sh scan.ply
set -eu
. "$(dirname "$0")/lpf.sh"

# Many iterations, so that there is something to cancel.
job=$(submit '/v1/processes/analyze/execution?analysisIterations=1000' "$1")
echo "job $job"

# Wait until it runs.
while [ "$(curl -sS "$LPF_URL/v1/jobs/$job" | job_status)" = accepted ]; do sleep 0.2; done

curl -sS --fail-with-body -X DELETE "$LPF_URL/v1/jobs/$job" | job_status

# From now on it is gone: 410, and the answer says that it was dismissed.
curl -sS -w '\n%{http_code}\n' "$LPF_URL/v1/jobs/$job"
