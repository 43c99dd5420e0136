#!/usr/bin/env bash
# Results keep their bytes: trees, pictures, scenes, meshes and volumes of a matrix of commands are
# compared with stored hashes.
. "$(dirname "$0")/../lib.sh"

test_results_of_the_matrix_of_commands_keep_their_bytes() {
    run "$REPO/tests/bytes/compare"
    [ "$status" -eq 0 ] || fail "$(cat stdout stderr)"
}

run_tests "$@"
