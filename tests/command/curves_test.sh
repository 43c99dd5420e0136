#!/usr/bin/env bash
# `export` as curves and beams: Blender's script, USD and the beam lattice of a 3MF. Blender itself
# runs in tests/all.
. "$(dirname "$0")/../lib.sh"

# Grows a forest of 23 terminals.
grown() {
    run_ok corcast grow --terminals 23 --domain ball:41 --inlet 0,41,0 --inlet 0,-41,0 --seed 7 -o t.swc --quiet
}

# is_as_curves FILE TREE: the script or USDA contains each segment of the SWC once, with its ends
# and its radius, in an object of its tree and Strahler order. Prints the objects. The reader
# understands only the constructs that corcast writes.
is_as_curves() {
    /usr/bin/python3 - "$@" >objects <<'END' || fail "$(cat objects)"
import ast, math, re, sys
import numpy as np
text = open(sys.argv[1]).read()
def numbers(chars):
    return np.array([float(x) for x in re.findall(r"[-+0-9.e]+", chars)])
def of_script():
    for call in (node.value for node in ast.parse(text).body if isinstance(node, ast.Expr)):
        name, tree, order, splines = map(ast.literal_eval, call.args)
        yield name, tree, order, [np.array(at).reshape(-1, 4) for _, _, at in splines]
def of_usd():
    for prim in text.split("def BasisCurves ")[1:]:
        array = lambda name: numbers(re.search(re.escape(name) + r" = \[(.*?)\]", prim, re.S)[1])
        number = lambda name: int(re.search(name + r" = (\d+)", prim)[1])
        counts, points, widths = array("curveVertexCounts").astype(int), array("points").reshape(-1, 3), array("widths")
        assert counts.sum() == len(points) == len(widths) == len(array("primvars:segment"))
        assert len(array("displayColor")) in (3, 3 * len(points))
        low, high = array("extent").reshape(2, 3)
        assert (points - widths[:, None] / 2 >= low - 1e-4).all() and (points + widths[:, None] / 2 <= high + 1e-4).all()
        rows = np.column_stack([points, widths / 2])
        yield prim.split('"')[1], number("int tree"), number("strahlerOrder"), np.split(rows, counts.cumsum()[:-1])
nodes = {int(w[0]): ([float(x) for x in w[2:6]], int(w[6])) for w in map(str.split, open(sys.argv[2])) if w and w[0] != "#"}
key = lambda at: tuple(np.float32(at).tolist())
expected = sorted((key(nodes[up][0][:3]), key(at)) for at, up in nodes.values() if up > 0)
found = []
for name, tree, order, curves in of_script() if sys.argv[1].endswith(".py") else of_usd():
    print(name, tree, order, len(curves))
    for rows in curves:
        assert len(rows) >= 2 and rows[0, 3] == rows[1, 3], "the first radius is not that of the first segment"
        found += [(key(a[:3]), key(b)) for a, b in zip(rows, rows[1:])]
if sorted(found) != expected:
    sys.exit(print("expected", len(expected), "segments, found", len(found)) or 1)
END
}

test_script_and_usd_have_every_segment_once_in_objects_by_tree_and_order() {
    local extension
    grown
    run_ok corcast convert t.swc t.csv --fields strahler,tree --quiet
    grep -v '^#' t.csv | awk -F , 'NR > 1 && $NF != "" && $NF != "nan" { print "tree_" $NF "_order_" $(NF - 1) }' | sort -u >expected
    [ "$(wc -l <expected)" -ge 6 ] || fail "expected six orders of two trees: $(cat expected)"
    for extension in py usda; do
        run_ok corcast export t.swc -o "t.$extension" --quiet
        is_as_curves "t.$extension" t.swc
        cut -d " " -f 1 objects | sort >found
        expect_same expected found
    done
}

# Consecutive segments of an order share a spline, so there are fewer splines than segments.
test_a_curve_goes_on_as_long_as_its_order_and_its_color() {
    local plain
    run_ok corcast export "$DATA/coronary.swc" -o plain.py --quiet
    is_as_curves plain.py "$DATA/coronary.swc"
    plain=$(awk '{ n += $4 } END { print n }' objects)
    run_ok corcast export "$DATA/coronary.swc" --color-by strahler -o same.py --quiet
    is_as_curves same.py "$DATA/coronary.swc"
    [ "$(awk '{ n += $4 } END { print n }' objects)" = "$plain" ] || fail "expected colors of orders to part no curve"
    run_ok corcast export "$DATA/coronary.swc" --color-by level -o other.py --quiet
    is_as_curves other.py "$DATA/coronary.swc"
    [ "$(awk '{ n += $4 } END { print n }' objects)" -gt "$plain" ] || fail "expected other colors to part curves"
}

