#!/usr/bin/env bash
# Compares the service with its peers (CGAL 5.5, PCL 1.13, MeshLab 2020.09, as Debian 12 has them) on the
# same simulated scans: error, coverage, CPU seconds, memory. Installs the peers, builds what runs
# them and the service, runs all that was not run before, and prints a table in Markdown; numbers
# for machines go to build/peers/peers.json. All of it takes hours.
#
#   scripts/bench-peers.sh --mesh fandisk.ply --write docs/peers.md
#   scripts/bench-peers.sh --shapes curvenet_124 --methods ours,pcl_mls
#   scripts/bench-peers.sh --methods ours,ours_resample     after a change of ours
#   scripts/bench-peers.sh --build                         nothing but the programs
#   scripts/bench-peers.sh --help                           all options, shapes and methods
set -euo pipefail
here=$PWD
cd "$(dirname "$0")/.."

packages=(libcgal-dev libeigen3-dev libpcl-dev meshlab xvfb)

install_peers() {
    local missing=() package status as_root=()
    for package in "${packages[@]}"; do
        status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
        [ "$status" = installed ] || missing+=("$package")
    done
    [ "${#missing[@]}" -gt 0 ] || return 0
    [ "$(id -u)" -eq 0 ] || as_root=(sudo)
    "${as_root[@]}" apt-get -q update
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q install -y \
        --no-install-recommends "${missing[@]}"
}

case " $* " in
    *" --help "* | *" -h "* | *" --table "*) ;;  # nothing is run
    *)
        scripts/install-dependencies.sh >&2
        install_peers >&2
        cmake --preset release >&2
        cmake --build --preset release --target lpf-server lpf-decode lpf-scan >&2
        cmake -S tests/bench/peers -B build/peers/programs -G Ninja >&2
        cmake --build build/peers/programs >&2
        ;;
esac
[ "${1:-}" != --build ] || exit 0
bench=$PWD/tests/bench/peers/bench.py
cd "$here" # its paths are the caller's
exec python3 "$bench" "$@"
