#!/usr/bin/env bash
# Colors that change with time, and turns: POV-Ray with its own clock draws the same frames as
# corcast.
. "$(dirname "$0")/../lib.sh"

SIZE="--size 40x36"

# Makes a tree of 20 terminals and a pulse of 24 frames.
make_pulse() {
    run_ok corcast grow --terminals 20 --seed 5 --domain ball:20 --quiet -o tree.swc
    awk -f "$REPO/docs/examples/pulse.awk" tree.swc >pulse.csv
}

test_the_clock_of_povray_picks_the_frames_of_corcast() {
    make_pulse
    cut -d , -f 1,3,6,9,12 pulse.csv >four.csv
    # shellcheck disable=SC2086
    run_ok corcast scene tree.swc --color-by four.csv $SIZE --ini -o tree.pov
    grep -qx ';Final_Frame=4' tree.ini || fail "expected the frames in tree.ini: $(cat tree.ini)"
    # shellcheck disable=SC2086
    run_ok corcast render --exact tree.swc --color-by four.csv $SIZE --moments all -o ours%d.png
    run_ok povray +Itree.pov +Otheirs.png +W40 +H36 -D -A +KFI1 +KFF4 File_Gamma=srgb
    for k in 1 2 3 4; do
        run_ok corcast compare theirs$k.png ours$k.png
    done
    run corcast compare theirs2.png ours3.png
    expect_status 1
    run_ok povray +Itree.pov +Oone.png +W40 +H36 -D -A Declare=Tree_Frame=3 File_Gamma=srgb
    run_ok corcast compare one.png ours3.png
}

test_a_frame_is_verified_in_every_model() {
    make_pulse
    for model in $(corcast models | cut -f 1); do
        # shellcheck disable=SC2086
        run_ok corcast verify tree.swc --color-by pulse.csv --moment 7 --model "$model" $SIZE -o check
    done
    grep -q -e '+K0\.26' check/report.html || fail "expected the clock of frame 7 in the report"
    # shellcheck disable=SC2086
    run corcast verify tree.swc --quiet --color-by pulse.csv --moment 25 $SIZE -o check
    expect_status 2
    expect_sentence '--moment 25: pulse has 24 time steps'
}

# POV-Ray stores its clock in single precision, 2/3 as 0.66666669, so a code may be rounded
# differently.
test_a_turn_is_that_of_the_scene() {
    make_pulse
    view="$SIZE --location 3,20,80 --look-at 0,0,0 --projection perspective"
    # shellcheck disable=SC2086
    run_ok corcast scene tree.swc $view -o tree.pov
    # shellcheck disable=SC2086
    run_ok corcast render --exact tree.swc --turntable 3 $view -o ours%d.png
    run_ok povray +Itree.pov +Oclock.png +W40 +H36 -D -A +KFI1 +KFF3 +KC Declare=Turn_Clock=1 File_Gamma=srgb
    for k in 1 2 3; do
        run_ok povray +Itree.pov +Otheirs.png +W40 +H36 -D -A Declare=Tree_Turn=$((120 * (k - 1))) File_Gamma=srgb
        run_ok corcast compare theirs.png ours$k.png
        expect_differing 0 2 clock$k.png ours$k.png
    done
}

run_tests "$@"
