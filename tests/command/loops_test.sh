#!/usr/bin/env bash
# Networks with loops are drawn, filled and meshed whole. An independent program counts the topology of the meshes.
. "$(dirname "$0")/../lib.sh"

# ring SEGMENTS RADIUS_MM FIRST ARMS: ring.vtk, a ring of radius 6 mm in a plane. Its points and lines are listed from
# point FIRST on. ARMS vessels lead away from it.
ring() {
    awk -v n="$1" -v radius="$2" -v first="$3" -v arms="$4" 'BEGIN {
        step = 8 * atan2(1, 1) / n
        print "# vtk DataFile Version 3.0\nring\nASCII\nDATASET POLYDATA\nPOINTS " n + arms " double"
        for (i = 0; i < n; i++) printf "%.9g %.9g 0\n", 6 * cos(step * (i + first)), 6 * sin(step * (i + first))
        for (i = 0; i < arms; i++) printf "%.9g %.9g %d\n", 12 * cos(step * i), 12 * sin(step * i), 3 * i
        print "LINES " n + arms, 3 * (n + arms)
        for (i = 0; i < n; i++) print 2, i, (i + 1) % n
        for (i = 0; i < arms; i++) print 2, (i - first + n) % n, n + i
        print "CELL_DATA " n + arms "\nSCALARS radius double 1\nLOOKUP_TABLE default"
        for (i = 0; i < n + arms; i++) print radius }' >ring.vtk
}

# expect_topology FILE PARTS LOOPS: what the independent program counts, and what the manifest states.
expect_topology() {
    run_ok python3 "$REPO/tests/oracle/stl_topology.py" "$1"
    expect_stdout "^$2 $3 "
    expect_json "$1.json" ".components == $2 and .genus == $3 and .watertight and .self_intersections == 0"
}

test_a_ring_has_genus_one() {
    while read -r segments radius; do
        ring "$segments" "$radius" 0 0
        run_ok corcast export ring.vtk --mesh-tolerance 0.1 -o m.stl --quiet
        expect_topology m.stl 1 1
    done <<<$'12 0.5\n12 1.7\n6 1.4\n4 1.9'
    run_ok corcast export ring.vtk --mesh-tolerance 0.1 --break-loops -o m.stl --quiet
    expect_topology m.stl 1 0
    ring 12 0.8 0 2
    run_ok corcast export ring.vtk --model rounded --mesh-tolerance 0.1 -o m.stl --quiet
    expect_topology m.stl 1 1
    run_ok corcast export ring.vtk --smooth --mesh-tolerance 0.1 -o m.stl --quiet
    expect_topology m.stl 1 1
}

test_measured_networks_have_the_genus_of_their_graphs() {
    [ -d "$SHARED" ] || skip "$SHARED is missing"
    run_ok corcast export "$SHARED/secomb/Brain.network.dat" --mesh-tolerance 0.2 -o m.stl --quiet
    expect_topology m.stl 2 3
    run_ok corcast export "$SHARED/secomb/Tumor1998.network.dat" --mesh-tolerance 0.2 -o m.stl --quiet
    expect_topology m.stl 2 14
}

# A wall has the loop twice, and a hole more than one for its two openings. A block has the loop as a channel.
test_solids_for_printers_have_the_loops_of_their_surfaces() {
    ring 12 0.8 0 2
    run_ok corcast export ring.vtk --print wall=0.3 --mesh-tolerance 0.1 -o m.stl --quiet
    expect_topology m.stl 1 3
    expect_json m.stl.json '.print.openings == 2'
    run_ok corcast export ring.vtk --print block=box,ports --mesh-tolerance 0.1 -o m.stl --quiet
    expect_topology m.stl 1 2
}

# The nodes 5 and 6 close loops between the points 3 and 4, from either end. The tree of node 7 ends at point 3.
test_the_thicker_of_parallel_vessels_is_drawn_and_links_join_trees() {
    printf '%s\n' id,parent,x_mm,y_mm,z_mm,radius_mm,type,same_as 1,-1,0,0,0,0.5,3, 2,1,4,0,0,0.5,3, 3,2,8,4,0,0.4,3, \
        4,2,8,-4,0,0.4,3, 5,3,8,-4,0,0.3,3,4 6,4,8,4,0,0.25,3,3 7,-1,0,9,0,0.4,3, 8,7,8,4,0,0.4,3,3 >n.csv
    run_ok corcast export n.csv --mesh-tolerance 0.1 -o m.stl
    expect_topology m.stl 1 1
    run_ok corcast scene n.csv --model rounded -o n.pov --quiet
    [ "$(grep -o '^Vessel_Cylinder.*' n.inc | cut -d, -f 8 | sort | tr '\n' ' ')" = '2 3 4 5 8 ' ] ||
        fail "expected all segments except 6: $(grep Vessel_Cylinder n.inc)"
}

