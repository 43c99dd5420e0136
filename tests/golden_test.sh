#!/usr/bin/env bash
# The golden pictures, case by case of tests/golden/cases. A case has two stored pictures: a
# snapshot by corcast, and one by POV-Ray, the oracle. The stored pictures must match their record.
# corcast must draw the snapshot exactly and the oracle's picture within its tolerance. The oracle's
# picture must come from the scene that corcast writes now. POV-Ray does not run here; golden-update
# runs it.
. "$(dirname "$0")/lib.sh"
. "$(dirname "$0")/golden/golden.sh"

HOW='run: make golden-update CASE=%s REASON="..."'

expect_golden() {
    # shellcheck disable=SC2059
    [ -f "$1/picture.png" ] && [ -f "$1/case.json" ] ||
        fail "${1#"$REPO"/} is missing; $(printf "$HOW" "${1##*/}")"
}

# stored_as_recorded CASE: the stored pictures match their record. A tolerance consists of `levels`
# and `ppm`: at most `ppm` pixels in a million may differ by more than `levels` levels. A tolerance
# other than 0 must have its reason in `widened`. A snapshot has no tolerance.
stored_as_recorded() {
    local kind golden key
    for kind in $(case_kinds "$1"); do
        golden=$GOLDEN/$kind/$1
        expect_golden "$golden"
        for key in command pixels_sha256 reason; do
            expect_json "$golden/case.json" ".$key | length > 0"
        done
        [ "$(pixel_hash "$golden/picture.png")" = "$(record "$golden" pixels_sha256)" ] ||
            fail "${golden#"$REPO"/}/picture.png is not the picture that case.json records"
    done
    golden=$GOLDEN/snapshot/$1
    [ "$(record "$golden" command)" = "$(snapshot_command "$1")" ] ||
        fail "${golden#"$REPO"/}/case.json records another command than '$(snapshot_command "$1")'"
    expect_json "$golden/case.json" 'has("tolerance") or has("widened") | not'
    has_oracle "$1" || return 0
    golden=$GOLDEN/oracle/$1/case.json
    expect_json "$golden" '.povray_version | startswith("3.7")'
    expect_json "$golden" '[.tolerance | .levels, .ppm | type == "number" and . >= 0] == [true, true]'
    expect_json "$golden" '.tolerance == {levels: 0, ppm: 0} or (.widened | length > 0)'
}

# drawn_like KIND NAME DRAW LEVELS PPM: the function DRAW draws the case NAME within the tolerance
# of its stored picture.
drawn_like() {
    local golden=$GOLDEN/$1/$2
    expect_golden "$golden"
    run_ok "$3" "$2" native.png
    run corcast compare "$golden/picture.png" native.png --levels "$4" --ppm "$5"
    [ "$status" -le 1 ] || fail "compare ended with exit status $status$(said)"
    # shellcheck disable=SC2059
    [ "$status" -eq 0 ] || fail "expected ${golden#"$REPO"/}; $(cat stdout); if that is right, $(printf "$HOW" "$2")"
}

drawn_like_the_oracle() {
    expect_golden "$GOLDEN/oracle/$1"
    drawn_like oracle "$1" draw_like_povray "$(record "$GOLDEN/oracle/$1" tolerance.levels)" \
        "$(record "$GOLDEN/oracle/$1" tolerance.ppm)"
}

drawn_like_the_snapshot() {
    drawn_like snapshot "$1" draw_native 0 0
}

of_todays_scene() {
    local golden=$GOLDEN/oracle/$1
    expect_golden "$golden"
    run_ok write_scene "$1"
    [ "$(scene_hash)" = "$(record "$golden" scene_sha256)" ] ||
        fail "${golden#"$REPO"/} is not of today's scene; run: make golden-update, which asks POV-Ray about each such case"
}

test_every_golden_has_a_case() {
    local folder kind
    for folder in "$GOLDEN"/*/*; do
        kind=${folder%/*}
        case_kinds "${folder##*/}" | grep -qw "${kind##*/}" || fail "${folder#"$REPO"/} belongs to no case"
    done
}

tests=every_golden_has_a_case
for name in $(golden_cases); do
    word=${name//-/_}
    eval "test_${word}_is_stored_as_recorded() { stored_as_recorded $name; }
          test_${word}_is_drawn_like_the_snapshot() { drawn_like_the_snapshot $name; }
          test_${word}_is_drawn_like_the_oracle() { drawn_like_the_oracle $name; }
          test_${word}_has_the_oracle_of_todays_scene() { of_todays_scene $name; }"
    tests="$tests ${word}_is_stored_as_recorded ${word}_is_drawn_like_the_snapshot"
    ! has_oracle "$name" || tests="$tests ${word}_is_drawn_like_the_oracle ${word}_has_the_oracle_of_todays_scene"
done
# shellcheck disable=SC2086
run_tests ${*:-$tests}
