#!/usr/bin/env bash
# Says what the working tree costs or gains against another revision: builds both, runs the same jobs
# with both in turns, and prints CPU, wall, memory and phases of each, and their ratio.
#
#   scripts/bench-compare.sh REV [--cases net,cube] [--runs 5]
set -euo pipefail
cd "$(dirname "$0")/.."

case "${1:-}" in
    "" | -h | --help) sed -n '2,5s/^# \{0,1\}//p' "$0"; exit 2 ;;
esac
commit=$(git rev-parse --verify --quiet "$1^{commit}") || {
    echo "bench-compare.sh: there is no revision $1" >&2
    exit 2
}
shift
before=build/compare/$commit
if [ ! -d "$before" ]; then
    git worktree prune
    git worktree add --detach "$before" "$commit" >&2
fi
if [ ! -d "$before/tests/bench/jobs" ]; then
    echo "bench-compare.sh: ${commit:0:10} is older than lpf-job-cost, which measures jobs" >&2
    exit 2
fi
for tree in "$before" .; do
    (cd "$tree" && cmake --preset release && cmake --build --preset release \
        --target lpf-job-cost lpf-decode lpf-scan) >&2
done
exec python3 tests/bench/jobs/bench.py compare "$before/build/release/bin" build/release/bin "$@"
