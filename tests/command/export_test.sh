#!/usr/bin/env bash
# `export`: closed meshes, proved by corcast and checked by independent programs.
. "$(dirname "$0")/../lib.sh"

# admesh_says FILE LABEL: prints the number that admesh prints for LABEL.
admesh_says() {
    admesh "$1" 2>&1 | grep -F "$2" | sed 's/.*: *//; s/ .*//'
}

# Grows a tree of 23 terminals, and writes its mesh as STL.
grown() {
    run_ok corcast grow --terminals 23 --domain ball:41 --seed 7 -o t.swc --quiet
    run_ok corcast export t.swc -o t.stl --quiet
}

# is_the_stl FILE SCALE: the mesh that assimp reads, scaled by SCALE, has the number of triangles
# and, within single precision, the volume of t.stl.
is_the_stl() {
    command -v assimp >/dev/null || skip "assimp-utils is not installed"
    run_ok timeout 300 assimp export "$1" read.stl -fstlb
    run_ok admesh --scale="$2" -b scaled.stl read.stl
    [ "$(admesh_says scaled.stl 'Number of facets')" = "$(jq .triangles t.stl.json)" ] ||
        fail "assimp reads $(admesh_says scaled.stl 'Number of facets') triangles of $1"
    [ "$(admesh_says scaled.stl 'Total disconnected facets')" = 0 ] || fail "assimp reads $1 with gaps"
    awk -v a="$(admesh_says t.stl Volume)" -v b="$(admesh_says scaled.stl Volume)" \
        'BEGIN { exit !(a > 100 && (a / b - 1) ^ 2 < 1e-5 ^ 2) }' ||
        fail "assimp reads $(admesh_says scaled.stl Volume) mm^3 of $1, not $(admesh_says t.stl Volume)"
}

# gltf_validator FILE: writes the report of the Khronos glTF validator to ./validated.
gltf_validator() {
    npm_module gltf-validator
    NODE_PATH=$NPM_MODULES node -e '
        const bytes = new Uint8Array(require("fs").readFileSync(process.argv[1]));
        require("gltf-validator").validateBytes(bytes).then(report => console.log(JSON.stringify(report)));' \
        "$1" >validated || fail "gltf-validator fails"
}

# glb_json FILE: prints the first chunk of a GLB, the JSON document.
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

test_the_rounded_model_is_one_closed_mesh_too() {
    run_ok corcast grow --terminals 9 --domain ball:41 --seed 7 -o t.swc --quiet
    run_ok corcast export t.swc --model rounded -o m.stl --quiet
    expect_json m.stl.json '.model == "rounded" and .components == 1 and .genus == 0 and .watertight'
    expect_json m.stl.json '.self_intersections == 0 and .round_ends == [] and .max_distance_over_radius < 0.05'
    [ "$(admesh_says m.stl 'Total disconnected facets')" = 0 ] || fail "admesh finds gaps"
    run_ok corcast export t.swc -o flat.stl --quiet
    expect_json flat.stl.json '.model == "isosurface"'
    run corcast export t.swc --model joined -o none.stl
    expect_status 2
    expect_sentence "--model: 'joined' is not one of isosurface, rounded"
}

test_smooth_vessels_are_in_every_kind_of_file() {
    local file
    run_ok corcast grow --terminals 8 --domain ball:12 --seed 4 -o tree.swc
    for file in tree.stl tree.vtp tree.py tree.nii.gz; do
        run_ok corcast export tree.swc -o $file
        mv $file straight
        run_ok corcast export tree.swc --smooth -o $file
        grep -q 'smooth: 15 segments are drawn as' stderr || fail "expected the number of pieces of $file"
        ! cmp -s $file straight || fail "expected other vessels in $file"
    done
    run_ok corcast export "$DATA/bifurcation.swc" --smooth --model rounded -o rounded.stl
    expect_file rounded.stl
    run_ok corcast info tree.centreline.vtp
    expect_stdout '8 terminals, 7 bifurcations, 1 root'
    run corcast export tree.swc --smooth -o page.html
    expect_status 2
    expect_sentence '--smooth is for surfaces; a page always shows cylinders and balls'
}

