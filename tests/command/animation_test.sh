#!/usr/bin/env bash
# Several pictures of one tree: frames of values that change with time, turns, growth. Also files of
# values that color segments.
. "$(dirname "$0")/../lib.sh"

SMALL="--size 60x50 --quiet"

# Makes a tree of 25 terminals in a ball, and pulse.csv, a wave that travels through the tree in 8
# frames.
make_pulse() {
    run_ok corcast grow --terminals 25 --seed 3 --domain ball:20 --quiet -o tree.swc
    awk 'BEGIN { printf "id"; for (k = 0; k < 8; k++) printf ",%.3f", k / 8; print "" }
        !/^#/ && $7 > 0 {
            printf "%d", $1
            for (k = 0; k < 8; k++) printf ",%.4f", 93 + 27 * sin(6.28318 * (k / 8 - $1 / 50))
            print ""
        }' tree.swc >pulse.csv
}

test_each_frame_is_the_picture_of_its_moment() {
    make_pulse
    # shellcheck disable=SC2086
    run_ok corcast render --exact tree.swc --color-by pulse.csv --moments all $SMALL --planes id -o f%02d.ppm
    [ "$(echo f*.ppm)" = "$(echo f0{1..8}{.id,}.ppm)" ] || fail "expected 8 pictures and planes, got $(echo f*)"
    for k in 1 3 8; do
        # shellcheck disable=SC2086
        run_ok corcast render --exact tree.swc --color-by pulse.csv:pulse --moment $k $SMALL -o still.ppm
        expect_same still.ppm f0$k.ppm
    done
    expect_differing 100 3000 f01.ppm f03.ppm
    # the range covers all frames
    range=$(awk -F, 'NR > 1 { for (k = 2; k <= 9; k++) { v = $k + 0
        if (NR == 2 && k == 2 || v < low) low = v; if (NR == 2 && k == 2 || v > high) high = v } }
        END { print low "," high }' pulse.csv)
    # shellcheck disable=SC2086
    run_ok corcast render --exact tree.swc --color-by pulse.csv:pulse_0.250 --range "$range" $SMALL -o still.ppm
    expect_same still.ppm f03.ppm
}

test_a_range_of_frames_keeps_their_numbers() {
    make_pulse
    # shellcheck disable=SC2086
    run_ok corcast render --exact tree.swc --color-by pulse.csv --moments 3..4 $SMALL -o f%d.png
    expect_only f3.png f4.png pulse.csv tree.swc
}

test_rows_of_a_time_give_the_pictures_of_columns() {
    make_pulse
    awk -F, 'NR == 1 { print "name,time,flow_in,flow_out"; n = split($0, time) }
        NR > 1 { for (k = n; k > 1; k--) print $1 "," time[k] "," $k ",0" }' pulse.csv >long.csv
    # shellcheck disable=SC2086
    run_ok corcast render --exact tree.swc --color-by pulse.csv --moment 6 $SMALL -o columns.ppm
    # shellcheck disable=SC2086
    run_ok corcast render --exact tree.swc --color-by long.csv:flow_in --moment 6 $SMALL -o rows.ppm
    expect_same columns.ppm rows.ppm
}

test_a_folder_of_svonedsolver_gives_the_pictures_of_columns() {
    make_pulse
    mkdir steps
    awk -F, 'NR > 1 { file = "steps/tree_segment" $1 "_flow.dat"; row = ""
        for (k = 2; k <= NF; k++) row = row " " $k
        print "1 2 3 4 5 6 7 8" >file; print row >file; close(file) }' pulse.csv
    # shellcheck disable=SC2086
    run_ok corcast render --exact tree.swc --color-by pulse.csv --moment 6 $SMALL -o columns.ppm
    # shellcheck disable=SC2086
    run_ok corcast render --exact tree.swc --color-by steps:flow --moment 6 $SMALL -o steps.ppm
    expect_same columns.ppm steps.ppm
    refused() {
        run corcast render tree.swc --quiet --color-by "$1" -o x.ppm
        expect_status 2
        expect_sentence "$2"
    }
    refused steps 'steps: name the quantity of the result folder: flow, pressure, area, wss or Re, as in steps:flow'
    refused steps:wss 'steps: the folder has no file \.\.\._wss\.dat'
    echo 1 2 3 >steps/tree_segment7_flow.dat
    refused steps:flow 'steps/tree_segment7_flow.dat:1: the file has 3 time steps, but there are 8 in tree_segment10_flow.dat'
    mv steps/tree_segment7_flow.dat steps/tree_aorta_flow.dat
    refused steps:flow "tree_aorta_flow.dat:1: the segment's name, 'tree_aorta', must end in the id"
}

