#!/usr/bin/env bash
# `export`: closed meshes, proved and looked at by programs that are not ours.
. "$(dirname "$0")/../lib.sh"

# admesh_says FILE LABEL: the number that admesh prints for it.
admesh_says() {
    admesh "$1" 2>&1 | grep -F "$2" | sed 's/.*: *//; s/ .*//'
}

# A grown tree of 23 terminals, and its mesh as STL.
grown() {
    run_ok corcast grow --terminals 23 --domain ball:41 --seed 7 -o t.swc --quiet
    run_ok corcast export t.swc -o t.stl --quiet
}

# is_the_stl FILE SCALE: what assimp reads of it, times SCALE, has the triangles and the volume of t.stl, to what single
# precision gives.
is_the_stl() {
    command -v assimp >/dev/null || skip "assimp-utils is not installed"
    run_ok timeout 60 assimp export "$1" read.stl -fstlb
    run_ok admesh --scale="$2" -b scaled.stl read.stl
    [ "$(admesh_says scaled.stl 'Number of facets')" = "$(jq .triangles t.stl.json)" ] ||
        fail "assimp reads $(admesh_says scaled.stl 'Number of facets') triangles of $1"
    [ "$(admesh_says scaled.stl 'Total disconnected facets')" = 0 ] || fail "assimp reads $1 with gaps"
    awk -v a="$(admesh_says t.stl Volume)" -v b="$(admesh_says scaled.stl Volume)" \
        'BEGIN { exit !(a > 100 && (a / b - 1) ^ 2 < 1e-5 ^ 2) }' ||
        fail "assimp reads $(admesh_says scaled.stl Volume) mm^3 of $1, not $(admesh_says t.stl Volume)"
}

# gltf_validator FILE: what Khronos's validator says of it, in ./validated.
gltf_validator() {
    local modules=$REPO/build/npm
    if [ ! -d "$modules/node_modules/gltf-validator" ]; then
        command -v npm >/dev/null || skip "gltf-validator is not there, and no npm to install it"
        mkdir -p "$modules" && cp "$REPO"/tests/npm/*.json "$modules" &&
            timeout 60 npm ci --prefix "$modules" >npm.log 2>&1 || skip "npm cannot install gltf-validator: $(tail -1 npm.log)"
    fi
    NODE_PATH=$modules/node_modules node -e '
        const bytes = new Uint8Array(require("fs").readFileSync(process.argv[1]));
        require("gltf-validator").validateBytes(bytes).then(report => console.log(JSON.stringify(report)));' \
        "$1" >validated || fail "gltf-validator fails"
}

# glb_json FILE: its first chunk.
glb_json() {
    tail -c +21 "$1" | head -c "$(od -An -t u4 -j 12 -N 4 "$1")"
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

test_assimp_reads_ply_with_the_same_triangles() {
    grown
    run_ok corcast export t.swc -o t.ply --quiet
    is_the_stl t.ply 1
}

test_glb_has_no_error_and_no_warning_of_the_validator() {
    local coloring
    grown
    for coloring in '' '--color-by flow --log'; do
        # shellcheck disable=SC2086
        run_ok corcast export t.swc $coloring -o t.glb --quiet
        gltf_validator t.glb
        expect_json validated '.issues | .numErrors == 0 and .numWarnings == 0'
        expect_json validated ".info.totalTriangleCount == $(jq .triangles t.stl.json)"
    done
    is_the_stl t.glb 1000
}

test_glb_has_a_node_for_each_order_in_metres() {
    grown
    run_ok corcast export t.swc --color-by strahler -o t.glb --quiet
    glb_json t.glb >t.json
    expect_json t.json '[.nodes[].name] == ["tree", "order_1", "order_2", "order_3", "order_4"]'
    expect_json t.json '.nodes[0] | .scale == [0.001, 0.001, 0.001] and .extras.color_by == "strahler"'
    expect_json t.json '.asset.extras.command | test("export t.swc --color-by strahler")'
    expect_json t.json '. as $all | all(.meshes[].primitives[];
        [.attributes[] | $all.accessors[.].count] | length == 3 and (unique | length) == 1)'
    expect_json t.json '.materials[0].pbrMetallicRoughness.baseColorFactor == [1, 1, 1, 1]'
}

# Of one field two colours: the ends of viridis, linear in GLB and encoded in PLY.
test_colours_are_linear_in_glb_and_encoded_in_ply() {
    local extension
    /usr/bin/python3 -c 'import numpy' 2>import.log || skip "python3-numpy is not installed"
    for extension in glb ply; do
        run_ok corcast export "$DATA/bifurcation.swc" --color-by strahler -o "t.$extension" --quiet
    done
    /usr/bin/python3 - >colors <<'END' || fail "$(cat colors)"
import json, sys
import numpy as np
glb, ply = open("t.glb", "rb").read(), open("t.ply", "rb").read()
size = int.from_bytes(glb[12:16], "little")
document, buffer = json.loads(glb[20:20 + size]), glb[28 + size:]
linear = np.concatenate([np.frombuffer(buffer, "<f4", 3 * a["count"],
    document["bufferViews"][2]["byteOffset"] + a["byteOffset"]).reshape(-1, 3)
    for a in document["accessors"] if a["bufferView"] == 2])
head, body = ply.split(b"end_header\n", 1)
n = int(head.split(b"element vertex ")[1].split()[0])
codes = np.frombuffer(body, np.dtype([("x", "<f4", 6), ("c", "u1", 3)]), n)["c"]
ends = [[68, 1, 84], [253, 231, 37]]  # of viridis
encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9)**(1 / 2.4) - 0.055)
glb_codes = np.unique(np.round(255 * encoded).astype(int), axis=0).tolist()
ply_codes = np.unique(codes, axis=0).tolist()
print("GLB", glb_codes, "PLY", ply_codes, "expected", ends)
sys.exit(0 if glb_codes == ends and ply_codes == ends else 1)
END
}

test_refuses_colours_where_a_format_has_none() {
    run corcast export "$DATA/bifurcation.swc" --color-by radius -o m.stl
    expect_status 2
    expect_sentence '--color-by is for formats with colours'
    run corcast export "$DATA/bifurcation.swc" --classes 4 -o m.glb
    expect_status 2
    expect_sentence '--classes needs --color-by'
    expect_only
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
    expect_sentence "'m.xyz' does not end in .scad, .stl, .ply or .glb"
}

run_tests
