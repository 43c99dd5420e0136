#!/usr/bin/env bash
# Looks: their listed descriptions, and the parts of looks that only corcast draws.
. "$(dirname "$0")/../lib.sh"

# Writes tree.swc with a thick vessel and a thin vessel in front of it.
make_crossing() {
    printf '1 1 0 -20 0 3.1 -1\n2 3 0 20 0 3.1 1\n3 1 -20 0 12 1.17 -1\n4 3 20 0 12 1.17 3\n' >tree.swc
}

test_looks_are_listed_with_what_povray_does_not_draw() {
    run_ok corcast looks
    expect_stdout '^clinical	also in POV-Ray	the bright red of textbooks'
    expect_stdout '^journal	in POV-Ray without outlines and halos	true colors'
    expect_stdout '^depth	in POV-Ray without halos	'
    [ "$(corcast looks | wc -l)" = "$(ls "$REPO"/templates/looks | wc -l)" ] || fail "expected every look to be listed"
    ! corcast looks | awk -F '	' 'NF != 3 || $3 == ""' | grep . || fail "expected every look to say what it is"
}

test_a_scene_says_what_of_the_look_it_is_without() {
    make_crossing
    run_ok corcast scene tree.swc --input-unit mm --look journal -o tree.pov
    expect_sentence "^corcast: --look journal: only corcast draws outlines and halos; the scene omits them\$"
    grep -q '^// Not in this scene, but in what corcast render draws: outlines and halos$' tree.pov ||
        fail "expected the header to say what is not in the scene"
    run_ok corcast scene tree.swc --quiet --look clinical -o plain.pov
    ! grep -q 'Not in this scene' plain.pov || fail "expected nothing to be missing from a scene that has all"
}

# Without options the picture is the same as with the options that the look proposes. Each option
# overrides the look.
test_a_look_proposes_options_and_the_command_line_overrules_it() {
    local draw="corcast render tree.swc --quiet --size 60x60 --view iso --antialias 1"
    make_crossing
    printf '[light key]\nposition = -1 1 3\nsize = 1\n' >plain.ini
    { cat plain.ini && printf '[options]\nao = 8\nshadows = on\nprojection = perspective\nsmooth = on\n'; } >show.ini
    run_ok $draw --look ./show.ini -o show.ppm
    run_ok $draw --look ./plain.ini --ao 8 --shadows on --smooth --projection perspective -o typed.ppm
    expect_same typed.ppm show.ppm
    run_ok $draw --look ./show.ini --ao 0 --shadows off --smooth off --projection orthographic -o off.ppm
    run_ok $draw --look ./plain.ini -o plain.ppm
    expect_same plain.ppm off.ppm
    run_ok $draw --look ./show.ini --ao 0 --shadows on --smooth off --projection orthographic -o shadows.ppm
    expect_differing 20 3600 shadows.ppm off.ppm
    run_ok $draw --look ./show.ini --height 50 -o flat.ppm
    run_ok $draw --look ./plain.ini --height 50 --ao 8 --shadows --smooth -o high.ppm
    expect_same high.ppm flat.ppm
    run_ok $draw --look ./show.ini --scale-bar 10 -o bar.ppm
    run_ok $draw --look ./show.ini --method zbuffer -o zbuffer.ppm
    run_ok $draw --look ./plain.ini --method zbuffer --smooth --projection perspective -o bare.ppm
    expect_same bare.ppm zbuffer.ppm
    run corcast render tree.swc --quiet --look ./show.ini --ao 4 --method zbuffer -o no.ppm
    expect_status 2
}

test_a_command_line_that_overrules_the_look_is_told_in_the_picture() {
    make_crossing
    run_ok corcast render tree.swc --quiet --size 8x8 --look atlas --shadows off --ao 0 -o tree.png
    grep -aq -- '--ao 0 .*--shadows off' tree.png || fail "expected the options that overrule the look in the picture"
    run_ok corcast render tree.swc --quiet --size 8x8 --look atlas -o plain.png
    ! grep -aq -- '--shadows' plain.png || fail "expected no option that was not given"
}

