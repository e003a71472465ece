#!/usr/bin/env bash
# Formats the C++ of the project.
#
#   scripts/format.sh check    lists files that are not formatted; exit code 1 if there are any
#   scripts/format.sh apply    formats them
set -euo pipefail
cd "$(dirname "$0")/.."

command -v clang-format >/dev/null || {
    echo "format.sh: clang-format is missing; scripts/install-dependencies.sh --dev installs it" >&2
    exit 1
}
mapfile -t files < <(git ls-files '*.h' '*.cpp' | grep -vE '(^|/)(vendor|third_party)/')
[ "${#files[@]}" -gt 0 ] || { echo "format.sh: no files" >&2; exit 1; }
case "${1:-check}" in
    check) clang-format --dry-run --Werror "${files[@]}" && echo "${#files[@]} files are formatted." ;;
    apply) clang-format -i "${files[@]}" ;;
    *) echo "usage: scripts/format.sh [check|apply]" >&2; exit 2 ;;
esac
