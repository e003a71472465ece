#!/usr/bin/env bash
# Installs what the build and the tests need from Debian's own packages. Does nothing when all is
# there. Elsewhere it says what is needed, and ends with exit code 1.
#
#   scripts/install-dependencies.sh          for building, the demo and the tests
#   scripts/install-dependencies.sh --dev    also the formatter and the linters
set -euo pipefail

packages=(
    # tools
    build-essential cmake ninja-build ccache pkg-config git ca-certificates curl
    # libraries of the product
    libeigen3-dev libnanoflann-dev libdraco-dev nlohmann-json3-dev libcpp-httplib-dev
    libssl-dev zlib1g-dev libsqlite3-dev libcli11-dev libseccomp-dev
    # tests and lpf-scan
    libgtest-dev libgmock-dev libpng-dev python3 python3-pytest python3-requests python3-jsonschema
    python3-prometheus-client nginx-light
)
# npm builds the web page. One that is not Debian's is as good.
command -v npm >/dev/null || packages+=(nodejs npm)
developer_packages=(clang-format clang-tidy clang libclang-rt-dev shellcheck)

explain() {
    cat >&2 <<TEXT
install-dependencies.sh: $1

It knows Debian 12 or newer (and Ubuntu 24.04 or newer), as root or with sudo. Elsewhere, please
install these by hand, then run the script that you came from again:
  a C++20 compiler (g++ 12, clang 14 or newer), CMake 3.25, Ninja, pkg-config, git, curl, Python 3
  Eigen 3.4, nanoflann 1.4, Draco 1.5, nlohmann-json 3.11, cpp-httplib 0.11, OpenSSL, zlib, SQLite 3,
  CLI11 2, libseccomp, GoogleTest, libpng, and for Python: pytest, requests, jsonschema
Under Debian their packages are:
  ${packages[*]}
TEXT
    exit 1
}

# Elsewhere with everything installed by hand there is nothing to do either.
have_the_tools() {
    local tool
    for tool in cmake ninja c++ pkg-config git curl python3; do
        command -v "$tool" >/dev/null || return 1
    done
}

case "${1:-}" in
    "") ;;
    --dev) packages+=("${developer_packages[@]}") ;;
    -h | --help) sed -n '2,6s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "install-dependencies.sh: unknown option $1 (--dev is all there is)" >&2; exit 2 ;;
esac

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    if have_the_tools; then
        echo "This is no Debian; the tools are there, and CMake will say if a library is missing."
        exit 0
    fi
    explain "this is no Debian, and tools are missing."
fi

# shellcheck source=/dev/null
. /etc/os-release
if [ "${ID:-}" = debian ] && [ -n "${VERSION_ID:-}" ] && [ "${VERSION_ID%%.*}" -lt 12 ]; then
    explain "Debian $VERSION_ID is too old: its CMake and compiler cannot build the project."
fi

# The web page is tested in a real browser; on Ubuntu it would be a snap.
[ "${ID:-}" != debian ] || packages+=(chromium)

missing=()
for package in "${packages[@]}"; do
    status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$status" = installed ] || missing+=("$package")
done
if [ "${#missing[@]}" -eq 0 ]; then
    echo "All ${#packages[@]} packages are there."
    exit 0
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || explain "not root, no sudo, and missing: ${missing[*]}"
    as_root=(sudo)
fi
echo "Installing ${#missing[@]} packages: ${missing[*]}"
apt() {
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o Acquire::Retries=3 "$@" </dev/null
}
apt update || explain "apt-get update failed: is there a network?"
apt install -y --no-install-recommends "${missing[@]}" || explain "apt-get could not install them."
