#!/usr/bin/env bash
# Every field of every file that corcast writes for other programs. Readers that share no code with
# corcast read the fields and compare them with the tree [tests/oracle/foreign_fields.py]. The tree
# has no symmetry and lies far from the origin, so that no wrong field has the value of the right
# one.
. "$(dirname "$0")/../lib.sh"

/usr/bin/python3 -c 'import numpy' 2>/dev/null || {
    echo "python3-numpy is not installed: run make deps" >&2
    exit 3
}

fields() {
    /usr/bin/python3 "$REPO/tests/oracle/foreign_fields.py" "$@"
}

# reads FORMAT FILE...: the independent reader of FORMAT finds the right fields in the files.
reads() {
    fields "$@" >said 2>&1 || fail "$1: $(tail -1 said)"
}

COLORED=(--input-unit mm --quiet --color-by load.csv:load --classes 2 --no-data '#1AE64C')

# exported FILE OPTION...: exports tree.csv with the options to FILE.
exported() {
    local file=$1
    shift
    run_ok corcast export tree.csv --quiet --input-unit mm "$@" -o "$file"
}

test_every_field_of_colored_meshes() {
    local extension
    fields tree .
    for extension in ply obj 3mf inc; do
        run_ok corcast export tree.csv "${COLORED[@]}" --tube-edge 1 -o "x.$extension"
    done
    reads ply x.ply
    reads obj x.obj x.ply
    reads 3mf x.3mf x.ply
    reads mesh2 x.inc x.ply
}

test_every_field_of_a_glb() {
    fields tree .
    sed 's/^phong_size = .*//; s/^\[finish\]/[finish]\nphong_size = 17/; /^.vessel/,/^$/s/^color = .*/color = 0.5 0.25 0.125/' "$REPO/templates/looks/cast.ini" >own.ini
    grep -q '^color = 0.5 0.25 0.125' own.ini || fail "expected the look's color: $(cat own.ini)"
    run_ok corcast export tree.csv "${COLORED[@]}" --tube-edge 1 --look ./own.ini -o x.glb
    reads glb x.glb 17
    exported plain.glb --tube-edge 1 --look ./own.ini
    reads glb-plain plain.glb 17 0.5 0.25 0.125
}

test_every_field_of_curves_and_beams() {
    fields tree .
    sed 's/^phong_size = .*//; s/^\[finish\]/[finish]\nphong_size = 17/' "$REPO/templates/looks/cast.ini" >own.ini
    run_ok corcast export tree.csv "${COLORED[@]}" --look ./own.ini -o x.py
    reads py x.py 17
    run_ok corcast export tree.csv "${COLORED[@]}" -o x.usda
    reads usda x.usda
    run_ok corcast export tree.csv "${COLORED[@]}" --lattice -o x.3mf
    reads lattice x.3mf
}

test_every_field_of_triangles_and_named_parts() {
    fields tree .
    exported x.stl
    reads stl x.stl
    exported p.stl --parts
    reads parts p.stl
    reads ends p.ends.csv
    /usr/bin/python3 -c 'import vtkmodules' 2>/dev/null || skip "python3-vtk9 is not installed"
    exported x.vtp
    reads vtp x.vtp
}

test_every_field_of_volumes() {
    local extension
    /usr/bin/python3 -c 'import nibabel' 2>/dev/null || skip "python3-nibabel is not installed"
    fields tree .
    exported v.nii.gz --spacing 0.5,0.75,0.625 --labels segment
    for extension in nrrd mha df3; do
        exported "v.$extension" --spacing 0.5,0.75,0.625
    done
    reads volumes v v.nii.gz.json
}

test_every_field_of_a_page() {
    fields tree .
    exported x.html --color-by load.csv:load --log --range 2,9 --colormap magma
    reads html x.html
}

test_every_field_of_an_openscad_model() {
    command -v openscad >/dev/null || skip "openscad is not installed"
    fields tree .
    run_ok corcast scene tree.csv "${COLORED[@]}" --model rounded -o x.scad
    run_ok timeout 300 openscad -q -o x.csg x.scad
    reads csg x.csg x.scad
}

# No other test would detect an error of 1 % in the ground, the lights or the texts.
test_every_field_of_a_tachyon_scene() {
    fields tree .
    cat >own.ini <<'INI'
[vessel]
color = 0.5 0.25 0.125
[background]
color = 0.25 0.5 0.75
[finish]
ambient = 0.2
diffuse = 0.6
phong = 0.3
phong_size = 17
[ground]
normal = 0.1 0.2 1
gap = 0.3
color = 0.4 0.6 0.8
ambient = 0.15
diffuse = 0.55
[light key]
direction = -0.22 0.3 1
color = 0.9 0.8 0.7
[light point]
position = 3 2 5
color = 0.3 0.4 0.5
INI
    run_ok corcast scene tree.csv "${COLORED[@]}" --model rounded --look ./own.ini --antialias 2 --size 61x43 -o s.tachyon
    reads tachyon s.tachyon
}

run_tests "$@"
