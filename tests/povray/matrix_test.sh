#!/usr/bin/env bash
# A small matrix of models, trees, projections, shadows and antialiasing; `make verify-all` runs the
# whole matrix. Besides the verdict of `verify`, netpbm decodes the pictures and these tests compare
# them, so that an error of corcast's own comparison is found.
. "$(dirname "$0")/../lib.sh"

# Slow: every model draws every tree, also with POV-Ray.
test_the_small_matrix_agrees_and_makes_one_report() {
    local case
    POWER='' run_ok "$REPO/tests/verify-all" small "$PWD/matrix"
    expect_stdout '^agree: [0-9]+ cases; .*report\.html$'
    [ "$(grep -c '<tr data-case=' matrix/report.html)" -eq "$(wc -l <matrix/cases)" ] ||
        fail "expected a row for each case"
    [ "$(wc -l <matrix/cases)" -ge 20 ] || fail "expected each model with each tree"
    for case in matrix/*-aa[13]; do
        expect_differing 0 0 "$case/povray.png" "$case/native.png"
        case $case in
        *isosurface*) expect_json "$case/report.json" '.surface.verdict == "agree" and .surface.common_pixels > 100' ;;
        esac
    done
}

run_tests "$@"
