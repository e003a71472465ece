#!/bin/sh
# What the service says when a request is wrong. Every error is application/problem+json (RFC 9457):
# a stable "code" for programs, a "detail" for people, and "errors" that point at what is wrong.
#
#   errors.sh scan.ply
set -eu
. "$(dirname "$0")/lpf.sh"

# show TITLE CURL-ARGUMENTS...: prints the HTTP status and the answer.
show() {
    printf '\n%s\n' "$1"
    shift
    curl -sS -w '\nHTTP status %{http_code}\n' "$@"
}

show 'A parameter that does not exist' \
    --data-binary "@$1" "$LPF_URL/v1/processes/denoise/execution?radios=3"

show 'A parameter out of its range' \
    --data-binary "@$1" "$LPF_URL/v1/processes/denoise/execution?atoms=-4"

show 'A file that is neither PLY nor Draco' \
    --data-binary 'v 0 0 0' "$LPF_URL/v1/processes/denoise/execution"

show 'A PLY file that promises more points than it has' \
    --data-binary "$(printf 'ply\nformat ascii 1.0\nelement vertex 9\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0')" \
    "$LPF_URL/v1/processes/denoise/execution"

show 'A job that never was' "$LPF_URL/v1/jobs/no-such-job"
