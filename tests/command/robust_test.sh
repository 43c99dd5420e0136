#!/usr/bin/env bash
# What the world does to a run: signals, full disks, closed streams, a POV-Ray that misbehaves, odd names.
. "$(dirname "$0")/../lib.sh"

# ---- signals and streams -----------------------------------------------------------------------

test_a_signal_that_the_caller_ignores_stays_ignored() {
    local signal
    for signal in HUP INT TERM; do
        (trap '' $signal && exec "$CORCAST" grow --terminals 30000 -o tree.swc) >stdout 2>stderr &
        sleep 0.1
        kill -$signal $! || fail "expected it still to run"
        wait $! || fail "expected exit status 0 with $signal ignored, got $?$(said)"
        expect_only tree.swc
        rm tree.swc
    done
}

test_a_closed_pipe_is_told_where_sigpipe_is_ignored() {
    grow_tree 2000
    (
        trap '' PIPE
        corcast convert tree.swc - 2>stderr
        echo $? >status
    ) | head -1 >first
    [ "$(cat status)" = 3 ] || fail "expected exit status 3, got $(cat status)"
    grep -qE '^corcast convert: standard output: writing failed: Broken pipe$' stderr || fail "expected a sentence$(said)"
}

test_limits_of_size_leave_nothing() {
    grow_tree 3
    (ulimit -c 0 -f 20 && exec "$CORCAST" grow --terminals 2000 -o large.swc) >stdout 2>stderr
    [ $? -gt 128 ] || fail "expected SIGXFSZ to end it"
    expect_only tree.swc
    (trap '' XFSZ && ulimit -f 20 && exec "$CORCAST" grow --terminals 2000 -o large.swc) >stdout 2>stderr
    [ $? -eq 3 ] || fail "expected exit status 3 where SIGXFSZ is ignored"
    expect_sentence "large.swc: writing failed: File too large"
    expect_only tree.swc
}

test_a_verdict_that_cannot_be_told_is_a_failure() {
    local stream
    grow_tree 3
    run_ok corcast render tree.swc --size 30x20 -o a.png
    run_ok corcast render tree.swc --size 30x20 --background 0,0,0 -o b.png
    for stream in '>/dev/full' '>&-'; do
        for arguments in 'compare a.png b.png' 'compare a.png a.png' 'info tree.swc' --version --help; do
            eval "\$CORCAST $arguments $stream 2>stderr"
            [ $? -eq 3 ] || fail "expected exit status 3 from $arguments $stream"
            expect_sentence 'standard output: writing failed'
        done
    done
}

test_a_file_does_not_take_the_place_of_a_closed_stream() {
    "$CORCAST" grow --terminals 30 -o tree.swc >&- 2>&- || fail "expected exit status 0, got $?"
    check_tree tree.swc
    "$CORCAST" render tree.swc --size 30x20 -o a.png <&- >&- 2>&- || fail "expected exit status 0, got $?"
    pngtopnm a.png >a.ppm || fail "expected a picture"
}

# ---- a POV-Ray that misbehaves ------------------------------------------------------------------

# stand_in BODY: a scene.pov, and what draws it: a script in which $picture is the file asked for.
stand_in() {
    echo '// Size: 20x10' >scene.pov
    printf '#!/bin/bash\nfor i; do case $i in +O*) picture=${i#+O} ;; esac; done\n%s\n' "$1" >povray.sh
    chmod +x povray.sh
    export CORCAST_POVRAY=$PWD/povray.sh
}

# A PNG as POV-Ray writes it, 20 x 10, in ./good.png.
good_picture() {
    printf 'P6 20 10 255\n%600s' '' | pnmtopng -force >good.png 2>/dev/null
}

