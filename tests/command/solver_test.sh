#!/usr/bin/env bash
# `export` for solvers: named parts and their accompanying files, read by VTK and filled by TetGen.
. "$(dirname "$0")/../lib.sh"

# Grows a tree of 23 terminals.
grown() {
    run_ok corcast grow --terminals 23 --domain ball:41 --seed 7 -o t.swc --quiet
}

# volumes_of_tetrahedra NAME: prints the volume of each region that TetGen numbers in NAME.1.node
# and NAME.1.ele, in ascending order.
volumes_of_tetrahedra() {
    awk 'FNR == 1 || /^#/ { next }
        FILENAME ~ /node$/ { for (k = 0; k < 3; k++) x[$1, k] = $(k + 2); next }
        {
            for (i = 0; i < 3; i++) for (k = 0; k < 3; k++) v[i, k] = x[$(i + 3), k] - x[$2, k]
            for (k = 0; k < 3; k++) {
                m = (k + 1) % 3; n = (k + 2) % 3
                sum[$6] += v[0, k] * (v[1, m] * v[2, n] - v[1, n] * v[2, m]) / 6
            }
        }
        END { for (region in sum) printf "%.9g\n", sum[region] < 0 ? -sum[region] : sum[region] }' "$1.1.node" "$1.1.ele" |
        sort -g
}

# The area of an end is that of a regular polygon inscribed in its circle.
test_vtk_reads_the_parts_with_the_names_areas_and_normals_of_the_table() {
    /usr/bin/python3 -c 'import vtk' 2>import.log || skip "python3-vtk9 is not installed"
    grown
    run_ok corcast export t.swc -o t.vtp --quiet
    /usr/bin/python3 - >said <<'END' || fail "$(cat said)"
import csv, json, math, sys
import numpy as np, vtk
from vtk.util.numpy_support import vtk_to_numpy
reader = vtk.vtkXMLPolyDataReader()
reader.SetFileName("t.vtp")
reader.Update()
mesh = reader.GetOutput()
manifest = json.load(open("t.vtp.json"))
def expect(what, is_so):
    if not is_so:
        sys.exit(print("VTK:", what) or 1)
names = mesh.GetFieldData().GetAbstractArray("FaceNames")
names = [names.GetValue(i) for i in range(names.GetNumberOfValues())]
faces = vtk_to_numpy(mesh.GetCellData().GetArray("ModelFaceID"))
segments = vtk_to_numpy(mesh.GetCellData().GetArray("segment"))
corners = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
a, b, c = (points[corners[:, k]] for k in range(3))
areas = np.cross(b - a, c - a) / 2
ends = list(csv.DictReader(open("t.ends.csv")))
expect("triangles", len(corners) == manifest["triangles"])
expect("names of faces", names == ["wall"] + [end["name"] for end in ends])
expect("an inlet and 23 outlets", names[1] == "inlet" and len(set(names)) == 25)
expect("numbers of faces", sorted(set(faces)) == list(range(1, 26)))
for end in ends:
    at = faces == int(end["face"])
    area = areas[at].sum(axis=0)
    size, normal = np.linalg.norm(area), np.array([float(end["normal_" + k]) for k in "xyz"])
    center, circle = [float(end[k + "_mm"]) for k in "xyz"], math.pi * float(end["radius_mm"])**2
    expect("segments of " + end["name"], set(segments[at]) == {int(end["id"])})
    expect("area of " + end["name"], abs(size / float(end["area_mm2"]) - 1) < 1e-6 and 0.98 * circle < size < circle)
    expect("normal of " + end["name"], np.linalg.norm(area / size - normal) < 1e-4)
    mean = np.average((a + b + c)[at] / 3, axis=0, weights=np.linalg.norm(areas[at], axis=1))
    expect("middle of " + end["name"], np.linalg.norm(mean - center) < 1e-3 * float(end["radius_mm"]))
    flat = (np.concatenate([a[at], b[at], c[at]]) - center) @ normal
    expect("flatness of " + end["name"], abs(flat).max() < 1e-5)
expect("flow", abs(sum(float(end["flow_part"]) for end in ends) - 2) < 1e-12 and float(ends[0]["flow_part"]) == 1)
edges = vtk.vtkFeatureEdges()
edges.SetInputData(mesh)
edges.FeatureEdgesOff()
edges.Update()
expect("open edges", edges.GetOutput().GetNumberOfCells() == 0)
mass = vtk.vtkMassProperties()
mass.SetInputData(mesh)
mass.Update()
expect("volume", abs(mass.GetVolume() / manifest["volume_mm3"] - 1) < 1e-5)
END
}

