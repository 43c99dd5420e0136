#!/usr/bin/env bash
# `power`: which faults planted in a renderer's picture a tolerance misses.
. "$(dirname "$0")/../lib.sh"

# Draws a picture of 96 x 64 pixels: a disc with a gradient and a highlight.
draw_picture() {
    awk 'BEGIN {
        print "P3 96 64 255"
        for (y = 0; y < 64; y++) for (x = 0; x < 96; x++) {
            r = sqrt((x - 47.3)^2 + (y - 30.8)^2)
            if (r > 25.6) print 231, 240, 250
            else if (r < 3) print 252, 251, 249
            else print int(200 - 3 * r), int(40 + 2 * x / 3), int(20 + y)
        }
    }' >drawn.ppm
}

# missed RULE FAULT: prints the sizes of the fault that the rule does not detect.
missed() {
    jq -c --arg rule "$1" --arg fault "$2" '[.faults[] | select(.fault == $fault and (.found[$rule] | not)) | .size]' power.json
}

test_says_from_which_size_on_a_tolerance_finds_each_fault() {
    draw_picture
    run_ok corcast power --quiet --render "pnmtopng $PWD/drawn.ppm >{}" --levels 9.5 --ppm 0
    expect_stdout '^96 x 64 pixels of 8 bits; two drawings are identical$'
    expect_stdout '^codes lower by 0.3 to 30 levels +10 '
    expect_stdout '^bits lost by 1 to 4 bits +4 '
    expect_stdout '^codes lower .* 1$'
    expect_stdout '^mirrored +found '
    expect_stdout '^brighter by 0.1 to 30 % of light +10 +never +never +10 +3 +[0-9.]+$'
    expect_only drawn.ppm
}

test_a_wider_tolerance_misses_more() {
    draw_picture
    run_ok corcast power --quiet --json --render 'cp drawn.ppm {}' --extension ppm --levels 2 --ppm 0
    cp stdout power.json
    expect_json power.json '(.rules[0].missed < .rules[3].missed) and (.planted > 60) and .repeats
        and ([.faults[] | select(.fault == "highlights dimmer")] | length) >= 3'
    [ "$(missed rule 'codes lower')" = '[1]' ] || fail "expected 1 level alone to be missed: $(missed rule 'codes lower')"
    [ "$(missed Blender 'a square lost')" = '[1,3]' ] || fail "expected squares to be missed: $(missed Blender 'a square lost')"
}

test_identity_finds_every_fault() {
    draw_picture
    run_ok corcast power --quiet --json --render 'cp drawn.ppm {}' --extension ppm --tier none --levels 0 --ppm 0
    cp stdout power.json
    expect_json power.json '.rules[0].missed == 0 and .rules[0].false_alarm == false'
}

test_a_verdict_of_another_program_is_asked_as_it_is() {
    draw_picture
    run_ok corcast power --quiet --json --render 'cp drawn.ppm {}' --extension ppm --verdict 'cmp -s {a} {b}'
    expect_json stdout '.rules[0].missed == 0'
    run_ok corcast power --quiet --json --render 'cp drawn.ppm {}' --extension ppm --verdict 'true {a} {b}'
    expect_json stdout '.rules[0].missed == .planted'
}

test_missed_faults_are_kept_as_pictures() {
    draw_picture
    run_ok corcast power --quiet --render 'cp drawn.ppm {}' --extension ppm --levels 2 --ppm 0 -o missed
    expect_file missed/codes-lower-1.png
    run corcast compare drawn.ppm missed/codes-lower-1.png --levels 0 --json
    expect_json stdout '.max_abs == 1'
    [ ! -e missed/mirrored.png ] || fail "expected no picture of a fault that is found"
}

test_a_renderer_that_does_not_repeat_itself_raises_a_false_alarm() {
    draw_picture
    run corcast power --quiet --extension ppm --levels 0 --ppm 0 \
        --render 'if [ -e once ]; then sed s/240/241/ drawn.ppm >{}; else touch once; cp drawn.ppm {}; fi'
    expect_status 1
    expect_stdout 'two drawings are different'
    expect_stdout '^false alarm: yours reports a difference between two drawings of the same scene$'
}