# write_vtp COLUMN FILE: writes the tree as VTP, with the radius and the column of pulse.csv as
# point arrays.
write_vtp() {
    awk -v column="$1" '
        BEGIN { FS = ","; while ((getline <"pulse.csv") > 0) value[$1] = $column; FS = " " }
        /^#/ { next }
        { place[$1] = n++; points = points $3 " " $4 " " $5 "\n"; radius = radius $6 " "
          pressure = pressure ($1 in value ? value[$1] : "nan") " "
          if ($7 > 0) { lines = lines place[$7] " " n - 1 "\n"; offsets = offsets 2 * ++m " " } }
        function array(name, type, parts, text) {
            print "<DataArray type=\"" type "\" Name=\"" name "\" NumberOfComponents=\"" parts "\" format=\"ascii\">" text "</DataArray>"
        }
        END { print "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\"><PolyData>"
              print "<Piece NumberOfPoints=\"" n "\" NumberOfLines=\"" m "\"><PointData>"
              array("radius", "Float64", 1, radius); array("pressure", "Float64", 1, pressure)
              print "</PointData><Points>"; array("xyz", "Float64", 3, points); print "</Points><Lines>"
              array("connectivity", "Int64", 1, lines); array("offsets", "Int64", 1, offsets)
              print "</Lines></Piece></PolyData></VTKFile>" }' tree.swc >"$2"
}

test_an_index_of_vtp_files_is_a_series() {
    make_pulse
    for k in 2 3 4; do write_vtp $k m$k.vtp; done
    index() {
        echo '<VTKFile type="Collection" version="0.1"><Collection>'
        printf '<DataSet timestep="%s" part="0" file="%s"/>\n' "$@"
        echo '</Collection></VTKFile>'
    }
    index 0.1 m3.vtp 0 m2.vtp 0.2 m4.vtp >run.pvd
    cut -d , -f 1-4 pulse.csv >three.csv
    for k in 1 3; do
        # shellcheck disable=SC2086
        run_ok corcast render --exact run.pvd --color-by pressure --moment $k $SMALL -o index.ppm
        # shellcheck disable=SC2086
        run_ok corcast render --exact tree.swc --color-by three.csv --moment $k $SMALL -o columns.ppm
        expect_same index.ppm columns.ppm
    done
    run_ok corcast info run.pvd
    expect_stdout 'columns +pressure: 3 frames, 0 to 0.2$'
    refused() {
        index "$@" >bad.pvd
        run corcast info bad.pvd
        expect_status 2
        expect_sentence "$sentence"
    }
    sentence='bad.pvd:3: m2.vtp already has the timestep 0.5; each timestep must occur once' refused 0.5 m2.vtp 0.5 m3.vtp
    sentence='bad.pvd:2: no.vtp: ' refused 0.5 no.vtp
    sentence="bad.pvd:2: the timestep is 'x'" refused x m2.vtp
    sentence="bad.pvd:2: 'bad.pvd' is a PVD file; a PVD file can only refer to trees" refused 0 bad.pvd
    sed '/^31 /,$d' tree.swc >less.swc && mv less.swc tree.swc && write_vtp 2 less.vtp
    sentence='the tree in less.vtp differs from the tree in m2.vtp; all must have the same nodes' refused 0 m2.vtp 1 less.vtp
}