test_stl_has_a_named_solid_for_each_part_and_the_same_triangles() {
    grown
    run_ok corcast export t.swc -o plain.stl --quiet
    run_ok corcast export t.swc --parts -o t.stl --quiet
    expect_same plain.stl.json t.stl.json
    sed -n 's/^solid //p' t.stl >solids
    expect_same solids <(echo wall && sed '1d; s/,.*//' t.ends.csv)
    expect_same solids <(sed -n 's/^endsolid //p' t.stl)
    [ "$(head -2 solids | tail -1) $(wc -l <solids)" = "inlet 25" ] || fail "expected an inlet and 23 outlets: $(cat solids)"
    # admesh can read only one solid per file.
    grep -v solid t.stl | sed '1i solid all' | sed '$a endsolid all' >all.stl
    run_ok admesh all.stl
    mv stdout said
    grep -qE 'Total disconnected facets *: +0 ' said || fail "admesh finds gaps"
    grep -qE "Number of facets *: +$(jq .triangles t.stl.json) " said || fail "admesh finds other triangles: $(cat said)"
}

test_tetgen_fills_the_surface_as_it_is() {
    command -v tetgen >/dev/null || skip "tetgen is not installed"
    grown
    run_ok corcast export t.swc --parts -o t.stl --quiet
    run_ok timeout 300 tetgen -pYQ t.stl
    awk -v a="$(jq .volume_mm3 t.stl.json)" -v b="$(volumes_of_tetrahedra t)" 'BEGIN { exit !(a > 100 && (a / b - 1) ^ 2 < 1e-5 ^ 2) }' ||
        fail "TetGen fills $(volumes_of_tetrahedra t) mm^3 of $(jq .volume_mm3 t.stl.json)"
    # With -Y, TetGen adds no points on the surface.
    [ "$(awk '!/^#/ && NR > 1 { n++ } END { print n }' t.1.face)" = "$(jq .triangles t.stl.json)" ] ||
        fail "TetGen's surface has other triangles"
}

# The wall and the lumen share triangles, so that their tetrahedra fit together.
test_a_wall_is_a_second_surface_and_tetgen_fills_wall_and_lumen() {
    command -v tetgen >/dev/null || skip "tetgen is not installed"
    run_ok corcast grow --terminals 7 --domain ball:41 --seed 7 -o t.swc --quiet
    run_ok corcast export t.swc --mesh-tolerance 0.06 --parts -o plain.stl --quiet
    run_ok corcast export t.swc --mesh-tolerance 0.06 --parts --wall 0.285 -o t.stl --quiet
    [ "$(sed -n 's/^solid //p' t.stl | head -3 | tr '\n' ' ')" = "outer lumen inlet " ] || fail "$(grep ^solid t.stl)"
    sed 1d plain.ends.csv | sed 's/^\([^,]*\),[0-9]*,/\1,/' >discs
    expect_same discs <(sed '1d; /_ring/d' t.ends.csv | sed 's/^\([^,]*\),[0-9]*,/\1,/')
    [ "$(grep -c _ring, t.ends.csv)" = 8 ] || fail "expected a ring at each end"
    # The area of a ring differs from the exact value because polygons replace its circles.
    awk -F , '/_ring,/ { c = 3.141592653589793 * (($10 + 0.285) ^ 2 - $10 ^ 2); if ($11 < 0.95 * c || $11 >= c || $12 != "") exit 1 }' \
        t.ends.csv || fail "expected rings of 0.285 mm: $(grep _ring t.ends.csv)"
    run_ok timeout 300 tetgen -pYAQ t.stl
    volumes_of_tetrahedra t >volumes
    jq '.print.lumen_mm3, .volume_mm3' t.stl.json | sort -g | paste volumes - |
        awk 'NF != 2 || $2 < 50 || ($1 / $2 - 1) ^ 2 > 1e-5 ^ 2 { exit 1 } END { exit NR != 2 }' ||
        fail "TetGen fills $(cat volumes), expected $(jq -c '[.print.lumen_mm3, .volume_mm3]' t.stl.json)"
    expect_json plain.stl.json ".volume_mm3 / $(jq .print.lumen_mm3 t.stl.json) - 1 | . * . < 1e-12"
}

