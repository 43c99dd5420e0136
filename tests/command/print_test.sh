#!/usr/bin/env bash
# `export --print`: solids for printers, proved by corcast and checked by independent programs.
. "$(dirname "$0")/../lib.sh"

# grown TERMINALS: grows a tree, t.swc.
grown() {
    run_ok corcast grow --terminals "$1" --domain ball:41 --seed 7 -o t.swc --quiet
}

# expect_solid FILE PARTS: admesh repairs nothing, and finds PARTS parts and the volume in the
# manifest.
expect_solid() {
    admesh "$1" >said 2>&1 || fail "admesh fails: $(tail -1 said)"
    for fault in 'Total disconnected facets' 'Degenerate facets' 'Edges fixed' 'Backwards edges' 'Facets reversed' \
        'Facets removed' 'Facets added' 'Normals fixed'; do
        grep -qE "$fault *: +0( |$)" said || fail "admesh finds: $(grep "$fault" said)"
    done
    grep -qE "Number of parts +: +$2 " said || fail "admesh finds: $(grep 'Number of parts' said)"
    awk -v a="$(jq .volume_mm3 "$1.json")" -v b="$(sed -n 's/.*Volume *: *//p' said)" \
        'BEGIN { exit !(a > 10 && (a / b - 1) ^ 2 < 1e-4 ^ 2) }' || fail "admesh measures $(grep Volume said)"
}

test_a_wall_is_one_closed_solid_with_a_hole_for_each_end() {
    run_ok corcast export "$DATA/bifurcation.swc" --print wall=0.617 -o m.stl --quiet
    expect_solid m.stl 1
    expect_json m.stl.json '.components == 1 and .genus == 2 and .euler == -2 and .self_intersections == 0'
    expect_json m.stl.json '.print | .openings == 3 and .rings == 3 and .closed_ends == []'
    grown 23
    run_ok corcast export t.swc --print wall=0.3r --mesh-tolerance 0.07 -o t.stl --quiet
    expect_solid t.stl 1
    expect_json t.stl.json '.genus == 23 and .print.openings == 24'
}

# volume FILE: prints the volume of the solid in its manifest, mm^3.
volume() {
    jq .volume_mm3 "$1.json"
}

# The wall of a single vessel is a tube of known volume. The wall of a tree is the space between two
# surfaces, each of which `export` makes of a tree with adjusted radii.
test_a_wall_has_the_volume_between_its_sides() {
    printf '%s\n' '1 3 0.4 0 0 1.3 -1' '2 3 9.7 3.1 -5.3 1.3 1' >t.swc
    run_ok corcast export t.swc --print wall=0.617 --mesh-tolerance 0.005 -o t.stl --quiet
    awk -v v="$(jq .volume_mm3 t.stl.json)" 'BEGIN { pi = atan2(0, -1)
        length_mm = sqrt(9.3 ^ 2 + 3.1 ^ 2 + 5.3 ^ 2); exit !((v / (pi * (1.917 ^ 2 - 1.3 ^ 2) * length_mm) - 1) ^ 2 < 0.005 ^ 2) }' ||
        fail "a tube of $(jq .volume_mm3 t.stl.json) mm^3"
    awk '/^#/ { print; next } { $6 += 0.617; print }' "$DATA/bifurcation.swc" >thick.swc
    run_ok corcast export "$DATA/bifurcation.swc" --print wall=0.617 -o wall.stl --quiet
    run_ok corcast export thick.swc -o thick.stl --quiet
    run_ok corcast export "$DATA/bifurcation.swc" -o lumen.stl --quiet
    awk -v wall="$(jq .volume_mm3 wall.stl.json)" -v a="$(jq .volume_mm3 thick.stl.json)" -v b="$(jq .volume_mm3 lumen.stl.json)" \
        'BEGIN { exit !(wall > 100 && (wall / (a - b) - 1) ^ 2 < 1e-5 ^ 2) }' || fail "the wall is not the difference"
}

test_refuses_walls_that_meet_or_parts_them() {
    cp "$REPO/tests/golden/strangers.swc" t.swc
    run corcast export t.swc --print wall=0.31 -o m.stl --quiet
    expect_status 2
    expect_sentence 'with their walls, the vessels of segments 5 and 6 are unconnected, but overlap by 1\.15'
    expect_only t.swc
    run_ok corcast export t.swc --print wall=0.31 --part-overlaps -o m.stl --quiet
    expect_solid m.stl "$(jq .trees m.stl.json)"
    expect_json m.stl.json '.segments_thinned | index(5) != null and index(6) != null'
}