test_values_become_columns_of_a_converted_tree() {
    make_pulse
    run_ok corcast convert tree.swc pulse.csv.csv --values pulse.csv
    # shellcheck disable=SC2086
    run_ok corcast render --exact pulse.csv.csv --color-by pulse --moment 3 $SMALL -o converted.ppm
    # shellcheck disable=SC2086
    run_ok corcast render --exact tree.swc --color-by pulse.csv --moment 3 $SMALL -o joined.ppm
    expect_same converted.ppm joined.ppm
    run corcast convert tree.swc pulse.csv --values pulse.csv
    expect_status 2
    expect_sentence "would be written over --values 'pulse.csv'"
    run corcast convert tree.swc x.csv --values pulse.txt
    expect_status 2
    expect_sentence "--values: 'pulse.txt' is not a FILE.csv, FILE.csv:COLUMN or FOLDER:flow"
    expect_only converted.ppm joined.ppm pulse.csv pulse.csv.csv tree.swc
}

test_an_index_that_is_written_reads_back() {
    make_pulse
    run_ok corcast convert tree.swc run.pvd --values pulse.csv
    [ "$(echo run_*.vtp)" = "$(echo run_000{1..8}.vtp)" ] || fail "expected 8 moments, got $(echo run_*)"
    # shellcheck disable=SC2086
    run_ok corcast render --exact tree.swc --color-by pulse.csv --moment 6 $SMALL -o columns.ppm
    # shellcheck disable=SC2086
    run_ok corcast render --exact run.pvd --color-by pulse --moment 6 $SMALL -o index.ppm
    expect_same columns.ppm index.ppm
    run_ok corcast convert tree.swc wide.vtp --values pulse.csv
    # shellcheck disable=SC2086
    run_ok corcast render --exact wide.vtp --color-by pulse --moment 6 $SMALL -o wide.ppm
    expect_same columns.ppm wide.ppm
    run corcast convert tree.swc x.pvd
    expect_status 2
    expect_sentence 'tree.swc: the tree has no time series'
    awk -F, -v OFS=, 'NR == 1 { $2 = "a_1"; $3 = "a_2"; $4 = "b_1"; $5 = "b_3"; } { NF = 5; print }' pulse.csv >two.csv
    run corcast convert tree.swc x.pvd --values two.csv
    expect_status 2
    expect_sentence 'the series a and b have different times'
    run corcast convert run_0002.vtp run.pvd --values pulse.csv
    expect_status 2
    expect_sentence "'run_0002.vtp' would be written over the input 'run_0002.vtp'"
    ! ls x* >/dev/null 2>&1 || fail "expected no file for what is refused"
}

# expect_border_free FILE: the outermost pixels of a 60 x 50 PPM are white.
expect_border_free() {
    tail -c 9000 "$1" | od -An -v -tu1 -w180 | awk 'NR == 1 || NR == 50 { for (i = 1; i <= 180; i++) if ($i < 255) exit 1 }
        { for (i = 1; i <= 3; i++) if ($i < 255 || $(177 + i) < 255) exit 1 }' ||
        fail "expected $1 to show all of the tree"
}

test_a_turn_shows_the_whole_tree_from_all_sides() {
    make_pulse
    for projection in orthographic perspective; do
        # shellcheck disable=SC2086
        run_ok corcast render --exact tree.swc --background white --turntable 5 --projection $projection $SMALL -o t%d.ppm
        for k in 1 2 3 4 5; do
            expect_border_free t$k.ppm
        done
        expect_differing 300 3000 t1.ppm t3.ppm
    done
}

test_growth_ends_with_the_tree_and_adds_to_what_is_there() {
    make_pulse
    for model in rounded joined; do
        # shellcheck disable=SC2086
        run_ok corcast render --exact tree.swc --model $model --growth 4 --color-by strahler $SMALL --planes id \
            -o g%d.ppm
        # shellcheck disable=SC2086
        run_ok corcast render --exact tree.swc --model $model --color-by strahler $SMALL -o whole.ppm
        expect_same whole.ppm g4.ppm
        seen=0
        for k in 1 2 3 4; do
            now=$(tail -c 9000 g$k.id.ppm | od -An -v -tu1 -w3 | sort -u | wc -l)
            [ "$now" -gt "$seen" ] || fail "expected more vessels in picture $k than $seen, got $now"
            seen=$now
        done
    done
}

