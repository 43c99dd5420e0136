#!/usr/bin/env bash
# `povray` and `scene` with the real POV-Ray.
. "$(dirname "$0")/../lib.sh"

scene() {
    run_ok corcast grow --terminals 20 -o tree.swc
    run_ok corcast scene tree.swc --size 80x60 "$@" -o scene.pov
}

test_a_scene_is_drawn_in_the_size_asked_for() {
    scene
    run_ok corcast povray scene.pov -o picture.png --size 91x47
    pngtopnm picture.png | pnmfile | grep -q '91 by 47' || fail "expected 91 by 47"
    expect_only tree.swc scene.pov scene.inc picture.png
}

test_the_scene_needs_no_switch_but_the_size() {
    local model
    for model in $(corcast models --of field | cut -f 1); do
        scene --model $model
        run povray +Iscene.pov +Oplain.png +W80 +H60 -D
        expect_status 0
        ! grep -iE '(parse|render|shutdown) (warning|error)|max_gradient' stderr || fail "expected neither warnings nor errors$(said)"
        run_ok corcast povray scene.pov -o picture.png --size 80x60
        cmp -s <(pngtopnm plain.png) <(pngtopnm picture.png) || fail "expected the same pixels"
    done
}

test_two_runs_give_the_same_pixels() {
    scene
    run_ok corcast povray scene.pov -o first.png --size 80x60 --antialias 3
    run_ok corcast povray scene.pov -o second.png --size 80x60 --antialias 3 --threads 1
    cmp -s <(pngtopnm first.png) <(pngtopnm second.png) || fail "expected the same pixels"
}

test_every_plane_can_be_asked_for() {
    local plane
    scene
    for plane in color depth normal id; do
        run_ok corcast povray scene.pov -o $plane.png --size 80x60 --plane $plane
        pngtopnm $plane.png >$plane.ppm || fail "expected a PNG for $plane"
    done
    expect_differing 4800 4800 color.ppm id.ppm
    pnmfile depth.ppm | grep -q 'maxval 65535' || fail "expected 16 bits of depth"
}

# pixels PICTURE: prints the codes of the pixels, one pixel per line.
pixels() {
    pngtopnm "$1" 2>/dev/null | pnmtoplainpnm | tail -n +4 | tr -s ' \n' '\n\n' | sed '/^$/d' | paste -d ' ' - - -
}

test_depth_and_ids_in_one_plane_are_those_of_two() {
    local model plane
    run_ok corcast grow --quiet --terminals 30 --seed 4 -o many.swc
    for model in cylinders joined rounded mesh 'isosurface --ids on' 'blob --ids on'; do
        # shellcheck disable=SC2086
        run_ok corcast scene many.swc --quiet --model $model -o scene.pov
        for plane in depth id depth-id; do
            run_ok corcast povray scene.pov -o $plane.png --size 80x60 --plane $plane
        done
        paste -d ' ' <(pixels depth.png) <(pixels id.png) |
            awk '{ print $1, $2, ($4 * 256 + $5) * 256 + $6; seen += $3 > 0 } END { exit seen < 100 }' >two ||
            fail "expected vessels in the picture of $model"
        expect_same two <(pixels depth-id.png)
    done
}

test_what_an_artist_declares_changes_the_picture() {
    scene
    run_ok corcast povray scene.pov -o plain.png --size 80x60
    printf '#declare Vessel_Color = <0.1, 0.3, 0.8>;\n#include "scene.pov"\n' >blue.pov
    run_ok corcast povray blue.pov -o blue.png --size 80x60
    expect_differing 163 163 plain.png blue.png
    printf '#version 3.7;\n#include "scene.inc"\nobject { Tree texture { T_Vessel } }\ncamera { location -150*z }\nlight_source { -500*z, rgb 1 }\n' >own.pov
    run_ok corcast povray own.pov -o own.png --size 80x60
}

