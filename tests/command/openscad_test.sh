#!/usr/bin/env bash
# `scene` for OpenSCAD. OpenSCAD makes solids from the written files, admesh checks that they are
# closed, and their volume and outline are compared with corcast's: a third witness of the geometry.
# Each test takes seconds, because CGAL does.
. "$(dirname "$0")/../lib.sh"

# Writes fork.swc, a bifurcation that is not planar, and its scene fork.scad.
fork() {
    cat >fork.swc <<'END'
1 1 0 14.2 0.5 2.385 -1
2 1 1.7 3.1 -0.8 2.385 1
3 1 -7.9 -8.3 2.1 1.93 2
4 1 9.6 -6.2 -3.7 1.71 2
END
    run_ok corcast scene fork.swc -o fork.scad
}

# Writes vessel.swc, a single vessel, and its scene vessel.scad.
vessel() {
    printf '1 1 0 14.2 0.5 2.385 -1\n2 1 1.7 3.1 -0.8 2.385 1\n' >vessel.swc
    run_ok corcast scene vessel.swc "$@" -o vessel.scad
}

# scad OUTPUT INPUT NAME=VALUE...: runs OpenSCAD with the variables set.
scad() {
    local output=$1 input=$2 set=()
    command -v openscad >/dev/null || skip "openscad is not installed"
    shift 2
    for value; do
        set+=(-D "$value")
    done
    run_ok timeout 300 openscad -q -o "$output" "${set[@]}" "$input"
    expect_file "$output"
    [ ! -s stderr ] || fail "expected no word of OpenSCAD$(said)"
}

# volume FILE.stl: prints the volume. admesh must find one closed part without faults.
volume() {
    command -v admesh >/dev/null || skip "admesh is not installed"
    admesh "$1" >admesh.txt || fail "admesh failed"
    grep -q 'Total disconnected facets *: *0 *0' admesh.txt || fail "expected $1 to be closed: $(cat admesh.txt)"
    grep -qE 'Number of parts *: *1 ' admesh.txt || fail "expected $1 to be one part"
    sed -n 's/.*Volume *: *\([0-9.]*\)$/\1/p' admesh.txt
}

# euler FILE.stl: prints the Euler characteristic: vertices - edges + facets.
euler() {
    awk '$1 == "vertex" { if (!seen[$2, $3, $4]++) v++; n++ } END { print v - n / 3 / 2 }' "$1"
}

# within SHARE A B: A equals B to within the fraction SHARE.
within() {
    awk -v share="$1" -v a="$2" -v b="$3" 'BEGIN { exit !(a > 0 && (a - b) ^ 2 <= (share * b) ^ 2) }' ||
        fail "expected $2 to be $3 to within a share of $1"
}

test_a_vessel_is_the_prism_that_it_says() {
    vessel --model cylinders
    scad vessel.stl vessel.scad '$fn=8'
    # n / 2 sin(2 pi / n) r^2 l
    within 1e-5 "$(volume vessel.stl)" \
        "$(awk 'BEGIN { print 4 * sin(atan2(1, 1)) * 2.385 ^ 2 * sqrt(1.7 ^ 2 + 11.1 ^ 2 + 1.3 ^ 2) }')"
}

# The volume that n sides lose is proportional to 1 / n^2, so two values of n give the exact volume
# by extrapolation. The mesh of the same model is a third value.
test_the_volume_of_a_bifurcation_is_the_integral_over_its_vessels() {
    /usr/bin/python3 -c 'import numpy' 2>import.log || skip "python3-numpy is not installed"
    fork
    scad fork8.stl fork.scad '$fn=8'
    scad fork12.stl fork.scad '$fn=12'
    /usr/bin/python3 - >integral <<'END' || fail "the integral failed: $(cat integral)"
import numpy as np
rows = [line.split() for line in open("fork.swc")]
place = {row[0]: np.array([float(x) for x in row[2:5]]) for row in rows}
tubes = [(place[row[6]], place[row[0]], float(row[5])) for row in rows if row[6] != "-1"]
low = np.min([np.minimum(a, b) - r for a, b, r in tubes], 0)
step = (np.max([np.maximum(a, b) + r for a, b, r in tubes], 0) - low) / 128
grid = [low[i] + (np.arange(128) + 0.5) * step[i] for i in range(3)]
x, y = np.meshgrid(grid[0], grid[1], indexing="ij")
inside = 0
for z in grid[2]:
    any_tube = np.zeros(x.shape, bool)
    for a, b, r in tubes:
        d = b - a
        t = np.clip(((x - a[0]) * d[0] + (y - a[1]) * d[1] + (z - a[2]) * d[2]) / d.dot(d), 0, 1)
        any_tube |= (x - a[0] - t * d[0])**2 + (y - a[1] - t * d[1])**2 + (z - a[2] - t * d[2])**2 < r * r
    inside += any_tube.sum()
print(inside * step.prod())
END
    within 0.005 "$(awk -v v8="$(volume fork8.stl)" -v v12="$(volume fork12.stl)" \
        'BEGIN { print (144 * v12 - 64 * v8) / 80 }')" "$(cat integral)"
    run_ok corcast export fork.swc --model rounded --mesh-tolerance 0.01 -o rounded.stl --quiet
    within 0.005 "$(volume rounded.stl)" "$(cat integral)"
}

