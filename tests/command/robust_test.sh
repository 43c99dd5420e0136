#!/usr/bin/env bash
# Disturbances from outside: signals, full disks, closed streams, a POV-Ray that misbehaves, odd
# file names.
. "$(dirname "$0")/../lib.sh"

# ---- signals and streams -----------------------------------------------------------------------

test_a_signal_that_the_caller_ignores_stays_ignored() {
    local signal
    (trap '' HUP INT TERM && exec "$CORCAST" grow --terminals 20000 -o tree.swc) >stdout 2>stderr &
    sleep 0.1
    for signal in HUP INT TERM; do
        kill -$signal $! || fail "expected it still to run"
    done
    wait $! || fail "expected exit status 0 with signals ignored, got $?$(said)"
    expect_only tree.swc
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

test_what_finds_no_room_is_named_with_the_reason() {
    local file command
    grow_tree 60
    while read -r file command; do
        # shellcheck disable=SC2086
        (trap '' XFSZ && ulimit -f 1 && exec "$CORCAST" $command --quiet) >stdout 2>stderr
        [ $? -eq 3 ] || fail "expected exit status 3 from: $command$(said)"
        expect_sentence "^corcast [a-z]*: $file: writing( the TIFF)? failed: File too large$"
        expect_only tree.swc
    done <<'END'
t.graphml convert tree.swc t.graphml
t.gxl convert tree.swc t.gxl
t.svg diagram tree.swc -o t.svg
t.tif render tree.swc --size 90x90 -o t.tif
END
}

test_a_verdict_that_cannot_be_told_is_a_failure() {
    local stream
    grow_tree 3
    run_ok corcast render --exact tree.swc --size 30x20 -o a.png
    run_ok corcast render --exact tree.swc --size 30x20 --background 0,0,0 -o b.png
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
    "$CORCAST" render --exact tree.swc --size 30x20 -o a.png <&- >&- 2>&- || fail "expected exit status 0, got $?"
    pngtopnm a.png >a.ppm || fail "expected a picture"
}

# ---- a POV-Ray that misbehaves ------------------------------------------------------------------

# stand_in BODY: writes scene.pov, and a script that replaces POV-Ray. In BODY, $picture is the
# requested file.
stand_in() {
    echo '// Size: 20x10' >scene.pov
    printf '#!/bin/bash\nfor i; do case $i in +O*) picture=${i#+O} ;; esac; done\n%s\n' "$1" >povray.sh
    chmod +x povray.sh
    export CORCAST_POVRAY=$PWD/povray.sh
}

# Writes ./good.png, a PNG of 20 x 10 pixels like those of POV-Ray.
good_picture() {
    printf 'P6 20 10 255\n%600s' '' | pnmtopng -force >good.png 2>/dev/null
}

# is_gone PROCESS: the process has ended and has been reaped by its parent.
is_gone() {
    ! kill -0 "$1" 2>/dev/null
}

test_a_povray_that_falls_silent_is_ended() {
    local seconds
    stand_in 'echo Parsing; sleep 60 & echo $! >running; wait'
    seconds=$SECONDS
    run env CORCAST_POVRAY_PATIENCE=0.3 "$CORCAST" povray scene.pov -o picture.png
    expect_status 3
    expect_sentence 'POV-Ray was ended: it printed nothing for 0.3 s about scene.pov; set the environment variable CORCAST_POVRAY_PATIENCE'
    [ $((SECONDS - seconds)) -lt 50 ] || fail "expected it to be ended at once"
    wait_for 40 is_gone "$(cat running)" || fail "expected what the script runs to be ended, too"
    rm running
    stand_in 'exec >&- 2>&-; exec sleep 60'
    run env CORCAST_POVRAY_PATIENCE=0.3 "$CORCAST" povray scene.pov -o picture.png
    expect_status 3
    expect_only scene.pov povray.sh
    run env CORCAST_POVRAY_PATIENCE=soon "$CORCAST" povray scene.pov -o picture.png
    expect_status 2
    expect_sentence "CORCAST_POVRAY_PATIENCE: 'soon' is not a number of seconds"
}

test_a_povray_that_talks_without_progress_is_ended() {
    local seconds=$SECONDS
    stand_in 'while :; do echo "Rendered 5 of 200 pixels (2%)"; sleep 0.1; done'
    run env CORCAST_POVRAY_PATIENCE=0.3 timeout 30 "$CORCAST" povray scene.pov -o picture.png
    expect_status 3
    expect_sentence 'POV-Ray was ended: it printed text, but reported no progress for 1.5 s on scene.pov'
    stand_in 'for i in {1..300}; do echo "warning $i"; sleep 0.1; done'
    run env CORCAST_POVRAY_PATIENCE=0.3 timeout 30 "$CORCAST" povray scene.pov -o picture.png
    expect_status 3
    expect_sentence 'POV-Ray was ended: it printed text, but reported no progress for 1.5 s on scene.pov'
    [ $((SECONDS - seconds)) -lt 25 ] || fail "expected it to be ended soon"
    good_picture
    stand_in 'for i in {1..22}; do echo "Rendered $i of 200 pixels (0%)"; sleep 0.1; done; cp good.png "$picture"'
    run env CORCAST_POVRAY_PATIENCE=0.3 timeout 30 "$CORCAST" povray scene.pov -o picture.png
    expect_status 0
}

test_the_reason_of_a_povray_that_fails_is_what_it_said_last() {
    local start='echo "povray: cannot open the user configuration file x" >&2
        echo "Persistence of Vision(tm) Ray Tracer Version 3.7.0.10.unofficial" >&2; echo "POV-Ray is based on DKBTrace" >&2'
    stand_in "$start; echo 'Possible Parse Error: Cannot find it'; echo 'Parse Error: No such color'; echo 'Fatal error in parser: Cannot parse input.'
        echo 'Render failed'; exit 1"
    run corcast povray scene.pov -o picture.png
    expect_sentence '\(exit status 1\): Parse Error: No such color$'
    stand_in "$start; echo 'Cannot create render state output file.'; echo '  Bounding Time:    0 hours'; echo 'Render failed'; exit 1"
    run corcast povray scene.pov -o picture.png
    expect_sentence '\(exit status 1\): Cannot create render state output file\.   Bounding Time: '
    stand_in "$start; printf 'Rendered 5 of 200 pixels (2%%)\n\n'; kill -SEGV \$\$"
    run corcast povray scene.pov -o picture.png
    expect_sentence '\(exit status -1\): .*DKBTrace Rendered 5 of 200 pixels \(2%\)$'
    stand_in 'exit 4'
    run corcast povray scene.pov -o picture.png
    expect_sentence '\(exit status 4\): it gave no reason$'
}

test_a_child_that_povray_leaves_behind_is_not_waited_for() {
    local seconds=$SECONDS
    good_picture
    stand_in 'sleep 60 & cp good.png "$picture"'
    run_ok corcast povray scene.pov -o picture.png
    [ $((SECONDS - seconds)) -lt 50 ] || fail "expected the child not to be waited for"
    expect_same good.png picture.png
}

# 30 MB of output without an opening bracket, for which an earlier version took half a minute.
test_a_flood_of_words_takes_linear_time() {
    good_picture
    stand_in 'head -c 30000000 /dev/zero | tr "\0" w; echo; echo "Parse Error: at last"; exit 1'
    run bash -c 'ulimit -t 10; exec "$0" povray scene.pov -o picture.png' "$CORCAST"
    expect_status 3
    expect_sentence 'Parse Error: at last'
}

# The faulty files that POV-Ray may leave instead of a picture, and the errors of verify with exit
# status 3.
test_a_broken_picture_is_povrays_failure() {
    local body
    good_picture
    for body in 'echo text >"$picture"' 'head -c 999 /dev/urandom >"$picture"' 'head -c 60 good.png >"$picture"' \
        'pngtopnm good.png | pamdepth 65535 | pnmtopng >"$picture"' 'mkdir "$picture"' 'ln -s good.png "$picture"' \
        'pngtopnm good.png | pamcut 0 0 19 10 | pnmtopng -force >"$picture"' ':'; do
        stand_in "$body"
        run corcast povray scene.pov -o picture.png
        [ "$status" -eq 3 ] || fail "expected exit status 3, got $status from $body$(said)"
        expect_sentence 'POV-Ray ended without a complete picture of scene.pov: expected a PNG of 20 x 10 pixels'
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
            run timeout 300 "$CORCAST" povray $scene -o picture.png $size
            expect_status 2
            expect_sentence "^corcast povray: $scene: is a (folder|pipe or a device), not a file"
        done
    done
}

test_a_picture_cannot_be_put_in_the_place_of_a_pipe() {
    good_picture
    stand_in 'cp good.png "$picture"'
    mkfifo pipe.png
    run timeout 300 "$CORCAST" povray scene.pov -o pipe.png
    expect_status 3
    expect_sentence 'pipe.png: cannot be written: it is not a regular file'
    [ -p pipe.png ] || fail "expected the pipe to stay"
}

# ---- verify's folder ----------------------------------------------------------------------------

test_a_second_verification_into_a_folder_is_refused() {
    local first
    stand_in 'echo $$ >running; exec sleep 60'
    "$CORCAST" verify "$DATA/bifurcation.swc" --size 20x10 -o report 2>first.stderr &
    first=$!
    wait_for 100 test -s report/running || fail "expected the stand-in to start"
    run corcast verify "$DATA/bifurcation.swc" --size 20x10 -o ./report/
    expect_status 3
    expect_sentence '^corcast verify: ./report/: another verification is writing to this folder$'
    expect_file report/scene.pov
    kill -KILL $first
    wait $first 2>/dev/null
    rm report/running
    run env CORCAST_POVRAY_PATIENCE=0.2 "$CORCAST" verify "$DATA/bifurcation.swc" --size 20x10 -o report
    expect_sentence 'POV-Ray was ended'
}

test_a_failed_verification_leaves_no_verdict_of_an_earlier_one() {
    local tree
    stand_in 'exit 1'
    echo 'no tree' >broken.swc
    for tree in "$DATA/bifurcation.swc" broken.swc missing.swc; do
        mkdir -p report
        touch report/report.html report/report.json report/junit.xml report/povray.png report/exact.png report/mine.txt
        run corcast verify "$tree" --size 20x10 -o report
        [ "$status" -ge 2 ] || fail "expected a failure, got exit status $status"
        ls report | grep -vE '^(mine.txt|scene.pov|scene.inc|corcast_planes.inc)$' >found
        [ ! -s found ] || fail "expected no verdict and no picture of another run, found $(tr '\n' ' ' <found)"
        expect_same report/mine.txt /dev/null
    done
    mkdir report/report.json
    run corcast verify "$DATA/bifurcation.swc" --size 20x10 -o report
    expect_status 3
    expect_sentence 'report/report.json: cannot be written: it is a folder'
}

# ---- files over each other ----------------------------------------------------------------------

# refuses PATTERN ARGUMENTS ...: corcast exits with status 2 and one sentence, and changes no file.
refuses() {
    local pattern=$1
    shift
    md5sum -- *.* >before
    run corcast "$@"
    expect_status 2
    expect_sentence "$pattern"
    md5sum -- *.* >after
    expect_same before after
}

test_no_file_is_written_over_one_that_is_read() {
    local name
    cp "$DATA/bifurcation.swc" tree.swc
    run_ok corcast render --exact tree.swc --size 20x10 --planes id -o a.png
    ln -s a.png link.png
    ln a.png hard.png
    for name in a.png ./a.png "$PWD/a.png" link.png hard.png; do
        refuses "-o '$name' would be written over the input 'a.png'; choose another name" compare a.png a.png -o "$name"
    done
    refuses "--difference 'a.id.ppm' would be written over --ids-a" \
        compare a.png a.png --ids-a a.id.ppm --ids-b a.id.ppm --difference a.id.ppm
    refuses "the output 'tree.swc' would be written over the input" convert tree.swc tree.swc
    refuses "the output 'tree.swc' would be written over the input" convert - tree.swc <tree.swc
    refuses "-o 'tree.swc' would be written over the input" refine tree.swc -o tree.swc
    refuses "-o 'tree.swc' would be written over --from" grow --from tree.swc -o tree.swc
    refuses "--save 'tree.swc' would be written over the input" view tree.swc --save tree.swc
    printf '0 0\n9 0\n0 9\n' >outline.txt
    refuses "--domain 'outline.txt'" grow --domain polygon:outline.txt --json outline.txt -o new.swc
    cp "$REPO/templates/looks/cast.ini" mine.ini
    refuses "--json 'mine.ini' would be written over --look './mine.ini'" \
        render tree.swc --look ./mine.ini --json mine.ini -o b.png
    echo 'seed = 3' >recipe.ini
    refuses "--json 'recipe.ini' would be written over --recipe" \
        grow --terminals 3 --recipe recipe.ini --json recipe.ini -o new.swc
    mkdir report
    touch report/report.html report/report.json
    refuses "case's 'report/report.html'" report report -o report/report.html
    refuses "case's 'report/report.json'" report report -o "$PWD/report/report.json"
    cp tree.swc report/native.png
    refuses "-o 'report/native.png' would be written over the input" verify report/native.png -o report
    expect_same tree.swc report/native.png
}

test_no_file_is_written_twice() {
    cp "$DATA/bifurcation.swc" tree.swc
    run_ok corcast render --exact tree.swc --size 20x10 -o a.png
    refuses "-o 'j.swc' and --json 'j.swc' are the same file; write to two files" grow --terminals 3 -o j.swc --json j.swc
    refuses "-o 's.png' and --json './s.png' are the same file" render tree.swc -o s.png --json ./s.png
    refuses "--json 's.depth.pfm' and --planes 's.depth.pfm'" \
        render tree.swc -o s.png --json s.depth.pfm --planes depth
    refuses "-o 'x.png' and --difference 'x.png'" compare a.png a.png -o x.png --difference x.png
    refuses "--difference 'x.png' and --flicker 'x.png'" compare a.png a.png --difference x.png --flicker x.png
    refuses "-o and --json cannot both be standard output" grow --terminals 3 -o - --json -
    refuses "the input and the input cannot both be standard input" compare - -
    refuses "-o occurs twice" render tree.swc -o x.png -o y.png
    refuses "--look occurs twice" render tree.swc -o x.png --look cast --look=print
    refuses "--recipe occurs twice" grow --recipe tree.ini --recipe tree.ini -o x.swc
    ln -s there.swc link.swc
    refuses "-o 'link.swc' and --json 'there.swc' are the same file" grow --terminals 3 -o link.swc --json there.swc
    [ ! -e there.swc ] || fail "expected nothing to be written"
}

test_devices_and_ones_own_old_files_may_be_written() {
    local i
    cp "$DATA/bifurcation.swc" tree.swc
    for i in 1 2; do
        run_ok corcast render --exact tree.swc --size 20x10 --planes depth,id -o a.png --json a.json
        run_ok corcast compare a.png a.png -o heat.png --difference difference.png
    done
    run_ok corcast grow --terminals 3 -o new.swc --json /dev/null
    "$CORCAST" grow --terminals 3 -o new.swc --json /dev/stdout 2>/dev/null | cat >new.json
    expect_json new.json '.terminals == 3'
    echo 'size = 20x10' >recipe.ini
    echo 'output = old.png' >>recipe.ini
    run_ok corcast render --exact tree.swc --recipe recipe.ini -o new.png
    [ ! -e old.png ] || fail "expected the command line to win"
}

test_outputs_are_checked_before_work_begins() {
    local seconds=$SECONDS
    run corcast grow --terminals 50000000 -o tree.swc --json /nowhere/x.json
    expect_status 3
    expect_sentence '/nowhere/x.json: cannot be written: No such file'
    cp "$DATA/bifurcation.swc" tree.swc
    mkdir a.depth.pfm
    run corcast render tree.swc --model isosurface --antialias 9 --size 9999x9999 --planes depth -o a.png
    expect_status 3
    expect_sentence 'a.depth.pfm: cannot be written: it is a folder'
    run corcast compare tree.swc tree.swc --junit /nowhere/x.xml
    expect_sentence '/nowhere/x.xml: cannot be written'
    [ $((SECONDS - seconds)) -lt 50 ] || fail "expected these to be refused at once"
    expect_only tree.swc a.depth.pfm
}

# ---- options without effect ---------------------------------------------------------------------

test_options_without_effect_are_refused() {
    local sentence arguments
    cp "$DATA/bifurcation.swc" tree.swc
    cp "$DATA/bifurcation.swc" tree.pov
    while IFS='|' read -r sentence arguments; do
        # shellcheck disable=SC2086
        run corcast $arguments
        expect_status 2
        expect_sentence "^corcast [a-z]*: $sentence$"
    done <<'END'
--range needs --color-by|render tree.swc -o x.png --range 1,2
--log needs --color-by|scene tree.swc -o x.pov --log
--classes needs --color-by|render tree.swc -o x.png --classes 5
--colormap needs --color-by|verify tree.swc -o x --colormap magma
--hits is for --model isosurface|render tree.swc -o x.png --hits povray
--erf is for --model isosurface|scene tree.swc -o x.pov --model blob --erf exact
--cell-beta is for --model isosurface|verify tree.swc -o x --cell-beta 4
--ids is for --model isosurface and blob; other models need no extra data for ids|scene tree.swc -o x.pov --ids on
--bits: .16.: a .pfm always stores floats of 32 bits|render tree.swc -o x.pfm --bits 16
--antialias is for --plane color|povray tree.pov --size 9x9 -o x.png --plane id --antialias 3
--hematocrit is for --viscosity-law pries|grow --terminals 3 -o x.swc --hematocrit 0.3
--viscosity is for --viscosity-law constant|grow --terminals 3 -o x.swc --viscosity-law pries --viscosity 3
--plasma-viscosity is for --viscosity-law pries|info tree.swc --plasma-viscosity 1.3
--refine-moves needs --refine|grow --terminals 3 -o x.swc --refine-moves 100
--refine-seconds needs --refine|refine tree.swc -o x.swc --refine none --refine-seconds 3
--depth-mm is for two depth planes|compare a.png b.png --depth-mm 0.1
--levels is for two pictures|compare a.depth.pfm b.depth.pfm --levels 3
END
    expect_only tree.swc tree.pov
}

# Values in a recipe are defaults for many runs, so a value without effect in one run is accepted.
test_a_recipe_may_say_what_has_no_effect_in_this_run() {
    cp "$DATA/bifurcation.swc" tree.swc
    printf '[grow]\nhematocrit = 0.3\nrefine-moves = 9\n[render]\nrange = 1,2\ncolormap = magma\nhits = povray\nsize = 20x10\n' >all.ini
    run_ok corcast grow --terminals 3 --recipe all.ini -o x.swc
    run_ok corcast render --exact tree.swc --recipe all.ini --look data -o x.png
    run_ok corcast render --exact tree.swc --recipe all.ini --color-by radius -o y.png
    expect_differing 12 12 x.png y.png
}

# ---- names ----------------------------------------------------------------------------------------

NAMES=('José 日本.swc' $'a\n#error "x"\n.swc' $'\xff\xfe.swc' "o'neil & \"sons\"; \$(x) \`y\`.swc" '-o.swc' '<b>&amp;.swc' '%s%n.swc')

test_no_name_of_a_tree_becomes_code_of_a_scene() {
    local name plain
    cp "$DATA/bifurcation.swc" tree.swc
    run_ok corcast scene tree.swc -o plain.pov
    plain=$(wc -l <plain.pov)
    for name in "${NAMES[@]}"; do
        cp tree.swc "./$name"
        run_ok corcast scene "./$name" -o plain.pov
        [ "$(wc -l <plain.pov)" -eq "$plain" ] || fail "expected as many lines as of another name, with $name"
        ! grep -aE '^#error' plain.pov plain.inc || fail "expected no code from $name"
        run_ok corcast scene "./$name" -o - >/dev/null
    done
}

test_a_geometry_that_povray_cannot_include_is_refused() {
    local name
    cp "$DATA/bifurcation.swc" tree.swc
    for name in 'é.pov' 'a"b.pov' $'a\nb.pov' $'\xff.pov'; do
        run corcast scene tree.swc -o "$name"
        expect_status 2
        expect_sentence "POV-Ray cannot include a file called '.*\.inc'; use only printable ASCII"
    done
    expect_only tree.swc
    mkdir 'é"'
    run_ok corcast scene tree.swc -o 'é"/-a;b & c%.pov'
    expect_file 'é"/-a;b & c%.inc'
}

test_a_name_in_a_sentence_stays_in_its_line() {
    run corcast info $'a\nb\e[31m.swc'
    expect_status 2
    expect_sentence '^corcast info: a b \[31m.swc: cannot be read'
}

test_provenance_and_junit_are_text_whatever_the_name() {
    local name
    cp "$DATA/bifurcation.swc" tree.swc
    for name in "${NAMES[@]}"; do
        cp tree.swc "./$name"
        run_ok corcast render --size 20x10 -o a.png -- "./$name"
        LC_ALL=C.UTF-8 grep -qaE 'corcast render .* --size 20x10 -o P.png' a.png || fail "expected the command in the PNG of $name"
        cp a.png "./$name.png"
        run_ok corcast compare --junit a.xml -- "./$name.png" a.png
        python3 -c 'import xml.dom.minidom; xml.dom.minidom.parse("a.xml")' 2>lint || fail "expected XML from $name: $(tail -1 lint)"
    done
    run_ok corcast render --exact "./${NAMES[3]}" --size 20x10 -o a.png
    grep -qaF "'o'\\''neil & \"sons\"; \$(x) \`y\`.swc'" a.png || fail "expected the name in quotes"
}

test_names_may_be_as_long_as_the_system_allows() {
    local stem
    stem=$(printf 'n%.0s' $(seq 251))
    run_ok corcast grow --terminals 3 -o "$stem.swc"
    run_ok corcast scene "$stem.swc" -o "$stem.pov"
    run_ok corcast render --exact "$stem.swc" --size 20x10 -o "$stem.png"
    run corcast render "$stem.swc" --size 20x10 --planes depth -o "$stem.png"
    expect_status 3
    expect_sentence 'File name too long'
}

test_writing_over_keeps_permissions_and_links() {
    mkdir elsewhere
    ln -s elsewhere/tree.swc tree.swc
    run_ok corcast grow --terminals 3 -o tree.swc
    [ -L tree.swc ] && [ -f elsewhere/tree.swc ] || fail "expected the link to lead to the tree"
    chmod 600 elsewhere/tree.swc
    run_ok corcast grow --terminals 4 -o tree.swc
    [ "$(stat -c %a elsewhere/tree.swc)" = 600 ] || fail "expected the permissions to stay"
    ln -sf loop.swc loop.swc
    run corcast grow --terminals 3 -o loop.swc
    expect_status 3
    expect_sentence 'loop.swc: cannot be written: Too many levels of symbolic links'
}

run_tests "$@"
