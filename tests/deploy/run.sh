#!/usr/bin/env bash
# Checks the Kubernetes manifests: run.sh WORK_FOLDER
# Exit code 77: this machine has no npm, so that nothing could be checked.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
# shellcheck source=tests/npm_copy.sh
. "$here/../npm_copy.sh"
enter_npm_copy "$here" "$1"
LPF_MANIFESTS=$(cd "$here/../../deploy/kubernetes" && pwd) exec node --test manifests.test.mjs