# The solid passes through CGAL, which cuts it far behind the tree. The expected volume integrates
# the field of docs/METHODS.md, sections 2 and 2.7, on a grid. Vessels continue beyond free ends and
# are cut flat there.
test_the_volume_of_a_closed_surface_is_the_integral_of_the_potential() {
    /usr/bin/python3 -c 'import scipy' 2>import.log || skip "python3-scipy is not installed"
    fork
    run_ok corcast scene fork.swc --scad polyhedron -o surface.scad
    scad surface.stl surface.scad 'part="half"' cut=100
    /usr/bin/python3 - >integral <<'END' || fail "the integral failed: $(cat integral)"
import numpy as np
from scipy.special import erf
rows = [line.split() for line in open("fork.swc")]
place = {row[0]: np.array([float(x) for x in row[2:5]]) for row in rows}
joint = place["2"]
tubes = []
for row in rows[1:]:
    end = place[row[0]] if row[6] == "2" else place["1"]
    tubes.append((end, (end - joint) / np.linalg.norm(end - joint), float(row[5])))
n = 192
low = np.min([a - r for a, _, r in tubes], 0)
step = (np.max([a + r for a, _, r in tubes], 0) - low) / n
grid = [low[i] + (np.arange(n) + 0.5) * step[i] for i in range(3)]
x, y = np.meshgrid(grid[0], grid[1], indexing="ij")
inside = 0
for z in grid[2]:
    phi, cut = 0, False
    for end, d, r in tubes:
        k = 2**0.5 / r
        t = (x - joint[0]) * d[0] + (y - joint[1]) * d[1] + (z - joint[2]) * d[2]
        length = np.linalg.norm(end - joint)
        e2 = (x - joint[0])**2 + (y - joint[1])**2 + (z - joint[2])**2 - t * t
        phi = phi + np.exp(-k * k * e2) * (erf(k * (length + 2.2 * r - t)) + erf(k * t)) / 2
        cut = cut | ((t > length) & (e2 < 4 * r * r))
    inside += ((phi > np.exp(-2)) & ~cut).sum()
print(inside * step.prod())
END
    within 0.005 "$(volume surface.stl)" "$(cat integral)"
}

# 20 pixels per mm. 16 sides cut off up to 3.9 % of a radius, 1.9 pixels, and each program may miss
# an edge by one pixel.
test_the_outline_is_the_silhouette_that_render_draws() {
    /usr/bin/python3 -c 'import skimage' 2>import.log || skip "python3-skimage is not installed"
    fork
    scad fork.svg fork.scad 'part="outline"' '$fn=16'
    run_ok corcast render --exact fork.swc --location 0,0,100 --look-at 0,0,0 --height 40 --size 800x800 --planes id -o ours.ppm
    /usr/bin/python3 - >silhouette <<'END' || fail "the silhouettes differ: $(cat silhouette)"
import re, sys
import numpy as np
from skimage.draw import polygon
from skimage.io import imread
from skimage.morphology import binary_dilation, binary_erosion, disk
ours = imread("ours.id.ppm").reshape(800, 800, 3).any(axis=2)
theirs = np.zeros((800, 800), bool)
for part in re.search(r'<path d="([^"]*)"', open("fork.svg").read()).group(1).split("z"):
    points = np.array([[float(x) for x in pair.split(",")] for pair in re.findall(r"[-0-9.e]+,[-0-9.e]+", part)])
    if len(points):
        rows, columns = polygon(points[:, 1] * 20 + 399.5, points[:, 0] * 20 + 399.5, (800, 800))
        theirs[rows, columns] ^= True
beyond = theirs & ~binary_dilation(ours, disk(1))
short = binary_erosion(ours, disk(3)) & ~theirs
print("pixels of ours", ours.sum(), "of theirs", theirs.sum(), "beyond", beyond.sum(), "short", short.sum())
like = abs(int(ours.sum()) - int(theirs.sum())) <= 0.02 * ours.sum()
sys.exit(0 if like and ours.sum() > 1000 and not beyond.any() and not short.any() else 1)
END
}