test_thin_vessels_are_thickened_or_pruned_and_counted() {
    grown 23
    run_ok corcast export t.swc --print scale=2,min-diameter=1.9 -o m.stl --mesh-tolerance 0.1
    expect_json m.stl.json '.print.segments_thickened == 23 and .print.thinnest_diameter_mm == 1.9 and .segments == 45'
    grep -q '23 segments are thickened to 1.9 mm' stderr || fail "it does not say so: $(cat stderr)"
    run_ok corcast export t.swc --print scale=2,min-diameter=1.9,thin=prune -o p.stl --mesh-tolerance 0.1
    grep -q '^corcast: 23 thin segments are pruned$' stderr || fail "expected the pruned to be counted$(said)"
    expect_json p.stl.json '.print.segments_pruned == 23 and .print.segments_thickened == 0 and .segments == 22'
    expect_json p.stl.json '.print.thinnest_diameter_mm > 1.9'
}

test_scales_the_whole_model() {
    run_ok corcast export "$DATA/bifurcation.swc" -o one.stl --quiet
    run_ok corcast export "$DATA/bifurcation.swc" --print scale=2.5 -o m.stl --quiet
    awk -v a="$(jq .volume_mm3 one.stl.json)" -v b="$(jq .volume_mm3 m.stl.json)" \
        'BEGIN { exit !((b / a / 2.5 ^ 3 - 1) ^ 2 < 1e-5 ^ 2) }' || fail "another volume than 2.5^3 as much"
}

# refuses: reads lines KEYS|PATTERN from standard input. --print refuses the keys with a sentence
# that matches the pattern, and writes nothing.
refuses() {
    local print said
    while IFS='|' read -r print said; do
        run corcast export "$DATA/bifurcation.swc" --print "$print" -o m.stl --quiet
        expect_status 2
        expect_sentence "$said"
        expect_only
    done
}

test_refuses_what_the_printer_cannot_make() {
    refuses <<'END'
nozzle=7.3|the nozzle \(7.3 mm\) is wider than the trunk \([0-9.]* mm when printed\)
scale=0.01,nozzle=0.4|the nozzle \(0.4 mm\) is wider than the trunk \(0.0[0-9]* mm
nozzle=0.4,wall=0.3|the nozzle \(0.4 mm\) is wider than the thinnest wall \(0.3 mm\)
bed=30x31x200|the print \([0-9.]* x [0-9.]* x [0-9.]* mm\) does not fit the bed \(30 x 31 x 200 mm\)
END
    run_ok corcast export "$DATA/bifurcation.swc" --print bed=33x23x6 -o m.stl --quiet
}

# The print measures 21.306 x 32.330 x 4.763 mm. It may be rotated about z only.
test_a_print_fits_its_bed_to_a_hundredth_either_way_round() {
    local bed
    run_ok corcast export "$DATA/bifurcation.swc" --print bed=99x99x99 --mesh-tolerance 0.02 -o m.stl --quiet
    expect_json m.stl.json '.print.size_mm | .[0] > 21.30 and .[0] < 21.31 and .[1] > 32.32 and .[1] < 32.34 and .[2] > 4.76 and .[2] < 4.77'
    for bed in 21.31x32.34x4.77 32.34x21.31x4.77 21.31x99x4.77 99x21.31x4.77 32.34x99x4.77; do
        run_ok corcast export "$DATA/bifurcation.swc" --print bed=$bed -o m.stl --quiet
    done
    for bed in 21.30x32.34x4.77 21.31x32.32x4.77 32.34x21.30x4.77 32.32x21.31x4.77 21.31x32.34x4.76 \
        32.34x21.31x4.76 99x21.30x4.77 21.30x99x4.77 32.32x32.32x4.77 99x4.77x99 99x99x4.76; do
        run corcast export "$DATA/bifurcation.swc" --print bed=$bed -o m.stl --quiet
        expect_status 2
        expect_sentence "does not fit the bed \([0-9.]* x [0-9.]* x [0-9.]* mm\)"
    done
}

test_refuses_what_is_no_key_or_value() {
    refuses <<'END'
walls=2|--print: unknown key 'walls'; the keys are scale, .*; did you mean wall
wall=thick|--print: 'wall=thick' is not valid; the key wall takes a thickness in mm, or over the radius, as 0.2r
scale=-1|--print: 'scale=-1' is not valid; the key scale takes a factor above 0
bed=2x3|--print: 'bed=2x3' is not valid; the key bed takes three lengths in mm
thin=prune|--print: thin=prune needs the key min-diameter
END
    run corcast export "$DATA/bifurcation.swc" --print wall=1 --model rounded -o m.stl
    expect_sentence '--print: walls, blocks and bases need flat vessel ends'
    run corcast export "$DATA/bifurcation.swc" --print wall=1 -o m.inc
    expect_sentence '--print needs an output that stores solids'
}

test_a_block_is_a_box_less_its_vessels() {
    run_ok corcast export "$DATA/bifurcation.swc" --print block=box:40x43x30 -o m.stl --quiet
    run_ok corcast export "$DATA/bifurcation.swc" -o lumen.stl --quiet
    expect_json m.stl.json '.components == 2 and .genus == 0 and .print.closed_cavities == 1 and .print.openings == 0'
    awk -v a="$(volume m.stl)" -v b="$(volume lumen.stl)" 'BEGIN { exit !((a / (40 * 43 * 30 - b) - 1) ^ 2 < 1e-5 ^ 2) }' ||
        fail "a block of $(volume m.stl) mm^3"
    run_ok corcast export "$DATA/bifurcation.swc" --print block=cylinder:48x44 -o m.stl --quiet
    awk -v a="$(volume m.stl)" -v b="$(volume lumen.stl)" 'BEGIN { pi = atan2(0, -1)
        exit !((a / (pi * 24 ^ 2 * 44 - b) - 1) ^ 2 < 0.001 ^ 2) }' || fail "a cylinder of $(volume m.stl) mm^3"
}

