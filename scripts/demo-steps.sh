# The steps of demo.sh. Uses its variables: out (folder of the results), url, server, points.
# shellcheck shell=bash
# shellcheck disable=SC2154  # out is set by demo.sh

bin=build/release/bin
server=''  # process ID
url=''
points=''  # file of the denoised points

step() { printf '\n== %s\n' "$*"; }

fail() {
    printf 'demo.sh: %s\n' "$*" >&2
    exit 1
}

# The value of a member of a JSON text on stdin: first occurrence, strings without their quotes.
json_value() {
    tr -d '\n' | grep -oE "\"$1\" *: *(\"([^\"\\\\]|\\\\.)*\"|-?[0-9.eE+-]+|true|false|null)" |
        head -n 1 | sed -E "s/^\"$1\" *: *//; s/^\"(.*)\"\$/\1/"
}

# The status of a job; an exception in it has a (numeric) status of its own.
job_status() {
    grep -oE '"status" *: *"(accepted|running|successful|failed|dismissed)"' | cut -d '"' -f 4
}

port_is_free() { ! (exec 3<>"/dev/tcp/127.0.0.1/$1") 2>/dev/null; }

start_server() {
    local port=0
    if port_is_free 8080; then port=8080; fi
    "$bin/lpf-server" --port "$port" --admin-port 0 --data-dir "$out/data" \
        >"$out/listening.json" 2>"$out/server.log" </dev/null &
    server=$!
    local waited
    for waited in $(seq 150); do
        if grep -q '"listening"' "$out/listening.json"; then
            url=http://127.0.0.1:$(json_value port <"$out/listening.json")
            return
        fi
        kill -0 "$server" 2>/dev/null || break
        sleep 0.2
    done
    tail -n 5 "$out/server.log" >&2
    fail "the server did not start within $((waited / 5)) s; its log is $out/server.log"
}

# Asks the server to finish, and waits until it has; after 35 s it is ended.
stop_server() {
    [ -n "$server" ] || return 0
    local pid=$server
    server=''
    kill -TERM "$pid" 2>/dev/null || true
    for _ in $(seq 350); do
        kill -0 "$pid" 2>/dev/null || break
        sleep 0.1
    done
    kill -KILL "$pid" 2>/dev/null || true
    wait "$pid" 2>/dev/null || true
    rm -rf "$out/data"
    echo "The server has stopped." >&2
}

# submit PROCESS FILE -> job ID
submit() {
    local answer=$out/submitted.json status
    status=$(curl -sS -o "$answer" -w '%{http_code}' -H 'Content-Type: application/octet-stream' \
        --data-binary "@$2" "$url/v1/processes/$1/execution") ||
        fail "the upload failed; the server's log is $out/server.log"
    if [ "$status" != 201 ]; then
        fail "the server answered $status: $(json_value detail <"$answer")"
    fi
    json_value jobID <"$answer"
}

# Polls a job, and shows each change of its phase and progress, until it has ended.
follow() {
    local answer=$out/job.json shown='' line status
    while true; do
        curl -sS -f -o "$answer" "$url/v1/jobs/$1" ||
            fail "the job cannot be asked for; the server's log is $out/server.log"
        status=$(job_status <"$answer")
        line="$(json_value progress <"$answer") %  $status  $(json_value phase <"$answer" || true)"
        if [ "$line" != "$shown" ]; then printf '  %s\n' "$line"; fi
        shown=$line
        case "$status" in
            successful) return ;;
            failed | dismissed) fail "the job has $status: $(json_value detail <"$answer")" ;;
        esac
        sleep 0.5
    done
}

# fetch_results JOB INPUT: points in the input's own format, dictionary, report.
fetch_results() {
    local results=$url/v1/jobs/$1/results ending=ply
    if [ "$(head -c 5 "$2")" = DRACO ]; then ending=drc; fi
    points=$out/denoised.$ending
    curl -sS -f -o "$points" "$results/points" || fail "the points could not be fetched"
    curl -sS -f -o "$out/dictionary.json" "$results/dictionary" ||
        fail "the dictionary could not be fetched"
    curl -sS -f -o "$out/report.json" "$results/report" || fail "the report could not be fetched"
    wc -c "$points" "$out/dictionary.json" "$out/report.json" | head -n 3
}

# print_errors BEFORE AFTER: distances to the exact shape that was scanned.
print_errors() {
    "$bin/lpf-scan" error "$1" --shape curvenet >"$out/error-before.json"
    "$bin/lpf-scan" error "$2" --shape curvenet >"$out/error-after.json"
    local name before after
    for name in rmse p95 max; do
        before=$(json_value "$name" <"$out/error-before.json")
        after=$(json_value "$name" <"$out/error-after.json")
        awk -v name="$name" -v before="$before" -v after="$after" 'BEGIN {
            printf "error %-5s before %.4f   after %.4f", name, before, after
            if (after > 0) printf "   divided by %.1f", before / after
            print "" }'
    done
    echo "(distances to the exact shape, whose diagonal is $(json_value diagonal \
        <"$out/error-before.json"))"
}

# print_displacement REPORT: how far the points were moved.
print_displacement() {
    local name part
    part=$(tr -d '\n' <"$1" | grep -oE '"displacement" *: *\{[^}]*\}') ||
        fail "the report $1 says nothing of displacements"
    for name in rms mean p50 p90 p99 max; do
        printf 'moved %-5s %s\n' "$name" "$(json_value "$name" <<<"$part")"
    done
    echo "(in the units of the file)"
}