test_a_wall_is_a_tube_and_with_closed_ends_a_shell() {
    vessel
    scad open.stl vessel.scad 'part="wall"' wall=0.7 '$fn=6'
    scad closed.stl vessel.scad 'part="wall"' wall=0.7 open_ends=false '$fn=6'
    [ "$(euler open.stl)" = 0 ] || fail "expected one hole through the wall: $(euler open.stl)"
    [ "$(euler closed.stl)" = 4 ] || fail "expected an outside and an inside: $(euler closed.stl)"
}

test_the_customizer_chooses_parts_radii_and_vessels() {
    fork
    scad all.csg fork.scad
    scad joints.csg fork.scad 'part="bifurcations"'
    scad thick.csg fork.scad min_radius=1.8 radius_scale=1.5
    scad block.csg fork.scad 'part="block"' margin=2.5
    [ "$(grep -c 'cylinder(' all.csg) $(grep -c 'sphere(' all.csg)" = "3 4" ] || fail "expected 3 vessels and 4 balls"
    [ "$(grep -c 'cylinder(' joints.csg) $(grep -c 'sphere(' joints.csg)" = "0 4" ] || fail "expected balls alone"
    [ "$(grep -c 'cylinder(' thick.csg)" = 2 ] || fail "expected two vessels above 1.8 mm"
    grep -q 'r1 = 3.5775, r2 = 3.5775' thick.csg || fail "expected a radius of 1.5 x 2.385"
    grep -q 'cube(' block.csg || fail "expected a block"
}

# The polyhedron is written directly, and through CGAL, which refuses solids that are open or inside
# out.
test_a_polyhedron_is_the_mesh_that_export_writes() {
    cp "$DATA/bifurcation.swc" .
    run_ok corcast scene bifurcation.swc --scad polyhedron -o surface.scad --quiet
    run_ok corcast export bifurcation.swc -o mesh.stl --quiet
    scad surface.stl surface.scad
    scad cut.stl surface.scad 'part="half"' cut=100
    scad half.stl surface.scad 'part="half"' cut=0
    within 1e-5 "$(volume surface.stl)" "$(volume mesh.stl)"
    within 1e-5 "$(volume cut.stl)" "$(volume mesh.stl)"
    within 1e-3 "$(volume half.stl)" "$(awk -v v="$(volume mesh.stl)" 'BEGIN { print v / 2 }')"
}

test_each_place_is_called_what_it_is() {
    fork
    sed -i '$a5 1 12.1 -9.4 -3.1 1.71 4' fork.swc
    run_ok corcast scene fork.swc -o fork.scad
    [ "$(grep -cE '^  (vessel|bifurcation|bend|end)\(' fork.scad)" = 9 ] || fail "expected 4 vessels and 5 places"
    grep -q '^  bifurcation(p2,max(r2,r3,r4));' fork.scad || fail "expected the bifurcation at node 2"
    grep -q '^  bend(p4,max(r4,r5));' fork.scad || fail "expected the bend at node 4: $(grep 'bend(p' fork.scad)"
    [ "$(grep -c '^  end(' fork.scad)" = 3 ] || fail "expected three ends"
}

# A node is written once, so its vessel, joint and open end move with it.
test_a_moved_tip_takes_all_of_it_along() {
    fork
    sed 's/^4 1 .*/4 1 13.1 -2.2 4.9 1.2 2/' fork.swc >other.swc
    run_ok corcast scene other.swc -o other.scad
    [ "$(grep -c '9.6,-6.2,-3.7' fork.scad)" = 1 ] || fail "expected node 4 to be written once"
    sed -e 's/^p4 = .*/p4 = [13.1,-2.2,4.9];/' -e 's/^r4 = .*/r4 = 1.2;/' fork.scad >moved.scad
    local part
    for part in tree wall block; do
        scad moved.stl moved.scad "part=\"$part\""
        scad other.stl other.scad "part=\"$part\""
        # OpenSCAD writes coordinates with six digits.
        within 1e-6 "$(volume moved.stl)" "$(volume other.stl)"
    done
}

test_vessels_have_the_colors_that_are_asked_for() {
    fork
    run_ok corcast scene fork.swc --color-by length -o colored.scad
    scad colored.csg colored.scad
    [ "$(grep -o 'color(\[[^]]*' colored.csg | sort -u | wc -l)" = 3 ] || fail "expected three colors"
}