test_ports_lead_vessels_out_of_a_block() {
    local block
    for block in box cylinder,margin=9; do
        run_ok corcast export "$DATA/bifurcation.swc" --print "block=$block,ports" -o m.stl --quiet
        expect_solid m.stl 1
    done
    run_ok corcast export "$DATA/bifurcation.swc" --print block=box,ports -o m.stl --quiet
    expect_json m.stl.json '.genus == 2 and .euler == -2 and (.print | .openings == 3 and .rings == 3 and .closed_ends == [])'
    run_ok corcast export "$DATA/bifurcation.swc" --print block=box,ports=inlet -o m.stl --quiet
    expect_json m.stl.json '.genus == 0 and .print.openings == 1 and .print.closed_ends == [3, 4]'
    grown 40
    run_ok corcast export t.swc --print block=box,ports --mesh-tolerance 0.07 -o t.stl --quiet
    expect_solid t.stl 1
    expect_json t.stl.json '.genus == .print.openings - 1 and .print.openings > 36'
    expect_json t.stl.json '.print.openings + (.print.closed_ends | length) == 41'
}

# The port of an upright vessel meets the upper face at a right angle. Its circle has 4.3 mm there,
# and 0.45 mm less at the bottom of the fitting, 7.5 mm below.
test_a_luer_port_has_the_size_of_the_fitting() {
    printf '%s\n' '1 3 0 0 0 0.83 -1' '2 3 0 0 -17.3 0.83 1' >t.swc
    run_ok corcast export t.swc --print block=box,ports=inlet:luer -o t.obj --quiet
    awk '$1 == "v" { r = sqrt($2 ^ 2 + $3 ^ 2)
            if (($4 - 15.83) ^ 2 < 1e-8 && r < 3) { top += (r - 2.15) ^ 2 > 1e-8; n_top++ }
            if (($4 - 8.33) ^ 2 < 1e-8 && r < 3) { low += (r - 1.925) ^ 2 > 1e-8; n_low++ } }
        END { exit !(n_top > 20 && n_top == n_low && top + low == 0) }' t.obj || fail "no fitting of that size"
}

test_refuses_blocks_that_hold_no_vessels() {
    refuses <<'END'
block=box:20x40x30|the block of 20 x 40 x 30 mm is smaller than the vessels with a margin of 3 mm, 27.97 x 41.16 x 10.77 mm
block=cylinder:28x41|is smaller than the vessels with a margin of 3 mm
block=box,margin=0.01,ports=luer|no port is possible: no vessel end has a clear path to a face of the block
block=box,base|the key base excludes the key block
block=box,wall=1|the key wall excludes the key block
ports|the keys ports and margin need the key block
block=ball|'block=ball' is not valid; the key block takes box or cylinder, with sizes
ports=7|'ports=7' is not valid; the key ports takes all or inlet, luer or a taper from 0 to 1
END
}

