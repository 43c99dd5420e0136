#!/usr/bin/env bash
# `verify` in tiles: POV-Ray draws each tile from a scene with only the pieces that rays of the tile
# can hit. The pixels must equal those of the whole scene.
. "$(dirname "$0")/../lib.sh"

command -v "${CORCAST_POVRAY:-povray}" >/dev/null || {
    echo "povray is not installed: run make deps" >&2
    exit 3
}

# as_one TILES OPTIONS ...: tree.swc drawn in tiles has the same POV-Ray planes and the same verdict
# as drawn in one scene.
as_one() {
    local tiles=$1 plane
    shift
    run corcast verify tree.swc "$@" -o one
    run corcast verify tree.swc "$@" --tiles "$tiles" -o tiled
    expect_json one/report.json '.povray.tiles == 1'
    expect_json tiled/report.json ".povray.tiles == $tiles and (.native | has(\"tiles\") | not)"
    expect_same <(jq '[.verdict, .reason, .planes, .settled]' one/report.json) \
        <(jq '[.verdict, .reason, .planes, .settled]' tiled/report.json)
    for plane in '' .depth-id .normal; do
        expect_file "one/povray$plane.png"
        cmp -s <(pngtopnm "one/povray$plane.png" 2>/dev/null) <(pngtopnm "tiled/povray$plane.png" 2>/dev/null) ||
            fail "povray$plane.png of $tiles tiles differs: $*"
    done
}

# Slow: every model is drawn with shadows and without, by 32 runs of POV-Ray.
test_tiles_have_the_pixels_of_the_whole_in_every_model() {
    local model
    run_ok corcast grow --terminals 60 --seed 5 --gamma 2.7 -o tree.swc
    for model in $(corcast models | cut -f 1); do
        as_one 4 --model "$model" --shadows on --size 64x48
        as_one 2 --model "$model" --shadows off --size 48x40
    done
}

test_tiles_of_a_ball_in_perspective_over_a_ground_have_the_pixels_of_the_whole() {
    run_ok corcast grow --terminals 60 --seed 6 --domain ball:28.794 -o tree.swc
    as_one 7 --model joined --look print --shadows on --view iso --projection perspective --size 67x53
    [ "$(wc -c <tiled/scene.tile-1.inc)" -lt "$(wc -c <one/scene.inc)" ] || fail "expected fewer joints in a tile"
}

# A blob of more than 128 segments is divided into cells, which tiles share.
test_tiles_of_a_blob_in_many_cells_have_the_pixels_of_the_whole() {
    run_ok corcast grow --terminals 150 --seed 6 --domain ball:28.794 -o tree.swc
    as_one 5 --model blob --color-by pressure --shadows on --antialias 2 --size 48x64
    grep -q Blob_Cell_End tiled/scene.tile-1.inc || fail "expected cells"
}

test_a_verification_leaves_the_scenes_of_its_tiles_and_no_others() {
    run_ok corcast grow --terminals 12 --seed 5 -o tree.swc
    run_ok corcast verify tree.swc --model blob --size 40x30 --tiles 3 -o report
    expect_same <(cd report && printf '%s\n' *tile*) <(printf '%s\n' ids.tile-{1,2,3}.{inc,pov} scene.tile-{1,2,3}.{inc,pov})
    expect_stdout 'POV-Ray 3\.7.* s of 3 tiles, corcast'
    expect_json report/report.json '.commands | length == 10 and (.[8] | contains("+Iids.tile-3.pov") and contains("+SR"))'
    grep -q 'in 3 tiles' report/report.html || fail "expected the page to tell of tiles"
    run_ok corcast verify tree.swc --size 40x30 -o report
    expect_same <(cd report && printf '%s\n' scene*) <(printf '%s\n' scene.inc scene.pov)
    [ -z "$(find report -name '*tile*')" ] || fail "expected no tiles, got $(ls report)"
}

# POV-Ray does not read 33,599 segments of a blob with ids in acceptable time.
test_a_scene_that_is_too_much_for_povray_is_drawn_in_tiles_or_refused() {
    run_ok corcast grow --terminals 16800 --seed 5 --quiet -o tree.swc
    run_ok corcast verify tree.swc --model blob --size 48x40 -o report
    expect_json report/report.json '.verdict == "agree" and .povray.tiles == 2'
    run_ok corcast verify tree.swc --model blob --height 25 --size 48x40 -o near
    expect_json near/report.json '.verdict == "agree" and .povray.tiles == 1'
    [ "$(wc -c <near/scene.inc)" -lt "$(wc -c <report/scene.tile-1.inc)" ] || fail "expected less to be seen from near by"
    run corcast verify tree.swc --model blob --size 12x12 -o refused
    expect_status 2
    expect_sentence 'the vessels in the smallest tile, 12 x 12 pixels at \(0, 0\), are 103 % of the amount that POV-Ray can parse in reasonable time; draw a larger picture, or drop thin vessels \(--prune-radius\)$'
    [ -z "$(ls refused)" ] || fail "expected an empty folder, got $(ls refused)"
}

test_more_tiles_than_a_picture_has_are_refused() {
    run_ok corcast grow --terminals 12 --seed 5 -o tree.swc
    run corcast verify tree.swc --size 40x30 --tiles 100 -o report
    expect_status 2
    expect_sentence '--tiles: a picture of 40 x 30 pixels can have at most 8 tiles, each at least 8 pixels wide; 100 is too many$'
}

run_tests "$@"
