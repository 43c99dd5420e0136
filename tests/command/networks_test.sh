#!/usr/bin/env bash
# Networks with loops: reading, files, numbers, and what every command does with them.
. "$(dirname "$0")/../lib.sh"

# A ring of two vessels, 2 -> 3 -> 5 and 2 -> 4 -> 5, with an inlet and an outlet; the lower one is
# thicker. A third, straight vessel joins 2 and 5.
ring() {
    cat >ring.csv <<'END'
x0_mm,y0_mm,z0_mm,x1_mm,y1_mm,z1_mm,radius_mm,age
-4,0,0,0,0,0,0.5,1
0,0,0,3,4,0,0.25,2
3,4,0,6,0,0,0.25,3
0,0,0,3,-4,0,0.375,4
3,-4,0,6,0,0,0.375,5
0,0,0,6,0,0,0.125,6
6,0,0,11,0,0,0.5,7
END
}

# body FILE: the rows of a CSV.
body() {
    grep -v '^#' "$1"
}

test_loops_are_kept_and_counted() {
    ring
    run_ok corcast info ring.csv --json
    expect_json stdout '.segments == 7 and .loops == 2 and .components == 1 and .terminals == 1 and
        .bifurcations == 2 and .reading.degrees[0:5] == [0, 2, 2, 0, 2] and .max_level == 2 and
        .max_strahler == null and (.total_length_mm - 35 | fabs) < 1e-12'
    run_ok corcast info ring.csv
    expect_stdout '^  loops         2; maximum bifurcation level 2; loops have no Strahler orders$'
    expect_stdout '^  components    1$'
    run_ok corcast info ring.csv --json --break-loops
    expect_json stdout '.segments == 5 and .loops == 0 and .reading.network.loops == 2 and
        (.reading.network.cuts | map(.radius_mm) | sort) == [0.125, 0.25]'
}

