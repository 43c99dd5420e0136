#!/usr/bin/env bash
# The matrix of models, trees, projections, shadows and antialiasing, in small; `make verify-all` runs it whole.
. "$(dirname "$0")/../lib.sh"

test_the_small_matrix_agrees_and_makes_one_report() {
    POWER='' run_ok "$REPO/tests/verify-all" small "$PWD/matrix"
    expect_stdout '^agree: [0-9]+ cases; .*report\.html$'
    [ "$(grep -c '<tr data-case=' matrix/report.html)" -ge 12 ] || fail "expected a row for each case"
    expect_file matrix/cases
}

run_tests "$@"