test_refuses_a_wall_without_named_parts_and_beside_a_print() {
    run corcast export "$DATA/bifurcation.swc" --wall 0.3 -o m.stl
    expect_status 2
    expect_sentence '--wall is for named parts: a \.vtp, \.msh or \.vtu, or an \.stl with --parts'
    run corcast export "$DATA/bifurcation.swc" --wall 0.3 --print scale=2 -o m.vtp
    expect_status 2
    expect_sentence '--wall and --print exclude each other'
    expect_only
}

test_the_flow_of_ends_parts_as_it_is_told() {
    grown
    run_ok corcast export t.swc --flow-split murray --flow-exponent 2.27 -o t.vtp --quiet
    awk -F , 'NR > 2 { r[NR] = $10 ^ 2.27; sum += r[NR]; part[NR] = $12 }
        END { for (i in r) if ((part[i] - r[i] / sum) ^ 2 > 1e-24) exit 1; exit !(NR == 25) }' t.ends.csv ||
        fail "expected parts as the radii to the power of 2.27: $(cat t.ends.csv)"
}

test_refuses_parts_of_a_body_without_flat_ends() {
    run corcast export "$DATA/bifurcation.swc" --model rounded -o m.vtp
    expect_status 2
    expect_sentence '--parts needs flat vessel ends, which --model rounded lacks'
    expect_only
}

# Other vessels are too close to the trunk's end for a flat cut.
test_an_end_that_cannot_be_cut_off_flat_is_lengthened_until_it_can() {
    printf '%s\n' '1 3 0 0 0 1 -1' '2 3 0 1.9 0 1 1' '3 3 5.3 0.9 0 0.9 2' '4 3 -5 0.4 0 0.8 2' >short.swc
    run_ok corcast export short.swc -o plain.stl --quiet
    expect_json plain.stl.json '.round_ends == [2] and .segments_lengthened == []'
    run_ok corcast export short.swc --parts -o t.stl
    grep -q '1 end is lengthened' stderr || fail "it does not say so: $(cat stderr)"
    expect_json t.stl.json '.round_ends == [] and .segments_lengthened == [2]'
    [ "$(sed -n 's/^solid //p' t.stl | sed -n 2p)" = inlet ] || fail "expected an inlet: $(grep ^solid t.stl)"
    run_ok corcast convert t.centreline.vtp again.swc --quiet
    run_ok corcast convert short.swc same.swc --quiet
    [ "$(diff <(grep -v '^#' same.swc | cut -d ' ' -f 3-5) <(grep -v '^#' again.swc | cut -d ' ' -f 3-5) | grep -c '^>')" = 1 ] ||
        fail "expected the root alone to be at another place"
}