test_the_commands_of_the_page_run() {
    local line
    cp "$DATA/bifurcation.swc" .
    while read -r line; do
        case $line in
        xvfb-run*) command -v xvfb-run >/dev/null || continue ;;
        openscad*) command -v openscad >/dev/null || skip "openscad is not installed" ;;
        esac
        run_ok timeout 300 bash -c "$(sed "s|build/corcast|'$CORCAST'|; s|tests/data/||; s/fn=24/fn=5/; s/scad *#.*/scad/" <<<"$line")"
    done < <(sed -n ':a; /\\$/{N; s/\\\n *//; ba}; s/^    \(build\/corcast\|openscad\|xvfb-run\|sed\)/\1/p' "$REPO/docs/OPENSCAD.md")
    volume tree.stl
    expect_file outline.svg
}

test_names_stay_in_their_comments() {
    fork
    cp fork.swc $'a\ncube(9);.swc'
    run_ok corcast scene $'a\ncube(9);.swc' -o $'b\ncube(8); ${file} $fn.scad'
    mv $'b\ncube(8); ${file} $fn.scad' b.scad
    scad b.csg b.scad
    ! grep -q 'cube(' b.csg || fail "expected no cube"
}

test_what_a_solid_cannot_have_is_refused() {
    fork
    run corcast scene fork.swc --size 320x240 -o x.scad
    expect_status 2
    expect_sentence '--size is for scenes with a camera'
    run corcast scene fork.swc --model blob -o x.scad
    expect_status 2
    expect_sentence '--model blob: .*holds cylinders and rounded'
    run corcast scene fork.swc --scad polyhedron --model blob -o x.scad
    expect_status 2
    expect_sentence '--model is for separate vessels'
    run corcast scene fork.swc --scad parametric -o x.pov
    expect_status 2
    expect_sentence '--scad is for models of OpenSCAD'
    run corcast scene fork.swc -o x.stl
    expect_status 2
    expect_sentence "'x.stl' does not end in .pov, .scad or .tachyon"
    [ ! -e x.scad ] || fail "expected no file"
}

test_a_model_of_many_vessels_is_one_closed_surface_unless_modules_are_asked_for() {
    grow_tree 52
    run_ok corcast scene tree.swc -o tree.scad
    grep -q '^corcast: OpenSCAD would take too long to join 103 vessels (limit 100), so tree.scad is one closed surface; use --scad parametric' stderr ||
        fail "expected the choice to be said$(said)"
    grep -q '^// One closed surface' tree.scad || fail "expected the header to say so: $(head -4 tree.scad)"
    expect_json tree.scad.json '.watertight and .genus == 0 and .segments == 103'
    scad tree.stl tree.scad
    within 1e-5 "$(volume tree.stl)" "$(jq .volume_mm3 tree.scad.json)"
    run_ok corcast scene tree.swc -o small.scad --prune-radius 0.6
    grep -q '^  vessel(' small.scad || fail "expected modules of fewer vessels"
    run_ok corcast scene - -o read.scad --quiet <tree.swc
    [ ! -s stderr ] || fail "expected no word$(said)"
    diff <(grep -v '^//' tree.scad) <(grep -v '^//' read.scad) || fail "expected the same surface of a tree on standard input"
    for how in '--scad parametric' '--model cylinders' '--color-by radius'; do
        # shellcheck disable=SC2086
        run_ok corcast scene tree.swc $how -o modules.scad
        grep -qE 'OpenSCAD needs about [0-9.e+]+ s to join 103 vessels to a solid' stderr ||
            fail "expected to hear of OpenSCAD's time$(said)"
        grep -q '^  vessel(' modules.scad || fail "expected modules of $how"
    done
}

# The mesh is that of the model `mesh`.
test_the_model_mesh_is_one_closed_surface() {
    cp "$DATA/bifurcation.swc" .
    run_ok corcast scene bifurcation.swc --quiet --model mesh --mesh-tolerance 0.1 -o mesh.scad
    run_ok corcast scene bifurcation.swc --quiet --scad polyhedron --mesh-tolerance 0.1 -o form.scad
    diff <(grep -v '^//' mesh.scad) <(grep -v '^//' form.scad) || fail "expected the same surface"
    run corcast scene bifurcation.swc --scad parametric --model mesh -o none.scad
    expect_status 2
    expect_sentence '--model mesh: .*holds cylinders and rounded'
}

run_tests "$@"
