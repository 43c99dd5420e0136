#!/usr/bin/env bash
# Tachyon, an independent renderer, draws the scenes that POV-Ray and corcast draw.
. "$(dirname "$0")/../lib.sh"

needs_tachyon() {
    command -v tachyon >/dev/null || skip "tachyon is not installed"
}

test_three_programs_see_the_same_vessels_equally_far_away() {
    local model projection
    needs_tachyon
    run_ok corcast grow --terminals 37 --domain ball:23 --seed 9 -o t.swc --quiet
    for model in cylinders rounded mesh; do
        for projection in orthographic perspective; do
            run_ok corcast verify t.swc --model $model --projection $projection --view iso --size 173x131 \
                --witness tachyon -o v
            expect_stdout 'witness agree +POV-Ray, corcast and Tachyon agree'
            expect_json v/report.json '.witness | .verdict == "agree" and .version == "0.99"
                and (.pairs["corcast and Tachyon"] | .id.common_pixels > 500 and .id.differing_pixels == 0
                    and .depth.max_abs_mm < 0.001)'
        done
    done
    grep -q 'POV-Ray, corcast and Tachyon agree' v/report.html || fail "expected the witness on the page"
    grep -q 'testcase.*name="POV-Ray and Tachyon"' v/junit.xml || fail "expected the witness in JUnit"
}

# other NAME SCRIPT: makes an executable script that draws another scene than requested.
other() {
    printf '#!/bin/sh\n%s\n' "$2" >"$1"
    chmod +x "$1"
}

test_the_program_that_draws_another_scene_stands_alone() {
    needs_tachyon
    other thin "sed 's/ RAD 0.7 / RAD 0.65 /' \"\$1\" >$PWD/thin.tachyon; shift; exec tachyon $PWD/thin.tachyon \"\$@\""
    other lower 'exec povray "$@" Declare=Part_Top=1'
    printf '1 0 0 9 0 0.7 -1\n2 0 1 0 0 0.7 1\n3 0 -6 -7 1 0.4 2\n4 0 5 -8 -2 0.5 2\n' >t.swc
    run env CORCAST_TACHYON="$PWD/thin" "$CORCAST" verify t.swc --model cylinders --size 150x150 --witness tachyon -o v
    expect_status 1
    expect_stdout 'witness differ +POV-Ray and corcast agree, and Tachyon stands alone'
    expect_json v/report.json '.verdict == "differ" and .planes.color.verdict == "agree"'
    run env CORCAST_POVRAY="$PWD/lower" "$CORCAST" verify t.swc --size 150x150 --witness tachyon -o v
    expect_status 1
    expect_stdout 'witness differ +corcast and Tachyon agree, and POV-Ray stands alone'
}

test_without_a_witness_that_draws_there_is_no_verdict() {
    other silent 'echo "Parser failed trying to open file: x"; exit 0'
    run env CORCAST_TACHYON="$PWD/silent" "$CORCAST" verify "$DATA/bifurcation.swc" --size 20x20 --witness tachyon -o v
    expect_status 3
    expect_sentence 'Tachyon drew no picture of v/scene.tachyon \(exit status 0\): Parser failed trying'
    [ ! -e v/report.json ] || fail "expected no verdict"
    run env CORCAST_TACHYON=/nonesuch "$CORCAST" verify "$DATA/bifurcation.swc" --size 20x20 --witness tachyon -o v
    expect_status 3
    expect_sentence "Tachyon is needed and '/nonesuch' cannot be started; on Debian: apt install tachyon"
    run corcast verify "$DATA/bifurcation.swc" --model joined --witness tachyon -o v
    expect_status 2
    expect_sentence '--model joined: a scene for Tachyon 0.99 holds cylinders, rounded and mesh'
}

# Both programs support a finish without highlights and brilliance. Tachyon ignores light below
# 1/512.
test_tachyon_draws_a_scene_in_the_colors_that_render_gives_it() {
    local shadows
    needs_tachyon
    printf '[vessel]\ncolor = 0.5 0.1 0.3\n[finish]\nambient = 0.23\ndiffuse = 0.61\nphong = 0\nspecular = 0\n' >plain.ini
    printf '[light key]\ndirection = -0.4 0.7 1\ncolor = 0.9 0.8 0.7\n' >>plain.ini
    for shadows in on off; do
        set -- "$DATA/trifurcation.swc" --look ./plain.ini --shadows $shadows --view iso --size 160x120 --quiet \
            --color-by branch --colormap Set1
        run_ok corcast scene "$@" -o "s p.tachyon"
        run_ok tachyon "s p.tachyon" -format PPM48 -o theirs.ppm
        pamtopfm theirs.ppm >theirs.pfm
        run_ok corcast render "$@" --exact --antialias 1 -o ours.pfm
        run_ok corcast compare ours.pfm theirs.pfm --levels 0.5 --ppm 110
    done
    run corcast scene "$DATA/bifurcation.swc" --ini on -o s.tachyon
    expect_status 2
    expect_sentence '--ini is for scenes of POV-Ray \(.pov\)'
}

# The ground is tilted relative to the picture, so the positions of shadows depend on its distance:
# at 1 % more they differ.
test_tachyon_draws_the_ground_where_render_does() {
    local part
    needs_tachyon
    printf '[vessel]\ncolor = 0.5 0.1 0.3\n[finish]\nambient = 0.23\ndiffuse = 0.61\nphong = 0\nspecular = 0\n' >plain.ini
    printf '[light key]\ndirection = -0.4 0.7 1\ncolor = 0.9 0.8 0.7\n' >>plain.ini
    printf '[ground]\nnormal = 0.2 0.1 1\ngap = 0.1\ncolor = 0.9 0.8 0.7\nambient = 0.3\ndiffuse = 0.5\n' >>plain.ini
    set -- "$DATA/trifurcation.swc" --look ./plain.ini --shadows on --view iso --margin 0.4 --size 200x150 --quiet
    run_ok corcast scene "$@" -o right.tachyon
    run_ok corcast render "$@" --exact --antialias 1 -o ours.pfm
    for part in 0.99 1.01; do
        awk -v part=$part '/^PLANE CENTER/ { for (i = 3; i <= 5; i++) $i *= part } { print }' right.tachyon >wrong.tachyon
        cmp -s right.tachyon wrong.tachyon && fail "expected a scene with a plane"
        run_ok tachyon wrong.tachyon -format PPM48 -o wrong.ppm
        pamtopfm wrong.ppm >wrong.pfm
        run corcast compare ours.pfm wrong.pfm --levels 0.5 --ppm 110
        expect_status 1
    done
    run_ok tachyon right.tachyon -format PPM48 -o theirs.ppm
    pamtopfm theirs.ppm >theirs.pfm
    run_ok corcast compare ours.pfm theirs.pfm --levels 0.5 --ppm 110
}

run_tests "$@"
