#!/usr/bin/env bash
# `pulse`: waves against a sparse solution of all nodes with Bessel functions and against a nonlinear solver, decks
# against an independent solver, reports, films and scenes, and all inputs that it refuses. tests/unit/pulse_test.c
# has the checks of single vessels.
. "$(dirname "$0")/../lib.sh"

oracle() {
    PERIOD=0.8 HARMONICS=16 OUTLET_TIME=1 VENOUS=0 WALL=2.0e6,-2.253,8.65e4 \
        run /usr/bin/python3 "$REPO/tests/oracle/pulse.py" "$@"
    expect_status 0
}

# A cycle of 0.8 s with 16 harmonics and more.
make_drive() {
    awk 'BEGIN {
        print "time,pressure"
        for (m = 0; m <= 100; m++) {
            a = 2 * 3.14159265358979 * (m % 100) / 100
            print m * 0.008 "," 90 + 20 * sin(a) + 8 * sin(5 * a + 1) + (m % 100 == 30 ? 9 : 0)
        }
    }' >drive.csv
}

test_waves_agree_with_a_sparse_solution_of_all_nodes() {
    make_drive
    run_ok corcast grow --domain ball:30 --terminals 300 --seed 3 -o tree.swc
    run_ok corcast pulse tree.swc --drive drive.csv --wall olufsen --outlet-time 1 --venous-pressure 0 \
        --fields pressure,flow --frames 40 -o v.csv --impedance z.csv --threads 1
    oracle waves tree.swc v.csv z.csv
    mv v.csv one.csv
    run_ok corcast pulse tree.swc --drive drive.csv --wall olufsen --outlet-time 1 --venous-pressure 0 \
        --fields pressure,flow --frames 40 -o v.csv --threads 3
    expect_same v.csv one.csv
}

test_a_solved_deck_has_the_waves_of_the_tree_and_its_results_are_read() {
    local drive
    run_ok corcast grow --domain ball:30 --terminals 50 --seed 3 -o tree.swc
    for drive in aortic-pressure aorta-flow 'aortic-pressure --tissue-pressure ventricular-pressure --wall olufsen'; do
        # shellcheck disable=SC2086
        run_ok corcast pulse tree.swc --drive $drive -o deck.json --summary s.csv --period 0.8
        HARMONICS=8 run /usr/bin/python3 "$REPO/tests/oracle/pulse.py" deck deck.json s.csv r.csv
        expect_status 0
    done
    run_ok corcast render tree.swc --color-by r.csv:flow_in --moment 3 --size 60x60 -o q.png
    run_ok corcast convert tree.swc tree.vtp --values r.csv
    run_ok corcast info tree.vtp
    expect_stdout 'pressure_out.*25 frames, 0 to 0.8'
}

# The table of the differences is in docs/PULSE.md.
test_the_waves_of_a_body_are_near_those_of_a_nonlinear_solver() {
    run /usr/bin/python3 "$REPO/tests/oracle/openbf.py" "$CORCAST" "$REPO/tests/data"
    expect_status 0
}

# Flow that reverses, and pressure that falls below the venous pressure.
test_the_report_warns_where_the_model_does_not_hold() {
    run_ok corcast grow --domain ball:30 --terminals 50 --seed 3 -o tree.swc
    run_ok corcast pulse tree.swc --drive aorta-flow --outlet-time 0 --json
    expect_json stdout '.osi_max > 0.05 and .reversing_fraction == 1 and .velocity_over_wave_speed_max > 0.25'
    expect_json stdout '.resistance_mmhg_s_ml > 11 and .resistance_mmhg_s_ml < 12'
    grep -q 'below the venous pressure' stderr || fail "expected a warning about the pressure"
    # The drive is the flow of the first segment, not its pressure.
    run_ok corcast pulse tree.swc --drive aorta-flow --summary s.csv
    awk -F, 'NR == 2 { exit !($9 > 5.6 * $6 && $9 < 5.9 * $6) }' s.csv || fail "expected the flow of the drive"
    run_ok corcast pulse tree.swc --pulse-pressure 44 --wall olufsen --json
    expect_json stdout '.osi_max == 0 and .inlet_pressure_mmhg[1] - .inlet_pressure_mmhg[0] > 43.5'
    expect_json stdout '.inlet_pressure_mmhg[1] - .inlet_pressure_mmhg[0] < 44.5'
}

