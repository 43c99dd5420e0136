#!/usr/bin/env bash
# The golden pictures, case by case of tests/golden/cases: the stored picture is what its record
# says, corcast draws the snapshot exactly and the oracle within its tolerance, and the oracle is of
# the scene that corcast writes today.
. "$(dirname "$0")/lib.sh"
. "$(dirname "$0")/golden/golden.sh"

HOW='run: make golden-update CASE=%s REASON="..."'

expect_golden() {
    # shellcheck disable=SC2059
    [ -f "$1/picture.png" ] && [ -f "$1/case.json" ] ||
        fail "${1#"$REPO"/} is missing; $(printf "$HOW" "${1##*/}")"
}

stored_as_recorded() {
    local golden key
    for golden in "$GOLDEN/oracle/$1" "$GOLDEN/snapshot/$1"; do
        expect_golden "$golden"
        for key in command scene_sha256 pixels_sha256 tolerance reason; do
            expect_json "$golden/case.json" ".$key | length > 0"
        done
        [ "$(pixel_hash "$golden/picture.png")" = "$(record "$golden" pixels_sha256)" ] ||
            fail "${golden#"$REPO"/}/picture.png is not the picture that case.json records"
    done
    expect_json "$GOLDEN/oracle/$1/case.json" '.povray_version | startswith("3.7")'
}

# The tolerance: at most `ppm` pixels in a million off by more than `levels`.
drawn_like() {
    local golden=$1 name=$2 draw=$3
    expect_golden "$golden"
    run_ok "$draw" "$name" native.png
    run corcast compare "$golden/picture.png" native.png \
        --levels "$(record "$golden" tolerance.levels)" --ppm "$(record "$golden" tolerance.ppm)"
    [ "$status" -le 1 ] || fail "compare ended with exit status $status$(said)"
    # shellcheck disable=SC2059
    [ "$status" -eq 0 ] || fail "expected ${golden#"$REPO"/}; $(cat stdout); if that is right, $(printf "$HOW" "$name")"
}

of_todays_scene() {
    local golden=$GOLDEN/oracle/$1
    expect_golden "$golden"
    run_ok write_scene "$1"
    [ "$(scene_hash)" != "$(record "$golden" scene_sha256)" ] || return 0
    run_ok draw_povray "$1" today.png
    # shellcheck disable=SC2059
    [ "$(pixel_hash today.png)" = "$(record "$golden" pixels_sha256)" ] ||
        fail "POV-Ray draws another picture from today's scene; if that is right, $(printf "$HOW" "$1")"
}

test_every_golden_has_a_case() {
    local folder
    for folder in "$GOLDEN"/*/*; do
        case $folder in
        "$GOLDEN"/oracle/* | "$GOLDEN"/snapshot/*)
            golden_cases | grep -qx "${folder##*/}" || fail "${folder#"$REPO"/} belongs to no case"
            ;;
        *) fail "${folder#"$REPO"/} is neither oracle nor snapshot" ;;
        esac
    done
}

tests=every_golden_has_a_case
for name in $(golden_cases); do
    word=${name//-/_}
    eval "test_${word}_is_stored_as_recorded() { stored_as_recorded $name; }
          test_${word}_is_drawn_like_the_oracle() { drawn_like \$GOLDEN/oracle/$name $name draw_like_povray; }
          test_${word}_is_drawn_like_the_snapshot() { drawn_like \$GOLDEN/snapshot/$name $name draw_native; }
          test_${word}_has_the_oracle_of_todays_scene() { of_todays_scene $name; }"
    tests="$tests ${word}_is_stored_as_recorded ${word}_is_drawn_like_the_oracle
        ${word}_is_drawn_like_the_snapshot ${word}_has_the_oracle_of_todays_scene"
done
# shellcheck disable=SC2086
run_tests ${*:-$tests}
