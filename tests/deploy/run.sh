#!/usr/bin/env bash
# Checks the Kubernetes manifests: run.sh WORK_FOLDER
# Exit code 77: this machine has no npm, so that nothing could be checked.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=$1
command -v npm >/dev/null || { echo "skipped: npm is not there"; exit 77; }

# In a copy, so that the source tree stays as it is.
mkdir -p "$work"
cp "$here"/*.mjs "$here"/package.json "$here"/package-lock.json "$here"/.npmrc "$work"
cd "$work"
if ! cmp -s package-lock.json installed-lock.json; then
    npm ci || { echo "npm ci failed: is there a network?"; exit 1; }
    cp package-lock.json installed-lock.json
fi
LPF_MANIFESTS=$(cd "$here/../../deploy/kubernetes" && pwd) exec node --test manifests.test.mjs