# Triangles have the requested length along a tube, and the width of a side of its rim. At 3 mm and
# more from the bifurcation, the longest edges are those of the end discs.
test_tubes_have_triangles_as_short_as_asked() {
    printf '%s\n' '1 3 0 0 0 1.2 -1' '2 3 0.3 21 -0.7 1.2 1' '3 3 -9.1 32.2 1.1 0.87 2' '4 3 7.4 33.9 0.6 0.71 2' >t.swc
    run_ok corcast export t.swc --parts --mesh-tolerance 0.05 -o long.stl --quiet
    run_ok corcast export t.swc --parts --mesh-tolerance 0.05 --tube-edge 0.45 -o t.stl --quiet
    expect_json t.stl.json '.watertight and .components == 1 and .genus == 0 and .self_intersections == 0'
    expect_json t.stl.json ".triangles > 4 * $(jq .triangles long.stl.json)"
    expect_json t.stl.json ".volume_mm3 / $(jq .volume_mm3 long.stl.json) - 1 | . * . < 0.01 * 0.01"
    run_ok corcast export t.swc --parts --mesh-tolerance 0.05 --tube-edge 0.45 --threads 3 -o again.stl --quiet
    expect_same t.stl again.stl
    local name longest
    for name in long t; do
        longest=$(awk '$1 == "vertex" { n = (n + 1) % 3; for (k = 0; k < 3; k++) x[n, k] = $(k + 2)
            if (n == 0) for (i = 0; i < 3; i++) {
                d = 0
                for (k = 0; k < 3; k++) d += (x[i, k] - x[(i + 1) % 3, k]) ^ 2
                away = (x[i, 0] - 0.3) ^ 2 + (x[i, 1] - 21) ^ 2 + (x[i, 2] + 0.7) ^ 2
                if (away > 3 ^ 2 && d > most) most = d
            } } END { print sqrt(most) }' $name.stl)
        awk -v name=$name -v d="$longest" 'BEGIN { exit name == "t" ? !(d < 1.21) : !(d > 8) }' ||
            fail "the longest edge of $name.stl is $longest mm"
    done
}

test_the_centreline_beside_it_is_the_tree() {
    grown
    run_ok corcast export t.swc -o t.vtp --quiet
    run_ok corcast convert t.centreline.vtp again.swc --quiet
    expect_same <(grep -v '^#' t.swc) <(grep -v '^#' again.swc)
    run_ok corcast export "$REPO/tests/golden/strangers.swc" --part-overlaps -o thin.vtp --quiet
    run_ok corcast convert thin.centreline.vtp thin.swc --quiet
    # The ends of the mesh have the radii of the centreline.
    awk -F '[ ,]' 'NR == FNR { if (!/^#/) radius[$1] = $6; next } FNR > 1 && (d = radius[$3] - $10) * d > 1e-24 { exit 1 }' \
        thin.swc thin.ends.csv || fail "expected the radii of the mesh"
}

test_several_trees_have_inlets_by_their_ids() {
    run_ok corcast grow --terminals 9 --domain ball:41 --inlet 0,41,0 --inlet 0,-41,0 --seed 7 --quiet -o t.swc
    run_ok corcast export t.swc --parts -o t.stl --quiet
    [ "$(grep -cE '^solid inlet_[0-9]{3}$' t.stl) $(grep -cE '^solid outlet_[0-9]{3}$' t.stl)" = "2 9" ] ||
        fail "expected two inlets: $(grep ^solid t.stl)"
}

test_refuses_parts_where_a_format_has_no_names_of_parts() {
    run corcast export "$DATA/bifurcation.swc" --parts -o m.glb
    expect_status 2
    expect_sentence '--parts needs an \.stl, \.vtp, \.msh or \.vtu output'
    expect_only
}