test_a_script_has_at_most_64_materials_and_uses_each() {
    run_ok corcast grow --terminals 400 --domain ball:41 --seed 7 -o t.swc --quiet
    run_ok corcast export t.swc --color-by radius -o t.py --quiet
    grep -c '^("vessel_[0-9A-F]\{6\}", (' t.py >count
    [ "$(cat count)" -gt 20 ] && [ "$(cat count)" -le 64 ] || fail "expected 21 to 64 materials, got $(cat count)"
    [ "$(sed -n 's/^(\([0-9]*\), .*/\1/p' t.py | sort -u | wc -l)" = "$(cat count)" ] || fail "expected each material to be used"
}

test_usd_is_in_millimetres_with_widths_and_without_normals() {
    grown
    run_ok corcast export t.swc --color-by flow -o t.usda --quiet
    [ "$(head -1 t.usda)" = "#usda 1.0" ] || fail "expected USD as text"
    grep -q '^    metersPerUnit = 0.001$' t.usda && grep -q '^    upAxis = "Y"$' t.usda || fail "expected millimetres, y up"
    ! grep -q normals t.usda || fail "expected no normals: curves that have some are ribbons"
    grep -q 'string command = "corcast export t.swc --color-by flow -o M.usda"' t.usda || fail "$(grep command t.usda)"
    [ "$(tr -cd '[{(' <t.usda | wc -c)" = "$(tr -cd ']})' <t.usda | wc -c)" ] || fail "expected as many brackets open as closed"
}

# lib3mf 1.8 does not support colors of beams and warns about them.
test_lib3mf_reads_a_beam_for_each_segment_and_the_preview_that_represents_them() {
    ldconfig -p | grep -q lib3MF.so.1 || skip "lib3mf1 is not installed"
    grown
    run_ok corcast export t.swc --lattice -o t.3mf --quiet
    /usr/bin/python3 "$REPO/tests/oracle/read_lattice.py" "$PWD/t.3mf" >read.json || fail "lib3mf does not read it: $(cat read.json)"
    corcast info t.swc --json --quiet >info.json
    expect_json read.json '.warnings == 0 and (.objects | length) == 2'
    expect_json read.json '.objects[0] | .closed and .beams == []'
    expect_json read.json ".objects[0].triangles == 12 * $(jq .segments info.json)"
    expect_json read.json '.objects[1].represented_by == .objects[0].id and .objects[1].triangles == 0'
    expect_json read.json ".objects[1].beams | length == $(jq .segments info.json)"
    expect_json read.json '.objects[1] | .minlength > 0 and all(.beams[]; .length > 0) and all(.beams[]; .caps == [0, 0])'
    expect_json read.json '.objects[1] | .minlength as $least | all(.beams[]; .length >= $least and .radii[0] == .radii[1])'
    expect_json read.json "[.objects[1].beams[] | .radii[0] * .radii[0] * .length * 3.141592653589793] | add |
        . / $(jq .volume_mm3 info.json) - 1 | . * . < 1e-12"
    # Vessels that meet share a node, so each tree is connected.
    expect_json read.json '.objects[1].beams | ([.[].nodes[]] | unique | length) == length + 2'
}

test_a_lattice_paints_beams_and_says_that_beams_must_be_read() {
    grown
    run_ok corcast export t.swc --lattice --color-by radius -o t.3mf --quiet
    /usr/bin/python3 -c 'import zipfile; print(zipfile.ZipFile("t.3mf").read("3D/3dmodel.model").decode(), end="")' >model.xml
    run_ok xmllint --noout model.xml
    grep -q 'requiredextensions="b"' model.xml || fail "expected the extension to be required"
    [ "$(grep -c '<b:beam .* pid="1" p1="\([0-9]*\)" p2="\1"/>' model.xml)" = "$(corcast info t.swc --json | jq .segments)" ] ||
        fail "expected every beam to be painted"
    run_ok corcast export t.swc --color-by radius -o mesh.3mf --quiet
    /usr/bin/python3 -c 'import zipfile; print(zipfile.ZipFile("mesh.3mf").read("3D/3dmodel.model").decode(), end="")' >mesh.xml
    expect_same <(grep 'm:color ' model.xml) <(grep 'm:color ' mesh.xml)
}

