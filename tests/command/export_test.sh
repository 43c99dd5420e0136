#!/usr/bin/env bash
# `export`: closed meshes, proved and looked at by programs that are not ours.
. "$(dirname "$0")/../lib.sh"

# admesh_says FILE LABEL: the number that admesh prints for it.
admesh_says() {
    admesh "$1" 2>&1 | grep -F "$2" | sed 's/.*: *//; s/ .*//'
}

test_bifurcation_is_one_closed_mesh_for_admesh() {
    run_ok corcast export "$DATA/bifurcation.swc" -o m.stl --quiet
    admesh m.stl >said 2>&1 || fail "admesh fails: $(tail -1 said)"
    for fault in 'Total disconnected facets' 'Degenerate facets' 'Edges fixed' 'Backwards edges' 'Facets reversed'; do
        grep -qE "$fault *: +0( |$)" said || fail "admesh finds: $(grep "$fault" said)"
    done
    grep -qE 'Number of parts +: +1 ' said || fail "admesh finds: $(grep 'Number of parts' said)"
}

test_manifest_proves_the_mesh() {
    run_ok corcast export "$DATA/bifurcation.swc" -o m.stl --quiet
    expect_json m.stl.json '.components == 1 and .genus == 0 and .euler == 2 and .watertight'
    expect_json m.stl.json '.self_intersections == 0 and .bridges == 0'
    expect_json m.stl.json '.max_distance_over_radius > 0.003 and .max_distance_over_radius < 0.05'
    expect_json m.stl.json '.segments_present == 3 and .segments_missing == []'
}

test_same_bytes_for_any_number_of_threads() {
    corcast grow --terminals 23 --domain ball:41 --seed 7 -o t.swc --quiet
    run_ok corcast export t.swc -o one.ply --threads 1 --quiet
    run_ok corcast export t.swc -o three.ply --threads 3 --quiet
    expect_same one.ply three.ply
    expect_same one.ply.json three.ply.json
}

test_openscad_takes_it_through_cgal_with_the_same_volume() {
    corcast grow --terminals 5 --seed 5 --domain ball:30 -o t.swc --quiet
    run_ok corcast export t.swc -o m.stl --quiet
    echo 'difference() { import("m.stl"); translate([0, 0, -500]) cube(1); }' >cut.scad
    openscad -o cut.stl cut.scad >said 2>&1 || fail "openscad fails: $(tail -1 said)"
    grep -q 'Simple: *yes' said || fail "CGAL finds no solid: $(cat said)"
    ours=$(jq .volume_mm3 m.stl.json) theirs=$(admesh_says cut.stl Volume)
    awk -v a="$ours" -v b="$theirs" 'BEGIN { exit !(a > 100 && (a / b - 1) ^ 2 < 0.005 ^ 2) }' ||
        fail "volume $ours mm^3, OpenSCAD's $theirs"
}

test_refuses_vessels_that_overlap_by_name() {
    run corcast export "$REPO/tests/golden/strangers.swc" -o m.stl --quiet
    expect_status 2
    expect_sentence 'segments 5 and 6, which do not belong together, overlap by 0\.534 mm'
    expect_only
}

test_part_overlaps_thins_them_and_says_so() {
    run_ok corcast export "$REPO/tests/golden/strangers.swc" --part-overlaps -o m.stl
    grep -q 'segments are thinned' stderr || fail "it does not say so: $(cat stderr)"
    expect_json m.stl.json '.components == .trees and .self_intersections == 0'
    expect_json m.stl.json '.segments_thinned | index(5) != null and index(6) != null'
    expect_json m.stl.json '[.near_pairs[].gap_mm] | min > 0'
}

test_refuses_an_unknown_extension() {
    run corcast export "$DATA/bifurcation.swc" -o m.xyz
    expect_status 2
    expect_sentence "'m.xyz' does not end in .scad, .stl or .ply"
}

run_tests