test_a_base_holds_vessels_by_pins() {
    run_ok corcast export "$DATA/coronary.swc" --print base=1.7,min-diameter=1.3 -o m.stl --quiet
    expect_solid m.stl 1
    expect_json m.stl.json '.print.pins > 4 and .genus == .print.pins - 1 and .print.rings == .print.pins'
    run_ok corcast export "$DATA/bifurcation.swc" --print base,wall=0.6 -o m.stl --quiet
    expect_solid m.stl 1
    expect_json m.stl.json '.print.openings == 3 and .genus == 2 + .print.pins - 1 and .segments == 3'
}

# Two ends point down, at different heights. A third end points up, and the trunk leads down to its
# bifurcation.
test_pins_leave_the_places_that_nothing_leads_down_from_and_no_others() {
    printf '%s\n' '1 3 0 0 20 1 -1' '2 3 0 0 10 1 1' '3 3 10 0 5 .8 2' '4 3 -10 0 8 .8 2' '5 3 0 12 15 .8 2' >t.swc
    run_ok corcast export t.swc --print base --mesh-tolerance 0.1 -o m.stl --quiet
    expect_json m.stl.json '.print.pins == 2 and .print.hanging == 0'
    # The same tree upside down: only the trunk needs a pin.
    awk '{ print $1, $2, $3, $4, -$5, $6, $7 }' t.swc >u.swc
    run_ok corcast export u.swc --print base --mesh-tolerance 0.1 -o m.stl --quiet
    expect_json m.stl.json '.print.pins == 2 and .print.hanging == 0'
}

# The tree is flat, so every node needs a pin, and many nodes are close to others.
test_a_flat_tree_stands_on_the_pins_that_have_room() {
    run_ok corcast grow --terminals 60 --seed 3 -o t.swc --quiet
    run_ok corcast export t.swc --print base,wall=0.2r --mesh-tolerance 0.1 -o t.stl --quiet
    expect_solid t.stl 1
    expect_json t.stl.json '.print | .pins > 80 and .hanging > 0 and .openings + (.closed_ends | length) == 61'
}

test_says_how_near_strangers_come() {
    printf '%s\n' '1 3 0 0 0 1.1 -1' '2 3 9 0 0 1.1 1' '3 3 4 -5 3.37 0.6 -1' '4 3 4 7 3.37 0.6 3' >t.swc
    run_ok corcast export t.swc --print scale=2 -o m.stl --quiet
    expect_json m.stl.json '.print | .least_gap_mm > 3.3399 and .least_gap_mm < 3.3401 and .least_gap_between == [2, 4]'
    run_ok corcast export t.swc --print wall=0.4 -o m.stl --quiet
    expect_json m.stl.json '.print | .least_gap_mm > 0.8699 and .least_gap_mm < 0.8701 and .smallest_feature_mm == 0.4'
}

test_a_wall_has_the_same_bytes_for_any_number_of_threads() {
    grown 9
    run_ok corcast export t.swc --print wall=0.4 --mesh-tolerance 0.1 -o one.ply --threads 1 --quiet
    run_ok corcast export t.swc --print wall=0.4 --mesh-tolerance 0.1 -o three.ply --threads 3 --quiet
    expect_same one.ply three.ply
    expect_same one.ply.json three.ply.json
}

test_every_key_is_in_the_help_and_on_the_page() {
    local key
    run corcast export "$DATA/bifurcation.swc" --print none -o m.stl
    for key in $(sed 's/.*the keys are //; s/,//g' stderr); do
        run_ok corcast export --help
        expect_stdout "[ ,]$key[=, ;]"
        grep -qE "\`$key[=\`]" "$REPO/docs/MAKERS.md" || fail "docs/MAKERS.md does not have the key $key"
    done
    [ "$key" = bed ] || fail "expected the keys in the sentence: $(cat stderr)"
}

# The commands of the page, with smaller pictures.
# Slow: OpenSCAD cuts the block.
test_the_commands_of_the_page_run() {
    local line
    command -v xvfb-run >/dev/null && command -v openscad >/dev/null || skip "xvfb-run or openscad is not installed"
    ln -s "$REPO/tests" .
    while read -r line; do
        run_ok timeout 300 bash -c "$(sed "s|build/corcast|'$CORCAST'|; s/imgsize [0-9,]*/imgsize 120,90/; s/ *#.*//" <<<"$line")"
    done < <(sed -n ':a; /\\$/{N; s/\\\n *//; ba}; s/^    \(build\/corcast\|xvfb-run\)/\1/p' "$REPO/docs/MAKERS.md")
    for picture in print block; do
        [ "$(pngtopnm $picture.png | ppmhist -noheader | wc -l)" -gt 20 ] || fail "expected a model in $picture.png"
    done
}

run_tests "$@"