test_a_scene_with_an_error_is_refused_with_the_words_of_povray() {
    printf '#version 3.7;\nsphere { 0, 1 pigmnt { rgb 1 } }\n' >broken.pov
    run corcast povray broken.pov -o picture.png --size 20x20
    expect_status 3
    grep -q 'pigmnt' stderr || fail "expected POV-Ray's error$(said)"
    expect_only broken.pov
}

test_file_names_with_blanks_are_fine() {
    mkdir 'a folder'
    run_ok corcast grow --terminals 5 -o 'a folder/my tree.swc'
    run_ok corcast scene 'a folder/my tree.swc' -o 'a folder/my scene.pov'
    run_ok corcast povray 'a folder/my scene.pov' -o 'a folder/my picture.png' --size 20x20
    expect_file 'a folder/my picture.png'
}

# codes FILE.png: prints the codes of the middle pixel of 3 x 3.
codes() {
    pngtopnm "$1" | tail -c 15 | od -An -tu1 -N3 | tr -s ' '
}

# The surface faces the camera and the first light. Ambient is 1/4, diffuse 1/2, and phong 1/4 with
# exponent 3. A second light is at 60 degrees. Red is 0.3 (1/4 + 0.8 / 2 + 0.4 / 4) + (0.8 + 0.4 /
# 8) / 4 = 0.4375, or 177 of 255 in sRGB.
test_a_vessel_lit_head_on_has_the_color_that_a_calculator_says() {
    local model view="--size 3x3 --location 1.5,0,40 --look-at 1.5,0,0 --height 0.1"
    printf '1 3 -30 0 0 2.385 -1\n2 3 30 0 0 2.385 1\n' >tree.swc
    cat >look.ini <<'INI'
[vessel]
color = 0.3 0.4 0.5
[background]
color = 1 1 1
[finish]
ambient = 0.25
diffuse = 0.5
phong = 0.25
phong_size = 3
[light head]
direction = 0 0 2.5
color = 0.8 0.6 0.4
[light side]
direction = 0 1.7320508075688772 1
color = 0.4 0.2 0.6
INI
    for model in $(corcast models | cut -f 1); do
        # shellcheck disable=SC2086
        run_ok corcast render --exact --quiet tree.swc --look ./look.ini --model $model $view -o native.png
        [ "$(codes native.png)" = " 177 169 173" ] || fail "expected 177 169 173, got $(codes native.png), from: $command_line"
        # shellcheck disable=SC2086
        run_ok corcast scene --quiet tree.swc --look ./look.ini --model $model $view -o scene.pov
        run_ok corcast povray --quiet scene.pov -o povray.png
        [ "$(codes povray.png)" = " 177 169 173" ] || fail "expected 177 169 173 of POV-Ray, got $(codes povray.png): $model"
    done
}

# With antialiasing 3, many values of alpha are half codes, such as 0.3 x 255 = 76.5. POV-Ray rounds
# them up.
test_a_transparent_picture_is_povrays() {
    local antialias
    cp "$DATA/bifurcation.swc" tree.swc
    run_ok corcast scene --quiet tree.swc --background none --size 60x50 -o scene.pov
    for antialias in 1 3 5; do
        run_ok corcast povray --quiet scene.pov --alpha --antialias $antialias -o povray.png
        run_ok corcast render --quiet tree.swc --exact --background none --size 60x50 --antialias $antialias -o native.png
        paste -d ' ' <(pngtopam -alphapam povray.png | tail -c 12000 | od -A n -v -t u1 -w4) \
            <(pngtopam -alphapam native.png | tail -c 12000 | od -A n -v -t u1 -w4) |
            awk '$1 != $5 || $2 != $6 || $3 != $7 || $4 != $8 { exit 1 } $4 > 0 { seen++ } END { exit seen < 300 }' ||
            fail "expected POV-Ray's colors and alpha, antialiased by $antialias"
    done
}

run_tests "$@"