# With pressure of the tissue, more of the blood enters the tree in diastole.
test_tissue_pressure_moves_flow_to_diastole() {
    local share
    run_ok corcast grow --domain ball:30 --terminals 50 --q-perf 60 --seed 3 -o tree.swc
    for share in 0 1; do
        run_ok corcast pulse tree.swc --tissue-pressure ventricular-pressure --tissue-share $share --fields flow \
            --frames 20 -o v$share.csv
        # Mean flow of the first 0.4 s less that of the rest, in the first segment.
        awk -F, 'NR == 2 { for (m = 2; m <= 21; m++) s += (m < 10 ? 1 / 8 : -1 / 12) * $m; print s }' v$share.csv >d$share
    done
    awk 'NR == FNR { a = $1; next } { exit !(a > 0 && $1 < 0) }' d0 d1 || fail "expected $(cat d0 d1) to change its sign"
}

test_a_film_and_a_scene_show_the_same_beat() {
    run_ok corcast grow --domain ball:30 --terminals 12 --seed 3 -o tree.swc
    printf '[render]\nantialias = 1\n' >r.ini
    run_ok corcast pulse tree.swc --fields wss --frames 3 --size 240x240 -o f%d.png --recipe r.ini
    run_ok corcast pulse tree.swc --fields wss --frames 3 --size 240x240 -o beat.pov
    run_ok povray +Ibeat.pov +Ob.png +W240 +H240 -D +KFI1 +KFF3
    for k in 1 2 3; do
        expect_differing 0 0 b$k.png f$k.png
    done
    expect_differing 500 57600 f1.png f2.png
    run_ok corcast pulse tree.swc --fields wss,dilation --frames 3 -o t.vtp
    run_ok corcast render t.vtp --color-by wss --beat 10 --moments all --size 240x240 --antialias 1 -o g%d.png
    expect_differing 0 0 f2.png g2.png
    # At a factor of 30 the vessel that is thickest at a bifurcation is another one than at rest.
    run_ok corcast scene t.vtp --color-by wss --beat 30 --size 240x240 -o s.pov
    run_ok povray +Is.pov +Os.png +W240 +H240 -D +KFI1 +KFF3
    run_ok corcast render t.vtp --color-by wss --beat 30 --moments all --size 240x240 --antialias 1 --exact -o h%d.png
    expect_differing 0 0 s1.png h1.png
    expect_differing 0 0 s3.png h3.png
    run_ok corcast verify t.vtp --color-by wss --beat 30 --moment 1 --size 240x240 --antialias 1 -o check --json
    mv stdout said.json
    expect_json said.json '.verdict == "agree"'
    run corcast verify t.vtp --color-by wss --beat 30 --model joined -o no
    expect_sentence 'rounded and cylinders'
    run corcast scene t.vtp --color-by wss --beat 10 --model joined -o s.pov
    expect_sentence 'rounded and cylinders'
    run corcast render tree.swc --color-by wss --beat 10 --moment 1 -o s.png
    expect_sentence 'no series dilation'
    { echo id,dilation; awk '!/^#/ { print $1 ",1.1" }' tree.swc; } >still.csv
    run_ok corcast convert tree.swc still.vtp --values still.csv
    run corcast render still.vtp --color-by flow --beat 10 --moment 1 -o s.png
    expect_sentence 'no series dilation'
    run corcast render t.vtp --color-by radius --beat 10 -o s.png
    expect_status 2
    expect_sentence "the field .radius. does not change in time"
}

test_structured_trees_given_outlets_and_series_are_written() {
    run_ok corcast grow --domain ball:30 --terminals 12 --seed 3 -o tree.swc
    run_ok corcast pulse tree.swc --outlets structured --wall-time 0.01 --summary s.csv -o t.pvd --frames 2
    expect_file t_0002.vtp
    expect_stdout '^  Womersley'
    awk '!/^#/ { id[++n] = $1; has[$7] } END { print "id,rp,c,rd"
        for (k = n; k > 0; k--) if (!(id[k] in has) && ++m < 4) print id[k] ",0.5,0.01,3" }' tree.swc >outlets.csv
    run_ok corcast pulse tree.swc --outlets outlets.csv --json
    run_ok corcast waveforms
    expect_stdout '^aortic-pressure	pressure	1 s	'
    run_ok corcast walls
    expect_stdout '^adan	'
}

# refuses PATTERN OPTION...: pulse refuses the options for tree.swc with one sentence, and writes nothing.
refuses() {
    local pattern=$1
    shift
    run corcast pulse tree.swc --json "$@"
    expect_status 2
    expect_sentence "$pattern"
}