test_a_povray_that_falls_silent_is_ended() {
    local seconds
    stand_in 'echo Parsing; exec sleep 60'
    seconds=$SECONDS
    run env CORCAST_POVRAY_PATIENCE=0.3 "$CORCAST" povray scene.pov -o picture.png
    expect_status 3
    expect_sentence 'POV-Ray was ended: it has said nothing for 0.3 s about scene.pov; CORCAST_POVRAY_PATIENCE'
    [ $((SECONDS - seconds)) -lt 5 ] || fail "expected it to be ended at once"
    stand_in 'exec >&- 2>&-; exec sleep 60'
    run env CORCAST_POVRAY_PATIENCE=0.3 "$CORCAST" povray scene.pov -o picture.png
    expect_status 3
    expect_only scene.pov povray.sh
    run env CORCAST_POVRAY_PATIENCE=soon "$CORCAST" povray scene.pov -o picture.png
    expect_status 2
    expect_sentence "CORCAST_POVRAY_PATIENCE: 'soon' is not a number of seconds"
}

test_a_child_that_povray_leaves_behind_is_not_waited_for() {
    local seconds=$SECONDS
    good_picture
    stand_in 'sleep 7 & cp good.png "$picture"'
    run_ok corcast povray scene.pov -o picture.png
    [ $((SECONDS - seconds)) -lt 5 ] || fail "expected the child not to be waited for"
    expect_same good.png picture.png
}

# 30 MB without an opening bracket, which took half a minute.
test_a_flood_of_words_takes_linear_time() {
    local seconds=$SECONDS
    good_picture
    stand_in 'head -c 30000000 /dev/zero | tr "\0" w; echo; echo "Parse Error: at last"; exit 1'
    run corcast povray scene.pov -o picture.png
    expect_status 3
    expect_sentence 'Parse Error: at last'
    [ $((SECONDS - seconds)) -lt 10 ] || fail "expected 30 MB to be read in a moment"
}

# What is left where the picture should be, and what of it makes verify fail as the outside world does.
test_a_broken_picture_is_povrays_failure() {
    local body
    good_picture
    for body in 'echo text >"$picture"' 'head -c 999 /dev/urandom >"$picture"' 'head -c 60 good.png >"$picture"' \
        'pngtopnm good.png | pamdepth 65535 | pnmtopng >"$picture"' 'mkdir "$picture"' 'ln -s good.png "$picture"' \
        'pngtopnm good.png | pamcut 0 0 19 10 | pnmtopng -force >"$picture"' ':'; do
        stand_in "$body"
        run corcast povray scene.pov -o picture.png
        [ "$status" -eq 3 ] || fail "expected exit status 3, got $status from $body$(said)"
        expect_sentence 'POV-Ray ended without a picture of scene.pov: no whole PNG of 20 x 10 pixels'
        run corcast verify "$DATA/bifurcation.swc" --size 20x10 -o report
        [ "$status" -eq 3 ] || fail "expected exit status 3, got $status from verify and $body$(said)"
        [ "$(find . -name '.*' ! -name .)" = "" ] || fail "expected nothing hidden to be left by $body"
        [ ! -e picture.png ] || fail "expected no picture from $body"
        rm -r report
    done
}

test_only_a_regular_file_is_a_scene() {
    local scene
    mkdir folder
    mkfifo pipe
    for scene in folder pipe /dev/zero; do
        for size in '' '--size 5x5'; do
            # shellcheck disable=SC2086
            run timeout 5 "$CORCAST" povray $scene -o picture.png $size
            expect_status 2
            expect_sentence "^corcast povray: $scene: is a (folder|pipe or a device), not a file"
        done
    done
}

test_a_picture_cannot_be_put_in_the_place_of_a_pipe() {
    good_picture
    stand_in 'cp good.png "$picture"'
    mkfifo pipe.png
    run timeout 5 "$CORCAST" povray scene.pov -o pipe.png
    expect_status 3
    expect_sentence 'pipe.png: cannot be written: it is no file'
    [ -p pipe.png ] || fail "expected the pipe to stay"
}

run_tests "$@"