# tests/all/gmsh_test.sh runs gmsh itself.
test_the_geometry_for_gmsh_names_every_surface_and_volume() {
    local n
    grown
    run_ok corcast export t.swc --parts --mesh-tolerance 0.1 -o 'a "b.stl' --quiet
    n=$(grep -c '^solid ' 'a "b.stl')
    expect_same <(sed -n 's/^solid //p' 'a "b.stl' | nl -w1 -s ' ') \
        <(sed -nE 's/^Physical Surface\("(.*)"\) = \{([0-9]+)\};$/\2 \1/p' 'a "b.geo')
    expect_same <(printf '%s\n' "Surface Loop(1) = {$(seq -s ', ' "$n")};" 'Volume(1) = {1};' 'Physical Volume("blood") = {1};') \
        <(tail -3 'a "b.geo')
    [ "$(head -1 'a "b.geo')" = 'Merge "a \"b.stl";' ] || fail "$(head -1 'a "b.geo')"
    run_ok corcast export t.swc --parts --wall 0.3 --part-overlaps --mesh-tolerance 0.1 -o h.stl --quiet
    expect_same <(grep -n '^solid ' h.stl | cat -n | awk '!/_ring$|outer$/ { printf "%s%s", separator, $1; separator = ", " }') \
        <(sed -nE 's/^Surface Loop\(1\) = \{(.*)\};$/\1/p' h.geo | tr -d '\n')
    expect_same <(grep -n '^solid ' h.stl | cat -n | awk '/_ring$|outer$|lumen$/ { printf "%s%s", separator, $1; separator = ", " }') \
        <(sed -nE 's/^Surface Loop\(2\) = \{(.*)\};$/\1/p' h.geo | tr -d '\n')
    run_ok corcast export t.swc -o v.vtp --mesh-tolerance 0.1 --quiet
    [ ! -e v.geo ] || fail "expected no geometry for gmsh beside a VTP"
}

test_extensions_lengthen_ends_along_their_axes() {
    run_ok corcast grow --terminals 7 --domain disc:12 --seed 2 -o t.swc --quiet
    run_ok corcast export t.swc --mesh-tolerance 0.2 -o a.vtp --quiet
    printf 'id,radii\n6,2\n13,0\n' >some.csv
    run_ok corcast export t.swc --mesh-tolerance 0.2 --extend 3 --extend-inlet 5 --extend-outlet some.csv -o b.vtp
    mv stderr entrances
    run_ok corcast convert t.swc t.csv --fields reynolds --quiet
    # The entrance length is 0.06 times the Reynolds number times the diameter, and is printed beside the extension.
    awk -F, 'NR == FNR { for (k = 1; k <= NF; k++) if ($k ~ /reynolds/) c = k; re[$1] = $c; next }
        FNR > 1 { if (($15 / (0.12 * re[$3] * $10) - 1)^2 > 1e-16) exit 1; if ($1 == "inlet") print $15, re[$3], $13 }' \
        <(grep -v '^#' t.csv) b.ends.csv >entrance || fail "entrance lengths: $(cat t.csv b.ends.csv)"
    read -r long re here <entrance
    grep -qF "$(printf 'needs up to %.4g mm to develop at the inlets (segment 2, Reynolds number %.4g); the extension there has %.4g mm' \
        "$long" "$re" "$here")" entrances || fail "$(cat entrances)"
    paste -d, <(sed 1d a.ends.csv) <(sed 1d b.ends.csv) | awk -F, '{
        radii = $3 == 13 ? 0 : $3 == 6 ? 2 : $1 == "inlet" ? 5 : 3
        if ($1 != $13 || $10 != $22 || $12 != $24) exit 1
        for (k = 4; k < 7; k++) if (($(k + 12) - $k - radii * $10 * $(k + 3))^2 > 1e-16) exit 1
        if (($25 - radii * $10)^2 > 1e-16 || (radii > 0) != ($26 > 0)) exit 1
        volume += radii * $10 * $11
    } END { print volume; exit NR != 8 }' >volume || fail "ends: $(cat a.ends.csv b.ends.csv)"
    run_ok corcast convert t.swc t.csv --fields pressure,length --quiet
    awk -F, '/^#|^id/ { next }
        FILENAME == "t.csv" { parent[$1] = $2; mmhg[$1] = $2 < 0 ? 100 : $8; mm[$1] = $9; next }
        FNR > 1 { n++; if (((mmhg[parent[$3]] - mmhg[$3]) / mm[$3] * $13 - $14)^2 > 1e-16) exit 1 }
        END { exit n != 8 }' t.csv b.ends.csv || fail "expected the pressure gradients of the segments: $(cat b.ends.csv)"
    jq -s --argjson more "$(cat volume)" '(.[1].volume_mm3 - .[0].volume_mm3) / $more | . > 0.99 and . < 1.01' \
        a.vtp.json b.vtp.json | grep -qx true || fail "the volumes differ by other than that of the extensions"
    run corcast export t.swc --extend 60 -o c.vtp
    expect_status 2
    expect_sentence 'extension of outlet 6 by 60 radii meets segment 14 .* the longest that fits is 36\.[0-9] radii'
    printf 'id,radii\n4,2\n' >no.csv
    run corcast export t.swc --extend-outlet no.csv -o c.vtp
    expect_status 2
    expect_sentence 'segment 4 is not an outlet'
    run corcast export t.swc --extend -1 -o c.vtp
    expect_status 2
    run corcast export t.swc --extend 2 -o c.glb
    expect_status 2
    expect_sentence 'named parts'
}

