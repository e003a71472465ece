#!/usr/bin/env bash
# An independent check of the contract: runs the black-box suite through prism, a proxy by others
# that holds every request and every answer against the served OpenAPI document. Needs npm.
#
#   scripts/check-contract.sh [PYTEST OPTION ...]     e.g. scripts/check-contract.sh -k uploads
#
#   LPF_BUILD_DIR   where bin/lpf-server lies (build/release)
#
# Three things prism cannot do, and so does not see:
#   - binary bodies: it decodes every body as text, which changes their bytes. Answers of the types
#     in `binary` below go around it, by a small relay in front; their status, headers and content
#     are checked by tests/e2e/contract.py.
#   - event streams: it reads an answer to its end before it passes anything on; the same relay.
#   - what is no valid request by the document, such as a misspelt parameter: prism would refuse it
#     by itself. So violations of requests are counted only where the server accepted them.
set -euo pipefail
cd "$(dirname "$0")/.."
exec /usr/bin/python3 tests/contract/run.py "$@"