test_growth_keeps_colors_that_run_and_blend() {
    local options
    make_pulse
    for options in '--smooth' '--color-blend blended' '--smooth --color-blend blended'; do
        # shellcheck disable=SC2086
        run_ok corcast render tree.swc --model isosurface $options --growth 3 --color-by radius $SMALL -o g%d.ppm
        # shellcheck disable=SC2086
        run_ok corcast render tree.swc --model isosurface $options --color-by radius $SMALL -o whole.ppm
        expect_same whole.ppm g3.ppm
    done
}

test_ffmpeg_makes_a_film_of_them() {
    command -v ffmpeg >/dev/null || skip "ffmpeg is not installed"
    make_pulse
    # shellcheck disable=SC2086
    run_ok corcast render --exact tree.swc --color-by pulse.csv --moments all $SMALL -o f%04d.png
    run_ok ffmpeg -nostdin -loglevel error -framerate 24 -i f%04d.png -pix_fmt yuv420p pulse.mp4
    expect_file pulse.mp4
}

test_animations_that_cannot_be_are_refused() {
    make_pulse
    refused() {
        sentence=$1
        shift
        run corcast render tree.swc --size 60x50 --quiet "$@"
        expect_status 2
        expect_sentence "$sentence"
    }
    refused "'x.png' must contain the picture number" --turntable 3 -o x.png
    refused "'x%s.png' must contain the picture number" --turntable 3 -o x%s.png
    refused "'x%d%d.png' must contain the picture number" --turntable 3 -o x%d%d.png
    refused "'-' must contain the picture number" --turntable 3 -o -
    refused "exclude each other" --turntable 3 --growth 3 -o x%d.png
    refused "does not change with time" --moments all -o x%d.png
    refused "flow does not change with time" --color-by flow --moments all -o x%d.png
    refused "pulse has 8 time steps, not 9" --color-by pulse.csv --moments 2..9 -o x%d.png
    refused "--moment 9: pulse has 8 time steps" --color-by pulse.csv --moment 9 -o x.png
    refused "'4..3' is not valid; use all or A..B" --color-by pulse.csv --moments 4..3 -o x%d.png
    refused "pulse.csv:1: no column is called 'x'" --color-by pulse.csv:x -o x.png
    sed -i '4s/^[0-9]*/4711/' pulse.csv
    refused "pulse.csv:4: the tree has no segment with the id 4711" --color-by pulse.csv -o x.png
    printf 'id,a\n2,nan\n' >nothing.csv
    refused "the field a has no value" --color-by nothing.csv:a -o x.png
    refused "nothing.csv: is a folder|No such file|not exist|missing" --color-by no/nothing.csv -o x.png
    awk 'BEGIN { printf "id"; for (k = 0; k < 100000; k++) printf "," k; print "" }' >wide.csv
    refused "wide.csv:1: the file has more than 10000 columns" --color-by wide.csv -o x.png
    expect_only pulse.csv nothing.csv wide.csv tree.swc
}

test_flow_of_measured_trees_parts_as_is_asked_for() {
    run_ok corcast info "$DATA/coronary.swc" --q-perf 60 --p-perf 90 --viscosity 3.5 --flow-split murray
    expect_stdout 'terminals at'
    run corcast info "$DATA/coronary.swc" --flow-split half
    expect_status 2
    expect_sentence "--flow-split: 'half' is not equal, murray or a FILE.csv"
    run corcast info "$DATA/coronary.swc" --flow-exponent 2.5
    expect_status 2
    expect_sentence '--flow-exponent is for --flow-split murray'
    run corcast render "$DATA/coronary.swc" --flow-split murray --color-by flow -o x.png
    expect_status 2
    expect_sentence 'coronary.swc: the field flow needs the flow through the inlet'
    printf 'id,flow\n4711,3\n' >flows.csv
    run corcast info "$DATA/coronary.swc" --flow-split flows.csv
    expect_status 2
    expect_sentence 'flows.csv:2: the tree has no segment with the id 4711'
}

run_tests "$@"