test_nothing_is_left_of_a_measurement_that_ends_early() {
    local signal
    for signal in TERM INT HUP; do
        hearing "$CORCAST" power --quiet --render 'echo a >{}.part; echo b >{}; echo c >started; sleep 60; true {}' &
        wait_for 100 test -e started || fail "expected the renderer to start"
        kill -$signal $!
        wait $!
        rm started
        expect_only
    done
    run corcast power --quiet --render 'echo a >{}.part; exit 7'
    expect_status 3
    expect_only
}

test_what_cannot_be_asked_is_refused() {
    run corcast power
    expect_status 2
    expect_sentence '--render needs a command with \{\} in place of the output file'
    run corcast power --render 'cp a b'
    expect_status 2
    expect_sentence '--render needs a command with \{\} in place of the output file'
    run corcast power --render 'cp a {}' --verdict 'cmp {a}'
    expect_status 2
    expect_sentence '--verdict needs a command with \{a\} and \{b\}'
    run corcast power --render 'cp a {}' --verdict 'cmp {a} {b}' --ppm 3
    expect_status 2
    expect_sentence '--ppm and --verdict are two rules'
    run corcast power --quiet --render 'exit 7 # {}'
    expect_status 3
    expect_sentence '--render: the command fails \(exit status 7\)'
    run corcast power --quiet --render 'echo text >{}'
    expect_status 3
    expect_sentence '--render: .*is not a PBM'
    run corcast power --quiet --render 'true {}'
    expect_status 3
    expect_sentence '--render: '
    expect_only
}

# repeats N: draws the picture with N seeds of noise. A tenth of the pixels differ by one to four
# levels.
repeats() {
    draw_picture
    for seed in $(seq "$1"); do
        awk -v seed="$seed" 'BEGIN { srand(seed) } NR == 1 { print; next }
            { for (i = 1; i <= NF; i++) { sub(/,/, "", $i); if (rand() < 0.04) $i -= 1 + int(4 * rand()) } print }' drawn.ppm >r$seed.ppm
    done
}

test_the_tightest_tolerance_that_repeats_agree_with_is_chosen() {
    repeats 6
    run_ok corcast power r?.ppm --choose c.ini --json
    cp stdout power.json
    expect_json power.json '.choice | .renderings == 5 and .rank == 5 and (.rate * 6 | . > 0.999 and . < 1.001)'
    expect_json power.json '.choice.rate_95 | . > 0.4507 and . < 0.4508' # 1 - 0.05^(1/5)
    expect_json power.json '.choice.missed == .rules[0].missed and .choice.planted == .planted'
    expect_json power.json '.rules[0].false_alarm == false and .rules[0].missed < .rules[3].missed'
    for i in 2 3 4 5 6; do
        run_ok corcast compare r1.ppm r$i.ppm --tolerance c.ini
    done
    # With a tolerance that is one level lower, at least one repeat is rejected: the tolerance is as
    # tight as possible.
    awk -F ' = ' '$1 == "color_levels" { print "color_levels = " $2 - 1; next } { print }' c.ini >tighter.ini
    for i in 2 3 4 5 6; do corcast compare r1.ppm r$i.ppm --tolerance tighter.ini >stdout || echo $i; done >rejected
    [ -s rejected ] || fail "expected a repeat to be rejected by $(cat tighter.ini)"
}

test_a_rate_takes_as_many_repeats_as_it_needs() {
    repeats 4
    run corcast power r?.ppm --choose c.ini --alarms 0.2
    expect_status 2
    expect_sentence '3 renderings besides the reference guarantee a false alarm rate of 0.25 at best; a rate of 0.2 needs 4'
    run_ok corcast power r?.ppm --choose c.ini --alarms 0.5
    expect_stdout 'rank 2 among the counts of 3 renderings, from the smallest'
    run corcast power r1.ppm r2.ppm --choose d.ini
    expect_status 2
    expect_sentence 'a reference and at least two more renderings'
    run corcast power r1.ppm r2.ppm --render 'cp r1.ppm {}'
    expect_sentence 'pictures are operands only with --choose'
    pnmcut -width 9 r1.ppm >small.ppm
    run corcast power r1.ppm r2.ppm small.ppm --choose d.ini
    expect_sentence 'picture 3 has another size'
}

test_repeats_that_are_equal_have_a_tolerance_that_misses_nothing() {
    repeats 1
    cp r1.ppm r2.ppm
    cp r1.ppm r3.ppm
    run_ok corcast power r?.ppm --choose c.ini --json
    expect_json stdout '.choice | .missed == 0 and .color_levels == 0 and .color_ppm == 0'
}

run_tests