# The corners have the color for corners, up to half a code of dithering noise. The centre has the
# background's color. A background that an option specifies has one color.
test_a_background_is_graded_towards_its_corners() {
    make_crossing
    printf '[background]\ncolor = 0.8 0.8 0.8\ncorners = 0.1 0.2 0.4\n' >graded.ini
    sed '/corners/d' graded.ini >plain.ini
    run_ok corcast render tree.swc --quiet --size 201x101 --location 0,0,-90 --look-at 0,0,-99 --look ./graded.ini -o graded.pfm
    [ "$(tail -c $((201 * 101 * 12)) graded.pfm | od -An -v -tf4 -w12 | awk '
        function near(a, b) { return a > b - 0.012 && a < b + 0.012 }
        NR == 1 || NR == 201 || NR == 20301 { corners += near($1, 0.1) && near($2, 0.2) && near($3, 0.4) }
        NR == 10151 { center = near($1, 0.8) && near($3, 0.8) }
        END { print corners, center }')" = "3 1" ] || fail "expected the colors of the corners and of the center"
    run_ok corcast render tree.swc --quiet --size 60x60 --view iso --look ./graded.ini --background white -o given.ppm
    run_ok corcast render tree.swc --quiet --size 60x60 --view iso --look ./plain.ini --background white --antialias 3 -o plain.ppm
    expect_same plain.ppm given.ppm
    run_ok corcast render tree.swc --quiet --size 60x90 --look ./graded.ini -o whole.ppm
    run_ok corcast render tree.swc --quiet --size 60x90 --look ./graded.ini --memory 0.01 --threads 1 -o bands.ppm
    expect_same whole.ppm bands.ppm
}

# The colors run with the radius from the tips' color to the vessels' color. No field is reported or
# required.
test_colors_run_with_the_radius_from_the_color_of_the_tips() {
    run_ok corcast grow --terminals 30 --seed 2 --quiet -o tree.swc
    printf '[vessel]\ncolor = 0 0 0\ntips = 1 1 1\n' >tips.ini
    printf '[vessel]\ncolor = 0 0 0\n' >plain.ini
    printf '1 1 1\n0 0 0\n' >map.txt
    run_ok corcast render tree.swc --size 60x60 --look ./tips.ini -o tips.ppm
    [ ! -s stderr ] || fail "expected no word of a field"
    run_ok corcast render tree.swc --quiet --size 60x60 --look ./plain.ini --color-by radius --log --range 2%,100% --colormap ./map.txt -o field.ppm
    expect_same field.ppm tips.ppm
    run_ok corcast render tree.swc --quiet --size 60x60 --look ./tips.ini --color-by level -o level.ppm
    run_ok corcast render tree.swc --quiet --size 60x60 --look ./plain.ini --color-by level -o plain.ppm
    expect_same plain.ppm level.ppm
    run corcast render tree.swc --quiet --look ./tips.ini --legend -o no.png
    expect_status 2
    run_ok corcast verify tree.swc --quiet --size 120x90 --look ./tips.ini -o report
}

# Effects of a look that POV-Ray does not draw are left out with a note. Effects that an option
# requests are refused.
test_povray_does_without_the_occlusion_of_a_look() {
    make_crossing
    run_ok corcast scene tree.swc --input-unit mm --smooth off --look atlas -o tree.pov
    expect_sentence '--look atlas: only corcast draws ambient occlusion; the scene omits them$'
    grep -q '^// Not in this scene, .*: ambient occlusion$' tree.pov || fail "expected the header to say what is not in the scene"
    grep -q 'Fade_Farthest = 0.6' tree.pov || fail "expected the fade of the look"
    grep -q 'area_light' tree.pov || fail "expected the soft light of the look"
    run corcast verify tree.swc --quiet --look atlas --ao 8 -o report
    expect_status 2
    expect_sentence '--ao cannot be verified'
    run_ok corcast render tree.swc --input-unit mm --smooth off --size 30x30 --look atlas --exact -o exact.ppm
    expect_sentence '--look atlas: only corcast draws a graded background; --exact omits them$'
    run corcast render tree.swc --quiet --look xray --exact -o no.png
    expect_status 2
    expect_sentence '--look xray: POV-Ray cannot draw an x-ray'
}

# With a halo the background is visible between the two vessels, without a halo it is not.
test_halos_part_vessels_whatever_the_model() {
    local model
    make_crossing
    sed 's/^width = 2$/width = 40/; s/^radii = 0.8/radii = 1.5/' "$REPO/templates/looks/journal.ini" >wide.ini
    sed '/^\[halo\]/,$d' wide.ini >bare.ini
    for model in $(corcast models | cut -f 1 | grep -v mesh); do
        run_ok corcast render tree.swc --quiet --model "$model" --size 64x64 --background 0,0,1 --look ./wide.ini -o with.ppm
        run_ok corcast render tree.swc --quiet --model "$model" --size 64x64 --background 0,0,1 --look ./bare.ini -o without.ppm
        expect_differing 30 600 without.ppm with.ppm
    done
}

# An x-ray refuses colors of a field and POV-Ray. A tube of radius 3.1 mm is 6.2 mm thick, and its
# transmitted light is exp(-2).
test_an_xray_shows_lengths_alone() {
    make_crossing
    sed -i '/^[34] /d' tree.swc
    printf '[vessel]\ncolor = 0 0 0\n[background]\ncolor = 1 1 1\n[xray]\nper_diameter = 2\n' >film.ini
    run_ok corcast render tree.swc --quiet --size 9x9 --antialias 1 --height 12 --location 0,0,50 --look-at 0,0,0 --look ./film.ini -o film.pfm
    tail -c $((81 * 12)) film.pfm | od -An -v -tf4 -w12 | sed -n 41p |
        awk '{ exit !($1 > 0.13533 && $1 < 0.13534) }' || fail "expected exp(-2) of the light in the middle"
    run corcast render tree.swc --look xray --color-by radius -o no.png
    expect_status 2
    expect_sentence '--color-by has no effect: --look xray uses two fixed colors'
    run corcast render tree.swc --look xray --ao 3 -o no.png
    expect_status 2
    expect_sentence '^corcast render: --ao has no effect on an x-ray, which has no light$'
    run corcast render tree.swc --look xray --shadows -o no.png
    expect_status 2
    expect_sentence '^corcast render: --shadows has no effect on an x-ray, which has no light$'
    run corcast scene tree.swc --quiet --look xray -o no.pov
    expect_status 2
    expect_sentence '--look xray: POV-Ray cannot draw an x-ray; use render'
    run corcast verify tree.swc --quiet --look xray -o report
    expect_status 2
    expect_only film.ini film.pfm tree.swc
}

test_a_light_that_cannot_be_is_refused_with_its_line_and_what_it_says() {
    local sentence change
    make_crossing
    while IFS='|' read -r change sentence; do
        printf '[vessel]\ncolor = 1 0.5 0.2\n[light lamp]\nposition = -1 2 3.5\nsize = 0.7\n' | sed "$change" >lamp.ini
        run corcast render tree.swc --quiet --look ./lamp.ini -o no.png
        expect_status 2
        expect_sentence "^corcast render: ./lamp.ini:$sentence\$"
    done <<'END'
s/= 0.7/= -0.7/|5: not a look: expected a number from 0 to 100, not 'size = -0.7'
s/-1 2 3.5/-1 2 1e9/|4: not a look: expected three numbers from -1000000 to 1000000, not all zero, not 'position = -1 2 1e9'
s/light lamp/lamp/|3: not a look: expected one of the sections .*, not \[lamp\]
s/size/sise/|5: not a look: expected direction, .*, not 'sise = 0.7'; did you mean size.
s/vessel/vesel/|1: not a look: expected one of the sections .*, not \[vesel\]; did you mean vessel.
s/.light lamp./[options]/|4: not a look: expected ao, shadows, projection or smooth, not 'position = -1 2 3.5'
END
}

# A parallel light with a size casts the shadows of a square light that is ten diagonals away, and
# without shadows draws the picture of a parallel light.
test_a_parallel_light_with_a_size_is_large_where_it_casts_shadows() {
    local finish='[vessel]\ncolor = 1 0.5 0.2\n[light lamp]\n'
    run_ok corcast grow --terminals 40 --domain ball:20 --seed 3 --quiet -o tree.swc
    printf "${finish}direction = 0 0 2\nsize = 0.5\n" >soft.ini
    printf "${finish}direction = 0 0 2\n" >hard.ini
    printf "${finish}position = 0 0 20\nsize = 10\n" >square.ini
    draw() { run_ok corcast render tree.swc --quiet --size 60x60 --look "./$1.ini" --shadows "$2" -o "$1.ppm"; }
    draw soft off
    draw hard off
    expect_same hard.ppm soft.ppm
    draw soft on
    draw square on
    expect_same square.ppm soft.ppm
    run_ok corcast verify tree.swc --quiet --size 60x45 --look ./soft.ini --shadows on -o report
}

# Shadows on thin vessels are soft in every look: of the pixels that shadows darken, few lose more
# than half of their light. Under hard shadows 7 % of the vessels' pixels do, and look like dashes.
test_no_look_cuts_thin_vessels_into_dashes() {
    local look
    run_ok corcast grow --terminals 1000 --domain ball:30 --seed 3 --quiet -o tree.swc
    for look in $(corcast looks | cut -f 1 | grep -v -e flat -e ink -e xray) "$REPO/tests/golden/red.ini"; do
        for shadows in off on; do
            run_ok corcast render tree.swc --quiet --size 200x200 --antialias 1 --ao 0 --smooth off --background white \
                --projection orthographic --look "$look" --shadows $shadows -o $shadows.ppm
        done
        dashes=$(paste <(tail -c 120000 off.ppm | od -An -v -tu1 -w3) <(tail -c 120000 on.ppm | od -An -v -tu1 -w3) |
            awk '{ a = $1 + $2 + $3; b = $4 + $5 + $6; n += a < 740; dark += b < 0.5 * a } END { printf "%d", 1000 * dark / n }')
        if [ "${look%.ini}" = "$look" ]; then
            [ "$dashes" -le 5 ] || fail "expected no dashes with the look $look, found $dashes of 1000 pixels"
        else
            [ "$dashes" -ge 20 ] || fail "expected dashes under hard shadows, found $dashes of 1000 pixels"
        fi
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

test_options_that_effects_leave_no_room_for_are_refused() {
    make_crossing
    run corcast render tree.swc --quiet --look journal --antialias-threshold 0.1 -o no.png
    expect_status 2
    expect_sentence '--antialias-threshold: --look journal needs all samples of every pixel'
    expect_only tree.swc
}

test_pictures_with_effects_are_the_same_whatever_the_memory_and_threads() {
    make_crossing
    run_ok corcast render tree.swc --quiet --size 90x201 --look ink -o whole.ppm
    run_ok corcast render tree.swc --quiet --size 90x201 --look ink --memory 0.01 --threads 1 -o bands.ppm
    expect_same whole.ppm bands.ppm
}

test_the_document_shows_every_look_as_its_command_draws_it() {
    local look
    for look in $(corcast looks | cut -f 1); do
        grep -q "^    corcast render .* --look $look .*-o $look.png$" "$REPO/docs/LOOKS.md" || fail "expected docs/LOOKS.md to draw $look"
        expect_file "$REPO/docs/images/looks/$look.png"
    done
    sed -n 's/^    corcast \(.*\)/\1 --quiet/p' "$REPO/docs/LOOKS.md" >commands
    while read -r command; do
        # shellcheck disable=SC2086
        run_ok corcast $command
    done <commands
    for look in *.png; do # depth.png is no plane of depths
        mv "$look" drawn
        cp "$REPO/docs/images/looks/$look" stored
        run_ok corcast compare stored drawn --levels 8 --ppm 20000
    done
}

run_tests "$@"
