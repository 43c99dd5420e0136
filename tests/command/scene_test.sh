#!/usr/bin/env bash
# `scene`, and `povray` with scripts in place of POV-Ray. tests/povray runs the real program.
. "$(dirname "$0")/../lib.sh"

MODELS=$(corcast models | cut -f 1)

# stand_in BODY: makes ./povray.sh, which corcast then calls instead of POV-Ray.
stand_in() {
    printf '#!/bin/sh\n%s\n' "$1" >povray.sh
    chmod +x povray.sh
    export CORCAST_POVRAY=$PWD/povray.sh
}

test_every_model_gives_a_scene_and_its_geometry() {
    local model
    grow_tree 10
    for model in $MODELS; do
        run_ok corcast scene tree.swc --model $model -o $model.pov
        expect_file $model.pov
        expect_file $model.inc
        grep -q '^#version 3.7' $model.pov || fail "expected #version 3.7 in $model.pov"
        grep -q 'assumed_gamma 1' $model.pov || fail "expected assumed_gamma in $model.pov"
        grep -q "#include \"$model.inc\"" $model.pov || fail "expected $model.pov to include $model.inc"
    done
}

test_the_scene_opens_with_what_it_is_its_units_and_how_to_render_it() {
    grow_tree 10
    run_ok corcast scene tree.swc --size 321x123 -o scene.pov
    head -25 scene.pov >opening
    grep -qi 'millimet' opening || fail "expected the units in the opening comment"
    grep -q 'povray .*scene.pov.*+W321 +H123' opening || fail "expected how to render it: $(cat opening)"
    ! head -1 scene.pov | grep -qv '^//' || fail "expected a comment in the first line"
}

test_the_same_tree_gives_the_same_scene_wherever_it_is_written() {
    grow_tree 10
    mkdir elsewhere
    run_ok corcast scene tree.swc -o scene.pov
    run_ok corcast scene tree.swc -o elsewhere/scene.pov --threads 1
    expect_same scene.pov elsewhere/scene.pov
    expect_same scene.inc elsewhere/scene.inc
    ! grep -q "$PWD" scene.pov scene.inc || fail "expected no path in the scene"
}

test_a_scene_has_one_cylinder_a_segment() {
    grow_tree 10
    run_ok corcast scene tree.swc --model cylinders -o scene.pov
    [ "$(grep -c '^ *Vessel_Cylinder(' scene.inc)" -eq 19 ] ||
        fail "expected 19 cylinders, got $(grep -c '^ *Vessel_Cylinder(' scene.inc)"
}

test_no_template_value_is_left_unfilled() {
    local model
    grow_tree 10
    for model in $MODELS; do
        run_ok corcast scene tree.swc --model $model -o scene.pov
        # shellcheck disable=SC2016
        ! grep -n '\${' scene.pov scene.inc || fail "expected every \${name} to be filled"
    done
}

test_a_scene_of_another_kind_is_refused() {
    grow_tree 3
    run corcast scene tree.swc -o scene.blend
    expect_status 2
    expect_sentence 'blend'
    expect_only tree.swc
}

test_a_refused_scene_leaves_the_old_one() {
    echo precious >scene.pov
    printf '1 1 0 0 0 1 -1\n2 3 3 0 0 1\n' >bad.swc
    run corcast scene bad.swc -o scene.pov
    expect_status 2
    [ "$(cat scene.pov)" = precious ] || fail "expected the old scene to stay"
    expect_only bad.swc scene.pov
}

test_without_povray_the_command_says_how_to_get_it() {
    grow_tree 3
    run_ok corcast scene tree.swc -o scene.pov
    export CORCAST_POVRAY=$PWD/no-such-program
    run corcast povray scene.pov -o picture.png
    expect_status 3
    expect_sentence '(no-such-program|POV-Ray|povray)'
    run corcast verify tree.swc -o report --size 40x40
    expect_status 3
    expect_sentence '(no-such-program|POV-Ray|povray)'
    expect_only tree.swc scene.pov scene.inc $([ -d report ] && find report)
    [ ! -e report/report.json ] || fail "expected no report"
}

test_a_missing_scene_is_refused_by_name() {
    run corcast povray nowhere.pov -o picture.png
    expect_status 2
    expect_sentence 'nowhere\.pov'
    expect_only
}

test_the_errors_of_povray_are_passed_on_and_no_half_picture_stays() {
    grow_tree 3
    run_ok corcast scene tree.swc -o scene.pov
    stand_in 'for argument; do
    case $argument in +O*) echo half >"$(echo "${argument#+O}" | tr -d \")" ;; esac
done
echo "Parse Error: the moon is not a primitive" >&2; exit 1'
    run corcast povray scene.pov -o picture.png
    expect_status 3
    grep -q 'the moon is not a primitive' stderr || fail "expected POV-Ray's own error$(said)"
    expect_only tree.swc scene.pov scene.inc povray.sh
}

test_a_povray_that_writes_nothing_is_an_error() {
    grow_tree 3
    run_ok corcast scene tree.swc -o scene.pov
    stand_in 'exit 0'
    run corcast povray scene.pov -o picture.png
    expect_status 3
    [ ! -e picture.png ] || fail "expected no picture"
}

test_povray_is_called_headless_with_the_size_asked_for() {
    grow_tree 3
    run_ok corcast scene tree.swc -o scene.pov
    stand_in 'echo "$@" >>arguments; exit 1'
    run corcast povray scene.pov -o picture.png --size 123x45
    expect_status 3
    grep -q '+W123 +H45' "$(find . -name arguments)" || fail "expected +W123 +H45, got $(cat arguments)"
    grep -q -e '-D' arguments || fail "expected -D, got $(cat arguments)"
}

test_all_files_of_a_scene_take_their_names_or_none_does() {
    run_ok corcast scene "$DATA/bifurcation.swc" --ini -o s.pov
    expect_only s.pov s.inc s.ini
    grep -q '^Input_File_Name="s.pov"$' s.ini || fail "expected s.ini to name s.pov"
    rm s.*
    mkdir s.ini
    run corcast scene "$DATA/bifurcation.swc" --ini -o s.pov
    expect_status 3
    expect_sentence 's\.ini: cannot be written: it is a folder'
    expect_only s.ini
    run corcast scene "$DATA/bifurcation.swc" --recipe own.ini --ini -o own.pov
    expect_status 2
    printf 'size = 9x8\n' >own.ini
    run corcast scene "$DATA/bifurcation.swc" --recipe own.ini --ini -o own.pov
    expect_status 2
    expect_sentence 'the settings .own.ini. would be written over'
    run corcast scene "$DATA/bifurcation.swc" --ini -o 'a[b.pov'
    expect_status 2
    expect_sentence "POV-Ray cannot read an INI file called 'a\[b.ini'"
    run corcast scene "$DATA/bifurcation.swc" --ini -o -
    expect_status 2
    expect_sentence '^corcast scene: --ini writes a file beside S.pov'
    expect_only s.ini own.ini
}

run_tests "$@"
