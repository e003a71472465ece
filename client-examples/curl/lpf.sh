# What the examples share. Needs sh, curl, grep and sed; no jq. Its variables begin with lpf_, because
# functions of sh have none of their own.
# shellcheck shell=sh

# Where the service is.
LPF_URL=${LPF_URL:-http://127.0.0.1:8080}

# json_value NAME: the first member of that name in the JSON on stdin, strings without quotes.
# Enough for flat answers such as these; for more, use jq.
json_value() {
    tr -d '\n' | grep -oE "\"$1\" *: *(\"([^\"\\\\]|\\\\.)*\"|[^],} ]+)" | head -n 1 |
        sed -E "s/^\"$1\" *: *//; s/^\"(.*)\"\$/\1/"
}

# job_status: of the job on stdin.
job_status() {
    grep -oE '"status" *: *"(accepted|running|successful|failed|dismissed)"' | cut -d '"' -f 4
}

# submit PATH-AND-QUERY FILE: uploads a file as a job, prints the job's ID; says why if it cannot.
submit() {
    lpf_answer=$(curl -sS --fail-with-body --data-binary "@$2" "$LPF_URL$1") || {
        printf '%s\n' "$lpf_answer" | json_value detail >&2
        return 1
    }
    printf '%s\n' "$lpf_answer" | json_value jobID
}

# wait_for JOB: returns once the job is successful; otherwise says why not, and fails.
# "Prefer: wait" lets the service hold the answer back until the job ends, or the seconds are over.
wait_for() {
    while true; do
        lpf_job=$(curl -sS --fail-with-body -H 'Prefer: wait=20' "$LPF_URL/v1/jobs/$1") || return 1
        case $(printf '%s' "$lpf_job" | job_status) in
            successful) return 0 ;;
            failed | dismissed)
                printf '%s\n' "$lpf_job" | json_value detail >&2
                return 1 ;;
        esac
        echo "$(printf '%s' "$lpf_job" | json_value progress) % done" >&2
        sleep 1  # also when the service answers at once
    done
}
