#!/usr/bin/env bash
# golden-update, the only program that writes golden/, on a separate folder.
. "$(dirname "$0")/../lib.sh"

update() {
    GOLDEN=$PWD/golden SHOWN=$PWD/shown run "$REPO/tests/golden-update" "$@"
}

# Replaces POV-Ray by a script that draws another highlight.
other_povray() {
    printf '#!/bin/sh\nexec povray "$@" Declare=Vessel_Phong=0.5\n' >povray.sh
    chmod +x povray.sh
    export CORCAST_POVRAY=$PWD/povray.sh
}

test_nothing_is_written_without_a_reason() {
    update bifurcation-rounded </dev/null
    expect_status 2
    update no-such-case "because"
    expect_status 2
    [ ! -e golden ] || fail "expected no golden"
}

test_a_case_is_written_with_its_reason_and_shows_old_and_new() {
    update bifurcation-rounded "the first"
    expect_status 0
    expect_json golden/oracle/bifurcation-rounded/case.json '.reason == "the first" and .tolerance.ppm == 0 and
        (.povray_version | startswith("3.7")) and (.scene_sha256 | length) == 64'
    expect_file golden/snapshot/bifurcation-rounded/picture.png
    update bifurcation-rounded "the second"
    expect_status 0
    expect_stdout 'old picture against new'
    expect_file shown/bifurcation-rounded/oracle-difference.png
    expect_json golden/oracle/bifurcation-rounded/case.json '.reason == "the second"'
    expect_json golden/snapshot/bifurcation-rounded/case.json \
        '.reason == "the second" and (has("tolerance") or has("scene_sha256") | not)'
}

test_a_case_that_corcast_draws_alone_has_a_snapshot_only() {
    export CORCAST_POVRAY=$PWD/none
    update bifurcation-16-bits "sixteen bits"
    expect_status 0
    [ "$(ls golden)" = snapshot ] || fail "expected a snapshot only, got $(ls golden)"
    update
    expect_status 0
}

test_without_a_case_todays_scenes_are_recorded_where_the_pixels_stay() {
    local record=golden/oracle/bifurcation-rounded/case.json
    update bifurcation-rounded "the first"
    cp $record first.json
    jq '.scene_sha256 = "of another day"' first.json >$record
    update
    expect_status 0
    expect_stdout 'bifurcation-rounded: the same pixels'
    expect_same $record first.json
    other_povray
    update
    expect_status 0
    jq '.scene_sha256 = "of another day"' first.json >$record
    update
    expect_status 1
    expect_sentence 'another picture of bifurcation-rounded.*make golden-update CASE=bifurcation-rounded'
    expect_json $record '.scene_sha256 == "of another day"'
}

test_a_tolerance_widens_only_with_a_written_reason_and_shrinks_by_itself() {
    other_povray
    update bifurcation-rounded "another highlight"
    expect_status 1
    grep -q 'widened only with a reason' stderr || fail "expected the reason to be asked for$(said)"
    [ ! -e golden ] || fail "expected no golden"
    WIDEN="POV-Ray was changed" LEVELS=3 update bifurcation-rounded "another highlight"
    expect_status 0
    expect_json golden/oracle/bifurcation-rounded/case.json \
        '.widened == "POV-Ray was changed" and .tolerance.levels == 3 and .tolerance.ppm > 0'
    unset CORCAST_POVRAY
    update bifurcation-rounded "as it was"
    expect_status 0
    expect_json golden/oracle/bifurcation-rounded/case.json '.tolerance == {levels: 0, ppm: 0} and (has("widened") | not)'
}

run_tests "$@"