# Loops = segments - points + components, counted from the coordinates of both ends.
test_loops_agree_with_a_count_by_coordinates() {
    local file=$SHARED/microvesselchaste/retinal.vtp
    [ -r "$file" ] || skip "$file is not here"
    run_ok corcast info "$file" --radius-array Distance --json
    expect_json stdout '.segments == 7683 and .loops == 203 and .components == 8'
    run_ok corcast convert --quiet "$file" --radius-array Distance net.segments.csv
    [ "$(body net.segments.csv | awk -F, 'function find(i) { while (set[i] != i) i = set[i]; return i }
        NR > 1 { a = $3 "," $4 "," $5; b = $6 "," $7 "," $8
                 if (!(a in set)) { set[a] = a; points++; sets++ }
                 if (!(b in set)) { set[b] = b; points++; sets++ }
                 a = find(a); b = find(b); if (a != b) { set[a] = b; sets-- } }
        END { print NR - 1 - points + sets, sets }')" = "203 8" ] || fail "expected 203 loops and 8 components"
}

test_networks_read_back_equal() {
    local file
    ring
    run_ok corcast convert --quiet ring.csv a.csv --fields level,tree
    [ "$(body a.csv | cut -d, -f 1,2,8)" = "$(printf '%s\n' id,parent,same_as 1,-1, 2,1, 3,2, 4,3, \
        5,2, 6,4, 7,5,4 8,2,4)" ] || fail "found $(body a.csv)"
    for file in b.vtp b.vtk b.csv b.graphml b.gxl b.segments.csv; do
        run_ok corcast convert --quiet a.csv "$file"
        run_ok corcast convert --quiet "$file" back.csv
        [ "$(body back.csv)" = "$(body a.csv)" ] || fail "$file: $(body back.csv)"
    done
    run_ok corcast convert a.csv b.vmv
    grep -q 'the radii of segments that close loops' stderr || fail "expected a sentence about radii"
    run_ok corcast info b.vmv --json # two middles more
    expect_json stdout '.loops == 2 and .segments == 9 and (.total_length_mm - 35 | fabs) < 1e-12'
    run_ok corcast info a.csv --input-unit cm --json
    expect_json stdout '.loops == 2 and .total_length_mm == 350'
    run_ok corcast info b.segments.csv --input-unit cm --json
    expect_json stdout '.loops == 2 and .total_length_mm == 350'
    for file in b.vtp b.csv b.graphml b.segments.csv; do
        run_ok corcast info "$file" --break-loops --json
        expect_json stdout '.loops == 0 and .segments == 5 and .total_length_mm == 24'
    done
    for file in c.swc c.in; do
        run corcast convert --quiet a.csv "$file"
        expect_status 2
        expect_sentence "$file: the network has loops, which .* cannot store; --break-loops cuts"
        [ ! -e "$file" ] || fail "expected no file $file"
    done
}

test_bad_links_are_refused() {
    local row sentence
    ring
    run_ok corcast convert --quiet ring.csv a.csv
    while IFS=: read -r row sentence; do
        sed "s/^7,5,.*/$row/" a.csv >bad.csv
        run corcast info bad.csv
        expect_status 2
        expect_sentence "$sentence"
    done <<'END'
7,5,6,0,0,0.375,3,99,5:bad.csv:[0-9]*: a link names the node 99, which is not the id of a node
7,5,6,0,0,0.375,3,8,5:bad.csv: node 8: a node with a link cannot have children or be named by a link
7,5,6,0,0,0.375,3,7,5:bad.csv: node 7: its link does not name another node
7,5,6,0,0,0.375,3,x,5:bad.csv:[0-9]*: the same_as is 'x'
END
}

# 2 -> 3 -> 4 -> 5 -> 6 -> 10 with twigs at 3, 4 and 5; 11, a daughter of 2, is the point 6.
test_levels_take_the_shortest_path_through_loops() {
    printf '%s\n' id,parent,x_mm,y_mm,z_mm,radius_mm,same_as 1,-1,0,0,0,1, 2,1,1,0,0,1, 3,2,2,1,0,1, \
        4,3,3,1,0,1, 5,4,4,1,0,1, 6,5,5,0,0,1, 7,3,2,2,0,1, 8,4,3,2,0,1, 9,5,4,2,0,1, 10,6,6,0,0,1, \
        11,2,5,0,0,1,6 >net.csv
    run_ok corcast convert --quiet net.csv a.csv --fields level
    [ "$(body a.csv | awk -F, 'NR > 2 { printf "%s ", $NF }')" = "0 1 2 3 2 2 3 3 2 1 " ] ||
        fail "found $(body a.csv)"
}

test_statistics_of_networks_are_of_vessels_between_junctions() {
    ring
    run_ok corcast info ring.csv --stats -o stats.csv
    value() { awk -F, -v key="$1,$2,$3" '$1 "," $2 "," $3 == key { print $4 }' stats.csv; }
    [ "$(value tree '' vessels),$(value tree '' loops),$(value degree 4 nodes)" = 5,2,2 ] ||
        fail "found $(cat stats.csv)"
    [ "$(value vessel 2 length_mm),$(value vessel 2 straightness)" = 10,0.6 ] || fail "found $(cat stats.csv)"
    [ "$(value vessel 2 start_id),$(value vessel 2 end_id),$(value vessel 3 end_id)" = 2,6,6 ] ||
        fail "found $(cat stats.csv)"
    [ "$(grep -c '^branch-point,.*,x_mm,' stats.csv),$(grep -c '^end,.*,x_mm,' stats.csv)" = 2,2 ] ||
        fail "found $(cat stats.csv)"
    run_ok corcast info ring.csv --stats --json
    expect_json stdout '.stats | .vessels == 5 and .by_strahler == [] and .strahler_ratios.number == null and
        .symmetry == null and .branch_points == 2'
}

# A closed vessel is not resampled into a point, nor one of two parallel vessels into the other.
test_centrelines_of_networks_keep_their_loops() {
    ring
    run_ok corcast convert --quiet ring.csv a.csv --step 100
    run_ok corcast info a.csv --json
    expect_json stdout '.loops == 2'
    run_ok corcast convert --quiet ring.csv b.csv --step 0.5 --smooth
    run_ok corcast info b.csv --json
    expect_json stdout '.loops == 2 and .segments == 70 and (.total_length_mm - 35 | fabs) < 0.5'
}

test_what_needs_a_tree_refuses_loops() {
    local command
    ring
    run_ok corcast convert --quiet ring.csv a.csv
    while read -r command; do
        run corcast $command
        expect_status 2
        expect_sentence 'loops.* --break-loops cuts each loop at its thinnest segment'
    done <<'END'
certify a.csv
refine a.csv -o out.swc
grow --from a.csv --terminals 20 -o out.swc
pulse a.csv -o out.csv
info a.csv --json --bound
info a.csv --morphometry kassab-lad
convert a.csv out.csv --fields strahler
convert a.csv out.csv --fields diameter-strahler
convert a.csv out.swc
render a.csv -o out.png --prune-radius 0.2
render a.csv -o out.png --color-by strahler
export a.csv -o out.nii --labels strahler
END
    expect_only ring.csv a.csv
}

test_a_ring_without_outlets_has_no_territories_of_terminals() {
    printf '%s\n' x0,y0,z0,x1,y1,z1,radius 0,0,0,9,0,0,0.5 9,0,0,9,9,0,0.5 9,9,0,0,0,0,0.5 >ring.csv
    run_ok corcast info ring.csv --json
    expect_json stdout '.loops == 1 and .terminals == 0 and .reading.degrees[2] == 3 and .max_level == 1'
    run corcast coverage ring.csv --domain hull:1 --territories out.nii --quiet
    expect_status 2
    expect_sentence '--territories: no vessel ends at a terminal, .* use --territory segment or tree'
    run_ok corcast coverage ring.csv --domain hull:1 --territories out.nii --territory tree --quiet
}

# A flow that is stated for the last node of a closing line leaves where the line ends.
test_flows_of_nodes_with_links_leave_at_their_places() {
    ring
    run_ok corcast convert --quiet ring.csv a.csv
    printf 'id,flow\n6,2\n7,1\n' >flows.csv
    run_ok corcast convert a.csv b.csv --flow-split flows.csv --p-perf 90 --viscosity 3 --fields flow --quiet
    # All of 3 ml/min enters by segment 2, and 2 ml/min leave by segment 6.
    [ "$(body b.csv | awk -F, '$1 == 2 || $1 == 6 { printf "%.9g ", $NF }')" = "3 2 " ] || fail "found $(body b.csv)"
}

test_what_draws_and_exports_takes_loops() {
    local model file
    ring
    run_ok corcast convert --quiet ring.csv a.csv
    corcast models | cut -f 1 >models
    while read -r model; do
        run_ok corcast render a.csv --model "$model" --size 40x30 -o out.ppm
    done <models
    run_ok corcast render a.csv --color-by flow --q-perf 1 --p-perf 90 --viscosity 3.5 --size 40x30 -o out.ppm
    run_ok corcast render a.csv --growth 3 --size 40x30 -o out%d.ppm
    run_ok corcast coverage a.csv --domain hull:1 --territories out.nii.gz
    for file in out.ply out.3mf out.html out.nii out.py out.usda; do
        run_ok corcast export a.csv -o "$file" --quiet
        expect_file "$file"
    done
    run_ok corcast export a.csv --parts -o out.vtp --quiet
    run_ok corcast info out.centreline.vtp --json
    expect_json stdout '.loops == 2 and .segments == 7'
    run_ok corcast scene a.csv -o out.pov
    run_ok corcast info a.csv --stats
}

run_tests "$@"
