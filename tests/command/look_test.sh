#!/usr/bin/env bash
# Looks: what they are said to be, and what of them is corcast's own.
. "$(dirname "$0")/../lib.sh"

# A thick vessel behind a thin one, and one beside both.
make_crossing() {
    printf '1 1 0 -20 0 3.1 -1\n2 3 0 20 0 3.1 1\n3 1 -20 0 12 1.17 -1\n4 3 20 0 12 1.17 3\n' >tree.swc
}

test_looks_are_listed_with_what_povray_does_not_draw() {
    run_ok corcast looks
    expect_stdout '^clinical	POV-Ray draws the same	the red of textbooks'
    expect_stdout '^journal	POV-Ray draws it without outlines and halos	true colours'
    expect_stdout '^depth	POV-Ray draws it without halos and fading with depth	'
    [ "$(corcast looks | wc -l)" = "$(ls "$REPO"/templates/looks | wc -l)" ] || fail "expected every look to be listed"
    ! corcast looks | awk -F '	' 'NF != 3 || $3 == ""' | grep . || fail "expected every look to say what it is"
}

test_a_scene_says_what_of_the_look_it_is_without() {
    make_crossing
    run_ok corcast scene tree.swc --input-unit mm --look journal -o tree.pov
    expect_sentence "^corcast: --look journal: outlines and halos are corcast's own, and the scene is without them"
    grep -q '^// Not in this scene, but in what corcast render draws: outlines and halos$' tree.pov ||
        fail "expected the header to say what is not in the scene"
    run_ok corcast scene tree.swc --quiet --look clinical -o plain.pov
    ! grep -q 'Not in this scene' plain.pov || fail "expected nothing to be missing from a scene that has all"
}

# The sheet shows between the two, which it does not without a halo.
test_halos_part_vessels_whatever_the_model() {
    local model
    make_crossing
    sed 's/^width = 2.5/width = 40/' "$REPO/templates/looks/journal.ini" >wide.ini
    sed '/^\[halo\]/,$d' wide.ini >bare.ini
    for model in $(corcast models | grep -v mesh); do
        run_ok corcast render tree.swc --quiet --model "$model" --size 64x64 --background 0,0,1 --look ./wide.ini -o with.ppm
        run_ok corcast render tree.swc --quiet --model "$model" --size 64x64 --background 0,0,1 --look ./bare.ini -o without.ppm
        expect_differing 30 600 without.ppm with.ppm
    done
}

test_planes_of_geometry_know_nothing_of_effects() {
    local plane
    make_crossing
    run_ok corcast render tree.swc --quiet --size 40x30 --look journal --antialias 2 --planes depth,normal,id -o with.ppm
    run_ok corcast render tree.swc --quiet --size 40x30 --look flat --antialias 2 --planes depth,normal,id -o without.ppm
    for plane in depth.pfm normal.pfm id.ppm; do
        expect_same without.$plane with.$plane
    done
}

test_pictures_with_effects_are_the_same_whatever_the_memory_and_threads() {
    make_crossing
    run_ok corcast render tree.swc --quiet --size 90x201 --look ink -o whole.ppm
    run_ok corcast render tree.swc --quiet --size 90x201 --look ink --memory 0.01 --threads 1 -o bands.ppm
    expect_same whole.ppm bands.ppm
}

run_tests "$@"
