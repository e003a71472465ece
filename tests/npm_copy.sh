# shellcheck shell=bash
# To be sourced: tests that run on npm packages.

# enter_npm_copy SOURCE WORK: goes to WORK, a copy of the modules of SOURCE with their packages, so
# that the source tree stays as it is. Installs only what has changed.
# Exit code 77: this machine has no npm, so that nothing can be tested.
enter_npm_copy() {
    command -v npm >/dev/null || { echo "skipped: npm is not there"; exit 77; }
    mkdir -p "$2"
    cp "$1"/*.mjs "$1"/package.json "$1"/package-lock.json "$1"/.npmrc "$2"
    cd "$2" || exit 1
    if ! cmp -s package-lock.json installed-lock.json; then
        npm ci || { echo "npm ci failed: is there a network?"; exit 1; }
        cp package-lock.json installed-lock.json
    fi
}
