#!/usr/bin/env bash
# A run that is stopped leaves no file under the final name, no temporary file, and the old file
# unchanged.
. "$(dirname "$0")/../lib.sh"

# stop_after SECONDS SIGNAL COMMAND ...: starts the command, sends it the signal after SECONDS, and
# sets $status.
stop_after() {
    local seconds=$1 signal=$2
    shift 2
    command_line="$* (stopped by $signal)"
    hearing "$@" >stdout 2>stderr &
    sleep "$seconds"
    kill -"$signal" $! 2>/dev/null || fail "expected it still to run after $seconds s: $command_line$(said)"
    wait $! 2>/dev/null
    status=$?
    [ "$status" -ne 0 ] || fail "expected an exit status other than 0 from: $command_line"
}

test_a_stopped_grow_leaves_nothing() {
    local signal
    for signal in TERM INT HUP; do
        stop_after 0.3 $signal "$CORCAST" grow --terminals 3000000 -o tree.swc
        expect_only
    done
}

test_a_stopped_grow_leaves_the_old_tree() {
    echo precious >tree.swc
    stop_after 0.3 TERM "$CORCAST" grow --terminals 3000000 -o tree.swc
    [ "$(cat tree.swc)" = precious ] || fail "expected the old tree to stay"
    expect_only tree.swc
}

test_a_stopped_render_leaves_nothing() {
    local signal
    grow_tree 300
    for signal in TERM INT; do
        stop_after 0.5 $signal "$CORCAST" render --exact tree.swc --model isosurface --size 3000x3000 \
            --antialias 9 --planes depth,normal,id -o picture.png
        expect_only tree.swc
    done
}

# Makes a script that replaces POV-Ray: it writes half a picture, starts a process that runs for a
# minute, and writes the process id to the file `running`.
slow_povray() {
    cat >povray.sh <<'END'
#!/bin/sh
for argument; do
    case $argument in +O*) echo half >"${argument#+O}" ;; esac
done
sleep 60 &
echo $! >running
wait
END
    chmod +x povray.sh
    export CORCAST_POVRAY=$PWD/povray.sh
}

test_a_stopped_povray_leaves_nothing_and_does_not_run_on() {
    local signal pid
    grow_tree 3
    run_ok corcast scene tree.swc -o scene.pov
    slow_povray
    for signal in TERM INT; do
        hearing "$CORCAST" povray scene.pov -o picture.png >stdout 2>stderr &
        wait_for 100 test -s running || fail "expected the stand-in to start$(said)"
        pid=$(cat running)
        kill -$signal $!
        wait $!
        status=$?
        [ "$status" -ne 0 ] || fail "expected an exit status other than 0"
        rm running
        wait_for 40 not_running "$pid" || {
            kill "$pid"
            fail "expected POV-Ray to be stopped by $signal, too"
        }
        expect_only tree.swc scene.pov scene.inc povray.sh
    done
}

test_all_of_the_povrays_of_verify_are_stopped() {
    local pids pid
    grow_tree 3
    slow_povray
    sed -i 's/>running/>>running/' povray.sh
    hearing "$CORCAST" verify tree.swc --size 40x30 -o report >stdout 2>stderr &
    wait_for 100 three_run || fail "expected three stand-ins to start$(said)"
    pids=$(cat report/running)
    kill -TERM $!
    wait $!
    for pid in $pids; do
        wait_for 40 not_running "$pid" || {
            kill "$pid"
            fail "expected each POV-Ray to be stopped"
        }
    done
    (cd report && expect_only corcast_planes.inc running scene.inc scene.pov)
}

three_run() {
    [ "$(cat report/running 2>/dev/null | wc -l)" -eq 3 ]
}

not_running() {
    ! kill -0 "$1" 2>/dev/null
}

test_a_closed_pipe_ends_the_program_quietly() {
    grow_tree 500
    corcast convert tree.swc - 2>stderr | head -1 >first
    [ ! -s stderr ] || fail "expected silence$(said)"
    expect_only tree.swc first
}

run_tests "$@"