test_same_bytes_for_any_number_of_threads() {
    corcast grow --terminals 23 --domain ball:41 --seed 7 -o t.swc --quiet
    run_ok corcast export t.swc -o one.ply --threads 1 --quiet
    run_ok corcast export t.swc -o three.ply --threads 3 --quiet
    expect_same one.ply three.ply
    run_ok corcast export t.swc --model rounded --mesh-tolerance 0.1 -o one.ply --threads 1 --quiet
    run_ok corcast export t.swc --model rounded --mesh-tolerance 0.1 -o three.ply --threads 3 --quiet
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

test_assimp_reads_every_format_with_the_same_triangles() {
    local extension
    grown
    for extension in ply obj 3mf; do
        run_ok corcast export t.swc --color-by radius -o "t.$extension" --quiet
        is_the_stl "t.$extension" 1
    done
}

test_obj_has_groups_by_order_and_a_material_for_each_color() {
    grown
    run_ok corcast export t.swc --color-by strahler -o t.obj --quiet
    [ "$(grep '^g ' t.obj | tr '\n' ' ')" = "g order_1 g order_2 g order_3 g order_4 " ] ||
        fail "expected four groups: $(grep '^g ' t.obj)"
    [ "$(grep -c newmtl t.mtl) $(grep -c usemtl t.obj)" = "4 4" ] || fail "expected four materials, each used once"
    diff <(sed -n 's/newmtl //p' t.mtl) <(sed -n 's/usemtl //p' t.obj | sort) || fail "expected the materials that are used"
    # Normals of caps are flat: each is that of its triangle.
    awk '$1 == "v" { for (i = 2; i < 5; i++) v[++nv, i] = $i; nv -= 2 }
        $1 == "vn" { for (i = 2; i < 5; i++) n[++nn, i] = $i; nn -= 2 }
        $1 == "f" {
            for (k = 2; k < 5; k++) { split($k, at, "//"); p[k] = at[1]; q[k] = at[2] }
            if (q[2] != p[2] && (q[2] != q[3] || q[3] != q[4] || q[2] <= nv || q[2] > nn)) exit 1
            flat += q[2] != p[2]
        }
        END { exit !(flat > 20 && nn == nv + flat) }' t.obj || fail "expected one flat normal for each triangle of a cap"
}

test_3mf_is_one_painted_mesh_that_openscad_imports() {
    grown
    run_ok corcast export t.swc --color-by strahler -o t.3mf --quiet
    echo 'import("t.3mf");' >import.scad
    run_ok timeout 300 openscad -q -o import.stl import.scad
    [ "$(admesh_says import.stl 'Number of facets')" = "$(jq .triangles t.stl.json)" ] || fail "OpenSCAD loses triangles"
    awk -v a="$(admesh_says t.stl Volume)" -v b="$(admesh_says import.stl Volume)" \
        'BEGIN { exit !((a / b - 1) ^ 2 < 1e-5 ^ 2) }' || fail "OpenSCAD reads another volume"
    /usr/bin/python3 - >model.xml <<'END' || fail "Python reads no ZIP archive: $(cat model.xml)"
import zipfile
archive = zipfile.ZipFile("t.3mf")
assert archive.testzip() is None
assert all(entry.date_time == (1980, 1, 1, 0, 0, 0) for entry in archive.infolist())
print(archive.read("3D/3dmodel.model").decode(), end="")
END
    run_ok xmllint --noout model.xml
    grep -q '<model unit="millimeter"' model.xml || fail "expected millimetres"
    [ "$(grep -c '<object ' model.xml)" = 1 ] || fail "expected one object"
    [ "$(grep -c '<triangle .*pid="1" p1="[0-9]*"/>' model.xml)" = "$(jq .triangles t.stl.json)" ] ||
        fail "expected every triangle to be painted"
}

test_names_stay_in_their_place_in_every_format() {
    local extension
    cp "$DATA/bifurcation.swc" $'a<b>&"c\n.swc'
    for extension in ply glb 3mf obj; do
        run_ok corcast export $'a<b>&"c\n.swc' -o "x.$extension" --quiet
    done
    glb_json x.glb >x.json
    expect_json x.json '.nodes[0].extras.description == "arterial tree a<b>&\"c .swc, its surface"'
    /usr/bin/python3 -c 'import zipfile; print(zipfile.ZipFile("x.3mf").read("3D/3dmodel.model").decode())' >model.xml
    run_ok xmllint --noout model.xml
    [ "$(grep -c '^[^#a-z]' x.obj)" = 0 ] || fail "expected no line that OBJ does not know"
    run corcast export "$DATA/bifurcation.swc" -o 'my tree.obj' --quiet
    expect_status 2
    expect_sentence "the material file of an OBJ cannot be called 'my tree.mtl'"
}

# The limit is on the size of files, so that writing fails half way.
test_a_disk_that_is_full_leaves_no_file() {
    local extension
    for extension in stl vtp ply glb obj 3mf inc; do
        run bash -c 'trap "" XFSZ; ulimit -f 8; exec "$@"' sh "$CORCAST" export "$DATA/bifurcation.swc" \
            -o "m.$extension" --quiet
        expect_status 3
        expect_sentence "m.$extension: "
        expect_only
    done
}

test_obj_and_its_materials_are_both_written_or_neither() {
    mkdir m.mtl
    run corcast export "$DATA/bifurcation.swc" -o m.obj --quiet
    expect_status 3
    expect_sentence 'm\.mtl'
    expect_only m.mtl
}

# The files differ only in the bounding box, which is larger in the scene.
test_the_inc_that_is_exported_is_that_of_a_scene() {
    local options='--mesh-tolerance 0.1 --color-by flow --quiet'
    run_ok corcast grow --terminals 9 --domain ball:41 --inlet 0,41,0 --inlet 0,-41,0 --seed 7 --quiet -o t.swc
    # shellcheck disable=SC2086
    run_ok corcast scene t.swc --model mesh $options --look cast -o mesh.pov
    grep -vE '^//|^#declare Tree_M' mesh.inc >of-scene
    # shellcheck disable=SC2086
    run_ok corcast export t.swc $options -o mesh.inc
    grep -vE '^//|^#declare Tree_M' mesh.inc >of-export
    grep -q '^#declare Tree_2 = mesh2' of-export || fail "expected the second tree by its name"
    expect_same of-scene of-export
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

# The two colors are the ends of viridis: linear in GLB, encoded in PLY.
test_colors_are_linear_in_glb_and_encoded_in_ply() {
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

test_refuses_colors_where_a_format_has_none() {
    run corcast export "$DATA/bifurcation.swc" --color-by radius -o m.stl
    expect_status 2
    expect_sentence '--color-by is for formats with colors'
    run corcast export "$DATA/bifurcation.swc" --classes 4 -o m.glb
    expect_status 2
    expect_sentence '--classes needs --color-by'
    expect_only
}

test_refuses_vessels_that_overlap_by_name() {
    run corcast export "$REPO/tests/golden/strangers.swc" -o m.stl --quiet
    expect_status 2
    expect_sentence 'segments 5 and 6 are unconnected, but overlap by 0\.534 mm'
    expect_only
}

test_refuses_vessels_that_leave_one_node_and_overlap_by_name() {
    printf '%s\n' '1 3 0 0 0 1 -1' '2 3 7.9 0 0 1 1' '3 3 9.7 -0.3 0 0.91 2' '4 3 8.3 0.5 0 0.63 2' \
        '5 3 10.5 -0.6 0 0.91 3' '6 3 10.3 0.9 0 0.59 4' '7 3 11.3 -0.1 0 0.47 5' '8 3 11.8 0.6 0 0.46 6' >t.swc
    run corcast export t.swc --mesh-tolerance 0.05 -o m.stl --quiet
    expect_status 2
    expect_sentence 'the vessels of segments [0-9]+ and [0-9]+ overlap where they are unconnected'
    expect_only t.swc
}

test_refuses_a_vessel_that_is_too_short_to_have_a_surface() {
    printf '%s\n' '1 3 0 0 0 1 -1' '2 3 0.05 0 0 1 1' >t.swc
    run corcast export t.swc -o m.stl --quiet
    expect_status 2
    expect_sentence 'segment 2 and its neighbors are too short for their radii: they have no surface'
    expect_only t.swc
}

test_counts_no_segment_as_present_whose_wall_has_no_triangle() {
    local model mm
    # A twig that extends from its trunk by less than the size of a triangle.
    for model in rounded,0.92 isosurface,1.02; do
        mm=${model#*,}
        printf '1 3 0 0 0 1 -1\n2 3 5 0 0 1 1\n3 3 10 0 0 1 2\n4 3 5 %s 0 0.1 2\n' "$mm" >twig.swc
        run_ok corcast export twig.swc --model "${model%,*}" --mesh-tolerance 0.1 -o m.stl --quiet
        expect_json m.stl.json '.segments == 3 and .segments_present == 2 and .segments_slivers == [4]'
        expect_json m.stl.json '.segments_missing == [] and .segments_swallowed == []'
    done
}

# moved_by X: writes moved.swc, the tree t.swc moved by X mm along x.
moved_by() {
    awk -v mm="$1" '!/^#/ { printf "%s %s %.17g %s %s %s %s\n", $1, $2, $3 + mm, $4, $5, $6, $7 }' t.swc >moved.swc
}

test_a_tree_too_far_from_the_origin_for_its_radii_is_refused_by_its_distance() {
    local model
    run_ok corcast grow --domain ball:20 --terminals 9 --seed 3 -o t.swc --quiet
    for model in rounded isosurface; do
        moved_by 1000
        run_ok corcast export moved.swc --model $model --mesh-tolerance 0.1 -o m.stl --quiet
        moved_by 1e6
        run timeout 300 "$CORCAST" export moved.swc --model $model --mesh-tolerance 0.1 -o m.stl --quiet
        expect_status 2
        expect_sentence 'reaches 10000[0-9.]+ mm from the origin, where neighboring coordinates in single precision are 0\.062 mm apart'
        expect_sentence 'too coarse for the radius of segment [0-9]+, 0\.[0-9]+ mm; move the tree nearer'
    done
    # Two vessels that blend along their whole length. Their surfaces cross only because of
    # rounding.
    printf '1 3 256 -252 -4096 .375 -1\n2 3 256 -260 -4096 .375 1\n3 3 256.25 -252 -4096 .1875 2\n4 3 258 -260 -4096 .1875 3\n' >far.swc
    run timeout 300 "$CORCAST" export far.swc --model rounded -o m.stl --quiet
    expect_status 2
    expect_sentence 'reaches 4096\.[0-9]+ mm from the origin'
}

test_names_may_begin_with_a_hyphen() {
    cp "$DATA/bifurcation.swc" ./-t.swc
    run_ok corcast export -o -m.stl --quiet -- -t.swc
    expect_json ./-m.stl.json '.watertight'
}

test_part_overlaps_thins_them_and_says_so() {
    run_ok corcast export "$REPO/tests/golden/strangers.swc" --part-overlaps -o m.stl
    grep -q 'segments are thinned' stderr || fail "it does not say so: $(cat stderr)"
    expect_json m.stl.json '.components == .trees and .self_intersections == 0'
    expect_json m.stl.json '.segments_thinned | index(5) != null and index(6) != null'
    expect_json m.stl.json '[.near_pairs[].gap_mm] | min > 0'
}

# The stated time depends on the machine. The test only checks that it is stated.
test_says_before_what_the_work_takes() {
    local terminals told
    for terminals in 3 17 60; do
        corcast grow --terminals "$terminals" --domain ball:41 --seed 7 -o t.swc --quiet
        run_ok corcast export t.swc -o t.stl --mesh-tolerance 0.067
        told=$(sed -n 's/.*about \([0-9.e+]*\) triangles, [0-9.e-]* s and [0-9.]* [kM]B of memory/\1/p' stderr)
        awk -v a="$told" -v b="$(jq .triangles t.stl.json)" 'BEGIN { exit !(a > b / 2 && a < 2 * b) }' ||
            fail "$(jq .triangles t.stl.json) triangles, but it says: $(cat stderr)"
    done
}

test_refuses_before_the_work_what_needs_more_memory_than_there_is() {
    awk 'BEGIN { for (i = 1; i <= 400000; i++) print i, 3, i * 2.385, 0, 0, 0.31, (i > 1 ? i - 1 : -1) }' >long.swc
    run timeout 300 "$CORCAST" export long.swc --mesh-tolerance 0.002 -o m.stl --quiet
    expect_status 3
    expect_sentence 'the mesh: out of memory: needs [0-9.]* [GT]B, and this machine has'
    expect_only long.swc
}

test_level_of_detail_keeps_about_that_part_of_the_triangles() {
    local part
    grown
    for part in 0.37 0.12; do
        run_ok corcast export t.swc --lod "$part" -o less.stl --quiet
        awk -v a="$(jq .triangles less.stl.json)" -v b="$(jq .triangles t.stl.json)" -v part="$part" \
            'BEGIN { exit !(a > 0.8 * part * b && a < 1.25 * part * b) }' ||
            fail "$(jq .triangles less.stl.json) of $(jq .triangles t.stl.json) triangles are no $part"
        expect_json less.stl.json '.watertight and .components == 1 and .genus == 0 and .self_intersections == 0'
        expect_json less.stl.json '.segments_missing == [] and .tolerance > 0.05'
        expect_json less.stl.json ".max_distance_over_radius > $(jq .max_distance_over_radius t.stl.json)"
    done
    run corcast export t.swc --lod 1.2 -o less.stl
    expect_status 2
    expect_sentence "--lod: '1.2' is not a number above 0 and at most 1"
}

test_refuses_an_unknown_extension() {
    run corcast export "$DATA/bifurcation.swc" -o m.xyz
    expect_status 2
    expect_sentence "'m.xyz' does not end in .scad, .stl, .vtp, .msh, .vtu, .ply, .glb, .obj, .3mf, .py, .usda or .inc"
}

run_tests "$@"
