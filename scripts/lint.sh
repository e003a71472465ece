#!/usr/bin/env bash
# Runs shellcheck on the scripts and clang-tidy on the C++ (slow: minutes for all files).
#
#   scripts/lint.sh [FILE.cpp ...]    without files: every .cpp of core, api and server
set -euo pipefail
cd "$(dirname "$0")/.."

mapfile -t shell < <(git ls-files '*.sh' .ci/run)
shellcheck --external-sources --source-path=SCRIPTDIR "${shell[@]}"
echo "${#shell[@]} shell scripts are clean."

files=("$@")
[ "${#files[@]}" -gt 0 ] || mapfile -t files < <(git ls-files 'core/*.cpp' 'api/*.cpp' 'server/*.cpp')
cmake --preset dev >/dev/null
printf '%s\0' "${files[@]}" | xargs -0 -n 4 -P "$(nproc)" clang-tidy --quiet -p build/dev
echo "${#files[@]} C++ files are clean."