# gmsh itself fills the core in tests/all/gmsh_test.sh.
test_layers_of_prisms_fit_the_wall_and_each_other_without_an_inverted_one() {
    run_ok corcast grow --terminals 7 --domain ball:41 --seed 7 -o t.swc --quiet
    run_ok corcast export t.swc --parts --mesh-tolerance 0.1 --extend 2 -o t.stl --quiet
    # Half a radius needs thinner layers in many places.
    run_ok corcast export t.swc --mesh-tolerance 0.1 --extend 2 --layers 2 --layer-thickness 0.5 --layer-growth 1.7 -o t.msh
    grep -qE '[0-9]+ prisms, none of them inverted' stderr || fail "it does not say so: $(cat stderr)"
    expect_json t.msh.json '.layers | .layers == 2 and .inverted == 0 and .points_thinner > 50 and .mean_thickness > 0.8 and .least_thickness > 0.01'
    run /usr/bin/python3 "$REPO/tests/oracle/prisms.py" t.msh t.msh.json t.ends.csv t.stl
    expect_status 0
    run_ok corcast export t.swc --mesh-tolerance 0.1 --extend 2 --layers 2 --layer-thickness 0.5 --layer-growth 1.7 --threads 3 -o same.msh --quiet
    expect_same <(sed 5,6d t.msh) <(sed 5,6d same.msh)
    # The second layer is 1.7 times as thick as the first one where a point is between them.
    awk '/^\$Elements/ { e = 1 } $2 == "" { next } !e && NF == 4 { for (k = 0; k < 3; k++) x[$1, k] = $(k + 2) }
        e && $2 == 6 { for (k = 6; k < 9; k++) outer[$k] = $(k + 3) }
        END { for (i in outer) if (outer[i] in outer) {
            n++
            for (k = 0; k < 3; k++) d = x[i, k] - x[outer[i], k] - 1.7 * (x[outer[i], k] - x[outer[outer[i]], k])
            if (d ^ 2 > 1e-10) exit 1
        } exit n < 300 }' t.msh || fail "expected layers of the ratio 1.7"
}