test_a_loop_whose_hole_closes_is_refused_by_its_segments() {
    ring 3 3.1 0 2
    run corcast export ring.vtk -o m.stl --quiet
    expect_status 2
    expect_sentence 'the loop of segments [0-9]+, [0-9]+, [0-9]+ is narrower than its vessels, so the surface has no hole there'
    expect_only ring.vtk
    run_ok corcast export ring.vtk --break-loops -o m.stl --quiet
}

# Wherever the list of lines begins, and so wherever the loop closes, the picture is the same. Arms are left out where
# joints begin at the thickest vessel that ends at a junction, because the ring has two of them.
test_no_picture_shows_where_a_loop_closes() {
    local model arms first
    for model in cylinders rounded joined isosurface blob; do
        arms=$([ $model = joined ] && echo 0 || echo 2)
        for first in 0 5; do
            ring 12 0.8 $first "$arms"
            run_ok corcast render ring.vtk --model $model --size 240x180 --view iso -o $first.ppm --quiet
        done
        expect_same 0.ppm 5.ppm
        run_ok corcast render ring.vtk --break-loops --model $model --size 240x180 --view iso -o cut.ppm --quiet
        expect_differing 300 3000 0.ppm cut.ppm
    done
}

test_voxels_fill_the_ring() {
    ring 12 0.8 0 0
    run_ok corcast export ring.vtk --model rounded --mesh-tolerance 0.02 -o m.stl --quiet
    run_ok corcast export ring.vtk --spacing 0.2 --depth float -o v.nrrd --quiet
    awk -v mesh="$(jq .volume_mm3 m.stl.json)" -v voxels="$(jq .volume_mm3 v.nrrd.json)" \
        'BEGIN { exit !(mesh > 50 && (voxels / mesh - 1) ^ 2 < 0.005 ^ 2) }' ||
        fail "the mesh has $(jq .volume_mm3 m.stl.json) mm^3, the voxels $(jq .volume_mm3 v.nrrd.json)"
}

test_curves_and_scenes_hold_each_segment_once() {
    ring 12 0.8 0 2
    run_ok corcast export ring.vtk -o r.usda --quiet
    awk -F '[][]' '/curveVertexCounts/ { n = split($4, counts, ","); for (i = 1; i <= n; i++) segments += counts[i] - 1 }
        END { exit segments != 14 }' r.usda || fail "expected 14 segments: $(grep curveVertexCounts r.usda)"
    run_ok corcast export ring.vtk -o r.py --quiet
    run_ok corcast export ring.vtk --model rounded --mesh-tolerance 0.2 -o r.glb --quiet
    run_ok corcast scene ring.vtk --model rounded -o r.pov --quiet
    [ "$(grep -c '^Vessel_Cylinder' r.inc)" = 14 ] || fail "expected a cylinder for each segment"
    [ "$(grep -c '^Vessel_Sphere' r.inc)" = 14 ] || fail "expected one ball at each point"
}

test_diagrams_and_pages_show_where_a_loop_closes() {
    ring 12 0.8 0 2
    run_ok corcast diagram ring.vtk -o d.svg --quiet
    [ "$(grep -o 'id="c[0-9]*"' d.svg | wc -l)" = 1 ] || fail "expected one cross bar: $(grep -o 'id="[a-z][0-9]*"' d.svg | tr '\n' ' ')"
    run_ok corcast export ring.vtk -o ring.html --quiet
    grep -q 'id="place"' ring.html || fail "the page does not say where the loop closes"
}

# As they stand, but small.
test_the_pictures_of_the_guide_are_drawn_by_the_commands_beside_them() {
    local command
    [ -d "$SHARED" ] || skip "$SHARED is missing"
    cp "$SHARED/microvesselchaste/retinal.vtp" .
    command=$(sed -n 's/^    corcast \(render retinal.*\)/\1/p' "$REPO/docs/NETWORKS.md")
    # shellcheck disable=SC2086
    run_ok corcast ${command/1200x900/120x90} --quiet
    expect_file retina.jpg
    [ "$(stat -c %s "$REPO/docs/images/retina.jpg")" -le 300000 ] || fail "expected at most 300 kB"
}

run_tests "$@"
