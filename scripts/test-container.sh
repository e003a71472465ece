#!/usr/bin/env bash
# Builds the image and proves it: size, rights and health; the whole black-box suite of tests/e2e
# against running containers; stops, kills and restarts with the volume kept; a limit of 512 MB and
# one core. Uses Docker where its daemon answers, else Podman and Buildah, which it installs, with a
# base image of Debian's packages where no registry is reached.
#
#   scripts/test-container.sh            all of it
#   scripts/test-container.sh --smoke    the image, its rights, health and a denoising
#
#   LPF_CONTAINER_DIR   folder of Podman's images and volumes (/tmp/lpf-containers)
#   LPF_BASE_IMAGE      base image (debian:bookworm-slim)
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=scripts/container-engine.sh
. scripts/container-engine.sh

smoke=no
case "${1:-}" in
    "") ;;
    --smoke) smoke=yes ;;
    -h | --help) sed -n '2,11s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "test-container.sh: unknown option $1 (--smoke is all there is)" >&2; exit 2 ;;
esac

base=${LPF_BASE_IMAGE:-debian:bookworm-slim}
image=lpf-server:test
log=build/container
mkdir -p "$log"

step() {
    printf '\n[%4d s] %s\n' "$SECONDS" "$*"
}

# The version has one place, the CMake project.
version=$(sed -n 's/^project(lpf VERSION \([0-9.]*\) .*/\1/p' CMakeLists.txt)
commit=$(git rev-parse HEAD 2>/dev/null || echo unknown)
export LPF_IMAGE=$image LPF_COMMIT=$commit PYTHONDONTWRITEBYTECODE=1

# suite NAME PYTEST_ARGUMENT...: runs tests, none of which may be left out.
suite() {
    local name=$1 report=$log/$1.log collected passed
    shift
    collected=$(/usr/bin/python3 -m pytest -q -p no:cacheprovider --collect-only "$@" |
        grep -c '::')
    /usr/bin/python3 -m pytest -q -rP -p no:cacheprovider "$@" >"$report" 2>&1 || {
        tail -n 60 "$report"
        echo "test-container.sh: the $name suite failed; its log is $report" >&2
        return 1
    }
    passed=$(grep -oE '[0-9]+ passed' "$report" | tail -n 1)
    grep -E '^(SIGTERM|SIGKILL|at most|denoise|resample|analyze)' "$report" || true
    echo "$name: $passed of $collected tests"
    [ "$passed" = "$collected passed" ] || {
        echo "test-container.sh: tests of the $name suite were left out; see $report" >&2
        return 1
    }
}

server=lpf-test-suite
remove_server() {
    [ -z "$engine" ] || "$engine" rm --force --volumes "$server" >/dev/null 2>&1 || true
}

free_port() {
    /usr/bin/python3 -c 'import socket; s = socket.create_server(("127.0.0.1", 0)); print(s.getsockname()[1])'
}

# A container as docs/deploy.md runs it, on this machine's network; sets LPF_URL.
run_server() {
    local port admin
    port=$(free_port) admin=$(free_port)
    remove_server
    trap remove_server EXIT
    "$engine" run --detach --name "$server" --network host --env "LPF_PORT=$port" \
        --env "LPF_ADMIN_PORT=$admin" --env LPF_DISK_FLOOR_BYTES=0 --env LPF_DISK_FLOOR_PERCENT=0 \
        --read-only --tmpfs /tmp --cap-drop ALL --security-opt no-new-privileges "$image" >"$log/engine.log" 2>&1
    export LPF_URL=http://127.0.0.1:$port
    for _ in $(seq 100); do
        curl -sf -o /dev/null "$LPF_URL/healthz" && return
        sleep 0.1
    done
    cat "$log/engine.log" >&2
    "$engine" logs "$server" >&2
    return 1
}

step "Installing what is missing"
scripts/install-dependencies.sh
choose_engine
export LPF_ENGINE=$engine
echo "Images are built and run by $engine"

step "The base image"
provide_base "$base"

step "Building $image, version $version"
build_image "$image" --build-arg "BASE_IMAGE=$base" --build-arg "VERSION=$version" \
    --build-arg "COMMIT=$commit" >"$log/build.log" 2>&1 || {
    tail -n 60 "$log/build.log"
    exit 1
}
size=$("$engine" image inspect --format '{{.Size}}' "$image")
echo "$((size / 1000000)) MB"

step "The image, its rights and its health"
suite image tests/container/test_image.py
if [ "$smoke" = yes ]; then
    step "The smoke test passed; without --smoke the whole suite runs"
    exit 0
fi

step "The black-box suite against containers"
run_server
suite black-box tests/e2e
remove_server

step "Stops, kills and restarts"
suite stops tests/container/test_stops.py

step "512 MB and one core"
suite memory tests/container/test_memory.py

step "All of it passed: an image of $((size / 1000000)) MB, in $SECONDS s"
