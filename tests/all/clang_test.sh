#!/usr/bin/env bash
# The release built by clang. It is not sanitized, and is optimised as gcc's is.
. "$(dirname "$0")/../lib.sh"

# Slow: compiles everything, and runs the matrix of commands.
test_the_release_by_clang_gives_the_bytes_of_gcc() {
    command -v clang >clang.path || skip "clang is not installed"
    run_ok make -C "$REPO" --no-print-directory -j"$(nproc)" CC=clang BUILD="$PWD/built" program
    CORCAST=$PWD/built/corcast CORCAST_TEMPLATES=$REPO/templates run "$REPO/tests/bytes/compare"
    [ "$status" -eq 0 ] || fail "$(head -5 stdout | tr '\n' ';')"
}

run_tests "$@"
