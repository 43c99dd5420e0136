#!/usr/bin/env bash
# Scenes as an artist uses them: POV-Ray alone, values set on its command line and by #declare.
. "$(dirname "$0")/../lib.sh"

MODELS=$(corcast models)

# draw SCENE ARGUMENT...: a small picture, SCENE.png, and POV-Ray's words in SCENE.log.
draw() {
    local scene=$1
    shift
    povray +I"$scene".pov +O"$scene".png +W60 +H45 -D "$@" >"$scene".log 2>&1 ||
        fail "expected POV-Ray to draw $scene.pov: $(tail -3 "$scene".log | tr '\n' ' ')"
}

expect_no_warning() {
    ! grep -q 'Warning:' "$1".log || fail "expected no warning: $(grep -m 1 'Warning:' "$1".log)"
}

# values PICTURE X Y [-alpha]: red, green and blue of a pixel, or its alpha, 0 to 255.
values() {
    pngtopnm ${4:-} "$1" | pamcut -left "$2" -top "$3" -width 1 -height 1 | pnmtoplainpnm | tail -1 | xargs
}

# scene_of_a_vessel MODEL OUTPUT: its wall fills the picture.
scene_of_a_vessel() {
    run_ok corcast scene "$DATA/bifurcation.swc" --quiet --model "$1" --size 60x45 \
        --location 0.625,-8.75,30 --look-at 0.625,-8.75,0 --height 2 -o "$2"
}

test_no_model_makes_povray_warn() {
    local model
    run_ok corcast grow --quiet --terminals 300 --seed 3 -o tree.swc
    for model in $MODELS; do
        run_ok corcast scene tree.swc --quiet --model "$model" --color-by radius --size 60x45 -o "$model.pov"
        draw "$model"
        expect_no_warning "$model"
    done
    grep -q Blob_Cell blob.inc || fail "expected a blob of many cells"
}

# The vessel in the middle is blue, of whatever model, without a change of the files.
test_colours_are_set_by_numbers_on_the_command_line() {
    local model
    for model in $MODELS; do
        scene_of_a_vessel "$model" "$model.pov"
        draw "$model" Declare=Vessel_Red=0 Declare=Vessel_Green=0 Declare=Vessel_Blue=1 Declare=Vessel_Phong=0
        [[ $(values "$model.png" 30 22) =~ ^0\ 0\ [12][0-9][0-9]$ ]] ||
            fail "expected a blue vessel as $model, got $(values "$model.png" 30 22)"
    done
    run_ok corcast scene "$DATA/bifurcation.swc" --quiet --size 60x45 -o back.pov
    draw back Declare=Background_Red=0 Declare=Background_Green=1 Declare=Background_Blue=0
    [ "$(values back.png 0 0)" = "0 255 0" ] || fail "expected a green background, got $(values back.png 0 0)"
}

# What stands behind is seen through the vessel, and POV-Ray has nothing to say against it.
test_glass_is_declared_before_the_geometry() {
    local model
    for model in $MODELS; do
        scene_of_a_vessel "$model" plain.pov
        { printf '#version 3.7;\n#declare Vessel_Color = rgbf <1, 1, 1, 1>;\n#declare Vessel_Ambient = 0;\n'
          printf '#declare Vessel_Diffuse = 0;\n#declare Vessel_Phong = 0;\n#declare Background_Color = rgb <1, 0, 0>;\n'
          printf '#include "plain.pov"\n'; } >"$model.pov"
        draw "$model"
        expect_no_warning "$model"
        [ "$(values "$model.png" 30 22)" = "255 0 0" ] ||
            fail "expected the background behind the glass of $model, got $(values "$model.png" 30 22)"
    done
}

test_the_background_can_be_transparent() {
    run_ok corcast scene "$DATA/bifurcation.swc" --quiet --size 60x45 -o seen.pov
    draw seen +UA Declare=Background_Transmit=1
    [ "$(values seen.png 0 0 -alpha)" = 0 ] || fail "expected a transparent corner"
    draw seen +UA
    [ "$(values seen.png 0 0 -alpha)" = 255 ] || fail "expected an opaque corner"
}

run_tests "$@"
