#!/usr/bin/env bash
# golden_test.sh must fail if a golden picture or record is changed without golden-update.
. "$(dirname "$0")/../lib.sh"
. "$(dirname "$0")/../golden/golden.sh"

CASE=bifurcation-rounded

copy_golden() {
    local kind
    for kind in oracle snapshot; do
        mkdir -p golden/$kind
        cp -R "$REPO/golden/$kind/$CASE" golden/$kind/
    done
    grep "^$CASE " "$REPO/tests/golden/cases" >cases
    export GOLDEN=$PWD/golden CASES=$PWD/cases
}

# finds TEST SENTENCE: the golden test TEST fails with the sentence.
finds() {
    run "$REPO/tests/golden_test.sh" "$1"
    [ "$status" -ne 0 ] || fail "expected the golden test $1 to fail"
    expect_stdout "$2"
}

edit_record() {
    jq "$2" "golden/$1/$CASE/case.json" >edited
    mv edited "golden/$1/$CASE/case.json"
}

# edit_picture KIND: changes one pixel of the stored picture by one level, and records the new hash.
edit_picture() {
    pngtopnm "golden/$1/$CASE/picture.png" >old.ppm
    { head -c -1 old.ppm && printf '\376'; } | pnmtopng >"golden/$1/$CASE/picture.png" 2>pnmtopng.error
    edit_record "$1" ".pixels_sha256 = \"$(pixel_hash "golden/$1/$CASE/picture.png")\""
}

test_untouched_goldens_pass() {
    copy_golden
    run_ok "$REPO/tests/golden_test.sh"
    expect_stdout '^1\.\.5$'
}

test_a_tolerance_that_was_widened_by_hand_is_found() {
    copy_golden
    edit_record oracle '.tolerance = {levels: 255, ppm: 1000000}'
    finds bifurcation_rounded_is_stored_as_recorded 'widened'
    edit_picture oracle
    finds bifurcation_rounded_is_stored_as_recorded 'widened'
    edit_record oracle '.tolerance = {levels: 0}'
    finds bifurcation_rounded_is_stored_as_recorded 'tolerance'
}

test_a_snapshot_with_a_tolerance_is_found() {
    copy_golden
    edit_picture snapshot
    finds bifurcation_rounded_is_drawn_like_the_snapshot 'expected .*snapshot/bifurcation-rounded'
    edit_record snapshot '.tolerance = {levels: 255, ppm: 1000000} | .widened = "by hand"'
    finds bifurcation_rounded_is_stored_as_recorded 'tolerance'
    finds bifurcation_rounded_is_drawn_like_the_snapshot 'expected .*snapshot/bifurcation-rounded'
}

test_a_pixel_is_found_with_and_without_its_hash() {
    copy_golden
    edit_picture oracle
    finds bifurcation_rounded_is_drawn_like_the_oracle 'expected .*oracle/bifurcation-rounded'
    edit_record oracle '.pixels_sha256 = "0"'
    finds bifurcation_rounded_is_stored_as_recorded 'is not the picture that case.json records'
}

test_another_scene_than_todays_is_found_with_the_command_that_records_it() {
    copy_golden
    edit_record oracle '.scene_sha256 = "0"'
    finds bifurcation_rounded_has_the_oracle_of_todays_scene 'run: make golden-update,'
}

test_a_golden_without_a_case_and_a_case_without_a_golden_are_found() {
    copy_golden
    sed -i 's/ both / corcast /' cases
    finds every_golden_has_a_case 'oracle/bifurcation-rounded belongs to no case'
    rm -r golden/oracle
    run_ok "$REPO/tests/golden_test.sh"
    rm -r golden/snapshot
    finds bifurcation_rounded_is_stored_as_recorded 'snapshot/bifurcation-rounded is missing; run: make golden-update CASE=bifurcation-rounded'
}

run_tests "$@"
