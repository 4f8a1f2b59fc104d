# shellcheck shell=bash
# Messages for people. Sourced by the other scripts.

say() {
    printf '%s\n' "$*"
}

# One sentence to standard error, exit code 1.
die() {
    printf 'error: %s\n' "$*" >&2
    exit 1
}
