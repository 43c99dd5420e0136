#!/usr/bin/env bash
# Files that `export` writes for solvers, filled with tetrahedra by gmsh.
. "$(dirname "$0")/../lib.sh"

# gmsh makes a surface of each solid, in the order of the file, keeps its triangles, and uses the
# names in t.geo.
test_gmsh_fills_the_parts_of_an_stl_with_tetrahedra() {
    command -v gmsh >/dev/null || skip "gmsh is not installed"
    run_ok corcast grow --terminals 9 --domain ball:41 --seed 7 -o t.swc --quiet
    run_ok corcast export t.swc --parts --mesh-tolerance 0.05 -o t.stl --quiet
    run_ok timeout 300 gmsh -3 -format msh2 t.geo -o t.msh
    /usr/bin/python3 - >said <<'END' || fail "$(cat said)"
import csv, json, sys
import numpy as np
def expect(what, is_so):
    if not is_so:
        sys.exit(print("gmsh:", what) or 1)
lines = open("t.msh").read().split("\n")
at = lines.index("$Nodes") + 2
points = {int(w[0]): [float(x) for x in w[1:]] for w in map(str.split, lines[at:lines.index("$EndNodes")])}
at = lines.index("$Elements") + 2
elements = [[int(x) for x in line.split()] for line in lines[at:lines.index("$EndElements")]]
def corners(kind, n):
    rows = [e for e in elements if e[1] == kind]
    return np.array([e[4] for e in rows]), np.array([[points[i] for i in e[-n:]] for e in rows])
manifest, ends = json.load(open("t.stl.json")), list(csv.DictReader(open("t.ends.csv")))
surface, x = corners(2, 3)
expect("triangles", len(x) == manifest["triangles"])
expect("surfaces", sorted(set(surface)) == list(range(1, len(ends) + 2)))
areas = np.linalg.norm(np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]), axis=1) / 2
for end in ends:
    expect("area of " + end["name"], abs(areas[surface == int(end["face"])].sum() / float(end["area_mm2"]) - 1) < 1e-5)
at = lines.index("$PhysicalNames") + 2
named = {int(w[1]): (int(w[0]), w[2].strip('"')) for w in map(str.split, lines[at:lines.index("$EndPhysicalNames")])}
expect("names of surfaces", [named[k + 1] for k in range(len(ends) + 1)] == [(2, n) for n in ["wall"] + [end["name"] for end in ends]])
expect("name of the volume", [n for dimension, n in named.values() if dimension == 3] == ["blood"])
_, x = corners(4, 4)
expect("tetrahedra", len(x) > 3000)
volumes = np.einsum("ij,ij->i", x[:, 1] - x[:, 0], np.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 0])) / 6
expect("a tetrahedron that is inside out", min(volumes) > 0 or max(volumes) < 0)
expect("volume", abs(abs(volumes.sum()) / manifest["volume_mm3"] - 1) < 1e-5)
END
}

# The tetrahedra of gmsh share the faces of the prisms, in each tree.
test_gmsh_fills_the_core_of_layers_of_prisms() {
    command -v gmsh >/dev/null || skip "gmsh is not installed"
    run_ok corcast grow --terminals 8 --inlet 0,40 --inlet 0,-40 --domain disc:41 --seed 3 -o t.swc --quiet
    run_ok corcast export t.swc --parts --mesh-tolerance 0.1 --tube-edge 2 -o t.stl --quiet
    run_ok corcast export t.swc --mesh-tolerance 0.1 --tube-edge 2 -o t.msh --quiet
    run_ok timeout 300 gmsh -3 -format msh2 t.core.geo -o all.msh
    run_ok /usr/bin/python3 "$REPO/tests/oracle/prisms.py" all.msh t.msh.json t.ends.csv t.stl
    grep -qE '^[0-9]+ prisms, [0-9]{4,} tetrahedra' stdout || fail "$(cat stdout)"
}

run_tests "$@"