test_vtk_reads_layers_of_prisms_as_wedges_of_its_own_orientation() {
    /usr/bin/python3 -c 'import vtk' 2>import.log || skip "python3-vtk9 is not installed"
    run_ok corcast grow --terminals 3 --domain ball:41 --seed 7 -o t.swc --quiet
    run_ok corcast export t.swc --mesh-tolerance 0.1 -o t.vtu --quiet
    run_ok corcast export t.swc --mesh-tolerance 0.1 -o t.msh --quiet
    /usr/bin/python3 - >said <<'END' || fail "$(cat said)"
import json, sys
import numpy as np, vtk
from vtk.util.numpy_support import vtk_to_numpy
reader = vtk.vtkXMLUnstructuredGridReader()
reader.SetFileName("t.vtu")
reader.Update()
grid = reader.GetOutput()
layers = json.load(open("t.vtu.json"))["layers"]
def expect(what, is_so):
    if not is_so:
        sys.exit(print("VTK:", what) or 1)
types = np.array([grid.GetCellType(i) for i in range(grid.GetNumberOfCells())])
names = grid.GetFieldData().GetAbstractArray("FaceNames")
faces, layer = (vtk_to_numpy(grid.GetCellData().GetArray(name)) for name in ("ModelFaceID", "layer"))
expect("names", [names.GetValue(i) for i in range(names.GetNumberOfValues())][:2] == ["wall", "inlet"])
expect("wedges", (types == vtk.VTK_WEDGE).sum() == layers["prisms"])
expect("parts", set(faces[types == vtk.VTK_WEDGE]) == {0} and set(faces[types == vtk.VTK_QUAD]) == {2, 3, 4, 5})
expect("inner surface", set(faces[types == vtk.VTK_TRIANGLE]) == {1, 2, 3, 4, 5, 6})
expect("layers", set(layer[types == vtk.VTK_WEDGE]) == {1, 2, 3} and set(layer[types == vtk.VTK_TRIANGLE]) == {0})
corners = lambda at: [at.GetPointId(k) + 1 for k in range(6)]
wedges = [corners(grid.GetCell(i)) for i in np.flatnonzero(types == vtk.VTK_WEDGE)]
prisms = [[int(x) for x in line.split()[5:]] for line in open("t.msh") if line.split()[1:2] == ["6"] and len(line.split()) == 11]
expect("corners", wedges == [p[3:] + p[:3] for p in prisms])
x = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
a, b, c, d = (x[np.array(wedges)[:, k] - 1] for k in range(4))
expect("orientation", (np.einsum("ij,ij->i", np.cross(b - a, c - a), a - d) > 0).all())
END
}

test_refuses_layers_where_there_are_none() {
    run corcast export "$DATA/bifurcation.swc" --layers 4 -o m.vtp
    expect_status 2
    expect_sentence '--layers is for layers of prisms: a \.msh or \.vtu'
    run corcast export "$DATA/bifurcation.swc" --layer-thickness 0.7 -o m.msh
    expect_status 2
    run corcast export "$DATA/bifurcation.swc" --wall 0.3 -o m.msh
    expect_status 2
    expect_sentence '--wall cannot be combined with layers of prisms \(\.msh and \.vtu\); write an \.stl or \.vtp'
    expect_only
}

test_centrelines_have_the_arrays_of_simvascular() {
    printf '%s\n' '1 3 0 0 0 1 -1' '2 3 3 0 0 0.5 1' '3 3 4 1 0 0.4 2' '4 3 4 -1 0 0.3 2' >t.swc
    run_ok corcast convert t.swc t.csv --step 1 --centreline-arrays --quiet
    sed -n 1p t.csv | tr -d '"' | grep -q 'MaximumInscribedSphereRadius,CenterlineSectionArea,BranchId,BifurcationId,Path,GlobalNodeId' ||
        fail "header: $(head -1 t.csv)"
    [ "$(sed 1d t.csv | cut -d, -f10-13 | tr '\n' ' ')" = '0,-1,0,0 0,-1,1,1 0,-1,2,2 0,-1,3,3 1,-1,1.4142135623730951,4 2,-1,1.4142135623730951,5 ' ] ||
        fail "arrays: $(cat t.csv)"
}

run_tests "$@"