test_bad_inputs_are_refused() {
    run_ok corcast grow --domain ball:30 --terminals 5 --seed 3 -o good.swc
    printf '1 3 0 0 0 1 -1\n2 3 0 0 9 1 1\n3 3 5 0 12 0.5 2\n4 3 -5 0 12 0.4 2\n' >tree.swc
    local blood=(--p-perf 100 --q-perf 100 --viscosity 3.6)
    refuses '\-\-q-perf'
    refuses '\-\-p-perf' --q-perf 100
    refuses 'outlet at node [34] has a mean pressure of .* not above the venous' "${blood[@]}" --venous-pressure 99.99
    refuses 'E h / r of segment 2, radius 1 mm, is -' "${blood[@]}" --wall 1e3,-1,-1e4
    refuses 'neither a law \(adan, .*, rigid\) nor' "${blood[@]}" --wall soft
    sed -i 's/ 0.5 2$/ 0 2/' tree.swc
    refuses 'segment 3 has the radius 0' "${blood[@]}"
    sed -i 's/^3.*/3 3 0 0 9 0.5 2/' tree.swc
    refuses 'segment 3 has the length 0' "${blood[@]}"
    cp good.swc tree.swc
    refuses 'period' --period 0
    refuses 'period' --period -1
    refuses 'harmonics' --harmonics 0
    refuses 'harmonics' --harmonics 65
    run_ok corcast pulse tree.swc --harmonics 64 --json
    expect_json stdout '.harmonics == 8'
    printf 'time,p\n0,80\n0.3,120\n0.2,90\n0.8,80\n' >bad.csv
    refuses 'bad.csv:4: the time is 0.2, after 0.3' --drive bad.csv
    printf '0,80\n0.3,120\n0.5,90\n0.8,82\n' >bad.csv
    refuses 'not closed: it begins at 80 and ends at 82' --drive bad.csv
    echo 'time,value' >empty.csv
    refuses 'empty.csv: the waveform has 0 samples; it needs at least 3' --drive empty.csv
    printf '0,1\n0.2,0\n0.4,-1\n0.6,0\n0.8,1\n' >bad.csv
    refuses 'mean of the waveform' --drive bad.csv
    printf '0,80\n0.3,120\n0.5,90\n0.8,80\n' >bad.csv
    refuses '8 harmonics need at least 17 samples, and the waveform has 4' --drive bad.csv --harmonics 8
    printf '0,80\n0.3,nan\n0.8,80\n' >bad.csv
    refuses 'bad.csv:2: ' --drive bad.csv
    printf '0,80\n0.3,90\n0.8\n' >bad.csv
    refuses 'bad.csv:3: ' --drive bad.csv
    printf '0,80\n0.3,90\n0.8,80\n' >bad.csv
    refuses '\-\-period is for a --drive template' --drive bad.csv --period 1
    refuses 'is a flow' --drive aorta-flow --drive-is pressure
    refuses 'pulse-pressure' --drive aorta-flow --pulse-pressure 40
    refuses 'lasts 0.8 s, but the cycle' --tissue-pressure bad.csv
    refuses 'needs --outlets rcr' --tissue-pressure ventricular-pressure --outlets structured
    printf 'id,rp,c,rd\n2,1,-1,2\n' >bad.csv
    refuses 'outlet 2 has rp 1, c -1 and rd 2' --outlets bad.csv
    printf 'id,rp,c,rd\n%s,0.5,0.01,3\n' "$(awk '$7 == 1 { print $1; exit }' tree.swc)" >bad.csv
    refuses 'bad.csv: segment [0-9]+ is not an outlet' --outlets bad.csv
    printf '0,80\n0.4,120\n1,80\n' >p.csv
    refuses '\-\-ventricle is for a --tissue-pressure template' --tissue-pressure p.csv --ventricle 5,120
    refuses 'not A,B, two numbers with A below B$' --tissue-pressure ventricular-pressure --ventricle 10%,90%
    refuses 'has no effect on --outlets structured' --outlets structured --outlet-time 2
    refuses 'is for --outlets structured' --outlet-radius 0.1
    refuses 'and --tissue-pressure' --outlet-time 2 --tissue-pressure ventricular-pressure
    refuses 'aorta-flow is a flow; a pressure' --tissue-pressure aorta-flow
    refuses 'not a file that ends in .csv' --summary s.json
    refuses 'is not pressure, flow' --fields speed -o v.csv
    refuses '\-\-wall-time has no effect on --wall rigid' --wall rigid --wall-time 0.1
    refuses '\-\-frames is for an output with time steps' --frames 12
    refuses '\-\-fields is for an output with time steps' --fields wss -o d.json
    refuses 'must end in' -o v.gif
    refuses 'cannot store' -o v.swc
    refuses 'cannot hold structured' --outlets structured -o d.json
    refuses 'exaggerate' --exaggerate 3 -o v.csv
    run corcast pulse tree.swc
    expect_sentence '--json is missing'
}

run_tests