test_curves_and_beams_may_overlap() {
    local file
    for file in m.py m.usda 'm.3mf --lattice'; do
        # shellcheck disable=SC2086
        run_ok corcast export "$REPO/tests/golden/strangers.swc" --quiet -o $file
    done
    expect_only m.py m.usda m.3mf
}

test_names_stay_in_their_place() {
    cp "$DATA/bifurcation.swc" $'a<b>\\&"c\n.swc'
    run_ok corcast export $'a<b>\\&"c\n.swc' -o x.py --quiet
    run_ok /usr/bin/python3 -m py_compile x.py
    /usr/bin/python3 - <<'END' || fail "expected the command as it is: $(grep command= x.py)"
import ast
strings = [node.value for node in ast.walk(ast.parse(open("x.py").read())) if isinstance(node, ast.Constant)]
assert any(isinstance(s, str) and 'a<b>\\&"c .swc' in s for s in strings)
END
    run_ok corcast export $'a<b>\\&"c\n.swc' -o x.usda --quiet
    grep -qF 'doc = "arterial tree a<b>\\&\"c .swc, its vessels"' x.usda || fail "$(grep doc x.usda)"
}

# The limit is on the size of files, so that writing fails half way.
test_a_disk_that_is_full_leaves_no_file() {
    local file
    run_ok corcast grow --terminals 200 --domain ball:41 --seed 7 -o t.swc --quiet
    for file in m.py m.usda 'm.3mf --lattice'; do
        # shellcheck disable=SC2086
        run bash -c 'trap "" XFSZ; ulimit -f 8; exec "$@"' sh "$CORCAST" export t.swc --quiet -o $file
        expect_status 3
        expect_only t.swc
    done
}

test_refuses_options_of_triangles_and_a_lattice_elsewhere() {
    run corcast export "$DATA/bifurcation.swc" --mesh-tolerance 0.1 -o m.py
    expect_status 2
    expect_sentence '--mesh-tolerance is for formats of triangles'
    run corcast export "$DATA/bifurcation.swc" --lattice --lod 0.5 -o m.3mf
    expect_status 2
    expect_sentence '--lod is for formats of triangles'
    run corcast export "$DATA/bifurcation.swc" --lattice -o m.stl
    expect_status 2
    expect_sentence '--lattice needs a \.3mf output'
    expect_only
}

# Blender's front camera shows the whole tree, whose size follows --scale.
test_blender_adds_a_camera_that_frames_the_tree() {
    command -v blender >/dev/null || skip "blender is not installed"
    run_ok corcast export "$DATA/bifurcation.swc" -o t.py --quiet
    cat >look.py <<'END'
import bpy
from bpy_extras.object_utils import world_to_camera_view as view
bpy.context.view_layer.update()
scene, tree = bpy.context.scene, bpy.data.objects["tree"]
at = [view(scene, scene.camera, o.matrix_world @ p.co.to_3d()) for o in tree.children
      for s in o.data.splines for p in s.points]
print("SEEN", all(0 < p.x < 1 and 0 < p.y < 1 and p.z > 0 for p in at),
      max(p.y for p in at) - min(p.y for p in at) > 0.4, round(tree.scale.x, 6), scene.camera.name)
END
    run_ok timeout 300 blender -b -P t.py -P look.py -- --scale 0.1 --camera
    expect_stdout '^SEEN True True 0.1 tree_camera$'
}

# A note suggests --lod for a large glTF file, but not for a small one or one that was written with
# --lod.
test_a_heavy_glb_is_told_about_lod() {
    run_ok corcast grow --terminals 150 --domain ball:20 --quiet -o t.swc
    run_ok corcast export t.swc -o t.glb
    grep -q -e '--lod 0.25' stderr || fail "expected a hint to --lod: $(cat stderr)"
    run_ok corcast export t.swc --lod 0.25 -o t.glb
    ! grep -q -e '--lod' stderr || fail "expected no hint for a lighter file"
    run_ok corcast export "$DATA/bifurcation.swc" -o t.glb
    ! grep -q -e '--lod' stderr || fail "expected no hint for a small file"
}

run_tests "$@"
