#!/usr/bin/env bash
# `export` to volumes: the filled fraction of each voxel, labels, centrelines. Independent programs
# read the volumes.
. "$(dirname "$0")/../lib.sh"

# python: runs the program on standard input with numpy, nibabel and the function volume(name),
# which returns a volume as an array indexed by x, y, z, and the sides of a voxel in mm.
python() {
    /usr/bin/python3 -c 'import nibabel, numpy' 2>python.error || skip "python3-nibabel is not installed"
    {
        cat <<'END'
import nibabel, numpy
def volume(name):
    image = nibabel.load(name)
    return numpy.asarray(image.dataobj), image.header.get_zooms()
END
        cat
    } >script.py
    /usr/bin/python3 script.py >said 2>&1 || fail "python: $(tail -3 said | tr '\n' ' ')"
}

# grown: grows a tree of 23 terminals.
grown() {
    run_ok corcast grow --terminals 23 --domain ball:41 --seed 7 -o t.swc --quiet
}

test_a_vessel_with_round_ends_has_its_volume() {
    local voxel depth
    printf '1 3 0.13 -0.4 7.1 1.385 -1\n2 3 9.71 3.2 2.9 1.385 1\n' >one.swc
    for voxel in 0.21 1.9 0.3,0.7,0.2; do
        for depth in 8 16 float; do
            run_ok corcast export one.swc -o one.nii.gz --spacing $voxel --depth $depth --quiet
            jq '[.volume_mm3, .union_mm3] | @tsv' -r one.nii.gz.json | awk -v depth=$depth '{
                r = 1.385; pi = atan2(0, -1)
                volume = pi * r^2 * sqrt(9.58^2 + 3.6^2 + 4.2^2) + 4 / 3 * pi * r^3
                off = depth == 8 ? 1e-3 : 3e-4
                exit ($1 / volume - 1)^2 > off^2 || ($2 / volume - 1)^2 > 3e-4^2 }' ||
                fail "volume at $voxel, $depth: $(jq -c . one.nii.gz.json)"
        done
    done
}

test_the_voxels_of_a_tree_have_the_volume_of_the_union() {
    grown
    run_ok corcast export t.swc -o t.nii.gz --spacing 0.4 --quiet
    /usr/bin/python3 -c 'import numpy' 2>python.error || skip "python3-numpy is not installed"
    run_ok "$REPO/tests/oracle/tree_volume.py" t.swc 0.05
    jq --argjson volume "$(cat stdout)" '.volume_mm3 / $volume, .union_mm3 / $volume' t.nii.gz.json | tr '\n' ' ' >both
    awk '{ exit !($1 > 0.999 && $1 < 1.001 && $2 > 0.9999 && $2 < 1.0001) }' both || fail "volume over that of lines: $(cat both)"
    python <<'END'
import json
said = json.load(open("t.nii.gz.json"))
image = nibabel.load("t.nii.gz")
voxels, sides = volume("t.nii.gz")
assert image.get_data_dtype() == numpy.uint8 and list(voxels.shape) == said["voxels"], image.header
for form, code in (image.get_sform(True), image.get_qform(True)):
    assert code == 1 and numpy.allclose(form[:3, :3], 0.4 * numpy.eye(3)), form
    assert numpy.allclose(form[:3, 3], said["first_voxel_mm"]), form
assert abs(image.get_fdata().sum() * 0.4 ** 3 / said["volume_mm3"] - 1) < 1e-6
# Voxels are filled where the tree is: the voxels with the largest fractions are on its axes.
points = numpy.array([[float(x) for x in line.split()[2:5]] for line in open("t.swc") if line[0] != "#"])
at = numpy.rint((points - said["first_voxel_mm"]) / 0.4).astype(int)
assert (voxels[tuple(at.T)] > 0.4).mean() > 0.9
END
}

test_other_readers_see_the_same_voxels_at_the_same_place() {
    grown
    run_ok corcast export t.swc -o t.nii.gz --spacing 0.9 --depth 16 --quiet
    run_ok corcast export t.swc -o t.nii --spacing 0.9 --depth 16 --quiet
    run_ok corcast export t.swc -o t.nrrd --spacing 0.9 --depth 16 --quiet
    run_ok corcast export t.swc -o t.mha --spacing 0.9 --depth 16 --quiet
    gzip -t t.nii.gz || fail "gzip finds t.nii.gz broken"
    gzip -dc t.nii.gz >plain.nii
    expect_same plain.nii t.nii
    tail -c $(($(jq '.voxels | .[0] * .[1] * .[2] * 2' t.mha.json))) t.mha >meta.raw
    tail -c +353 t.nii >nifti.raw
    expect_same meta.raw nifti.raw
    python <<'END'
import vtkmodules.vtkIOImage as io, json
from vtkmodules.util.numpy_support import vtk_to_numpy
said = json.load(open("t.nii.gz.json"))
voxels, sides = volume("t.nii.gz")
stored = numpy.rint(voxels * 65535)
for reader, name in (io.vtkNIFTIImageReader(), "t.nii.gz"), (io.vtkNrrdReader(), "t.nrrd"):
    reader.SetFileName(name)
    reader.Update()
    data = reader.GetOutput()
    assert list(data.GetDimensions()) == said["voxels"], (name, data.GetDimensions())
    assert numpy.allclose(data.GetSpacing(), 0.9), (name, data.GetSpacing())
    if name == "t.nrrd":
        assert numpy.allclose(data.GetOrigin(), said["first_voxel_mm"]), (name, data.GetOrigin())
    array = vtk_to_numpy(data.GetPointData().GetScalars()).reshape(voxels.shape[::-1]).T
    assert (numpy.rint(array) == stored).all(), name
END
    run_ok corcast grow --domain mask:t.nii.gz --terminals 5 -o in.swc --quiet
}

test_vessels_thinner_than_a_voxel_do_not_break_up() {
    grown
    awk '!/^#/ { $6 *= 0.01 } 1' t.swc >thin.swc
    run_ok corcast export thin.swc -o v.nii.gz --spacing 0.8 --labels segment --centreline c.nii.gz
    grep -qE 'rounded to 8 bits, voxels hold .* more than the vessels' stderr || fail "expected a word on the rounding: $(cat stderr)"
    run_ok corcast export thin.swc -o w.nii.gz --spacing 0.8 --depth float --quiet
    expect_json w.nii.gz.json '(.volume_mm3 / .union_mm3 - 1) * 1e6 | . > -1 and . < 1'
    python <<'END'
v, c = volume("v.nii.gz")[0], volume("c.nii.gz")[0]
assert c.max() == 1 and (v[c > 0] > 0).all()
# The filled voxels are one connected component, with connection through faces.
left, todo = set(map(tuple, numpy.argwhere(c > 0))), []
assert len(left) > 300
todo.append(left.pop())
while todo:
    x, y, z = todo.pop()
    for near in (x - 1, y, z), (x + 1, y, z), (x, y - 1, z), (x, y + 1, z), (x, y, z - 1), (x, y, z + 1):
        if near in left:
            left.remove(near)
            todo.append(near)
assert not left, len(left)
END
}

test_every_id_has_a_voxel_also_where_vessels_share_all_of_theirs() {
    grown
    for voxel in 0.5 4; do
        run_ok corcast export t.swc -o v.nii.gz --spacing $voxel --labels segment --quiet
        python <<'END'
labels, v = volume("v.labels.nii.gz")[0], volume("v.nii.gz")[0]
ids = {int(line.split()[0]) for line in open("t.swc") if line[0] != "#" and line.split()[6] != "-1"}
assert labels.dtype == numpy.uint16, labels.dtype
assert set(numpy.unique(labels)) - {0} == ids, ids - set(numpy.unique(labels))
assert ((labels > 0) == (v > 0)).all()
END
    done
    expect_json v.nii.gz.json '.labels == "segment" and .labels_given_a_voxel > 0'
    run corcast export t.swc -o x.nii.gz --spacing 30 --labels segment
    expect_status 2
    grep -qE -- '--spacing 30 x 30 x 30 mm: segment [0-9]+, .* mm long, has no voxel for its label' stderr || fail "$(cat stderr)"
    [ ! -e x.nii.gz ] || fail "expected no volume"
}

# chain N: writes a thick vessel that has the largest fraction of every voxel in a row, and N thin
# vessels in it. Each thin vessel touches two voxels and first gets the second one. One more thin
# vessel touches only the last voxel, so all N vessels must move to their first voxel.
chain() {
    {
        printf '1 3 -30 0 0 0.4 -1\n2 3 300 0 0 0.4 1\n'
        awk -v n="$1" 'BEGIN { for (k = 0; k < n; k++) printf "%d 3 %d 0 0 0.01 -1\n%d 3 %d 0 0 0.01 %d\n", 100 + 2 * k, k, 101 + 2 * k, k + 1, 100 + 2 * k }'
        printf '900 3 %s 0 0 0.01 -1\n901 3 %s 0 0 0.01 900\n' "$(($1 - 1)).7" "$1.2"
    } >chain.swc
}

test_labels_move_on_up_to_64_times_to_make_room() {
    chain 64
    run_ok corcast export chain.swc -o c.nii --spacing 1 --labels segment --quiet
    expect_json c.nii.json '.labels_given_a_voxel == 65'
    python <<'END'
labels = volume("c.labels.nii")[0]
assert set(numpy.unique(labels)) == {0, 2, 901} | set(range(101, 229, 2)), numpy.unique(labels)
END
    chain 65
    run corcast export chain.swc -o d.nii --spacing 1 --labels segment --quiet
    expect_status 2
    grep -q 'segment 901, 0.5 mm long, has no voxel for its label' stderr || fail "$(cat stderr)"
}

test_a_voxel_is_labelled_by_what_fills_the_most_of_it() {
    printf '1 3 0 0 0 0.9 -1\n2 3 10 0 0 0.9 1\n3 3 20 0 0 0.6 2\n4 3 17 6 0 0.4 2\n' >y.swc
    run_ok corcast export y.swc -o y.nii.gz --spacing 0.5 --labels segment --quiet
    run_ok corcast export y.swc -o o.nii.gz --spacing 0.5 --labels strahler --quiet
    run_ok corcast export y.swc -o f.nii.gz --spacing 0.5 --labels tree --quiet
    python <<'END'
import json
labels, first = volume("y.labels.nii.gz")[0], json.load(open("y.nii.gz.json"))["first_voxel_mm"]
def at(x, y, z):
    return labels[tuple(int(round((a - b) / 0.5)) for a, b in zip((x, y, z), first))]
assert at(5, 0.5, 0) == 2 and at(15, 0, 0.5) == 3 and at(14, 3.5, 0) == 4 and at(5, 2, 0) == 0
orders, trees = volume("o.labels.nii.gz")[0], volume("f.labels.nii.gz")[0]
assert set(numpy.unique(orders)) == {0, 1, 2} and (orders[labels == 2] == 2).all() and (orders[labels == 3] == 1).all()
assert set(numpy.unique(trees)) == {0, 1}
END
}

# The daughters are thick, so that voxels at the bifurcation are entirely inside both.
test_of_equal_shares_the_lowest_id_labels_the_voxel() {
    printf '7 3 0 0 0 2 -1\n5 3 12 8 0 2 7\n4 3 12 -8 0 2 7\n' >a.swc
    printf '7 3 0 0 0 2 -1\n4 3 12 8 0 2 7\n5 3 12 -8 0 2 7\n' >b.swc
    run_ok corcast export a.swc -o a.nii --spacing 0.5 --labels segment --quiet
    run_ok corcast export b.swc -o b.nii --spacing 0.5 --labels segment --quiet
    python <<'END'
import json
for name, side in (("a", 1), ("b", -1)):
    labels, first = volume(name + ".labels.nii")[0], json.load(open(name + ".nii.json"))["first_voxel_mm"]
    def at(x, y, z):
        return labels[tuple(int(round((a - b) / 0.5)) for a, b in zip((x, y, z), first))]
    assert at(1, 0.6, 0.3) == 4 and at(1, -0.6, 0.3) == 4, name
    assert at(11, 8 * side, 0) == 5 and at(11, -8 * side, 0) == 4, name
END
}

test_labels_do_not_depend_on_the_order_of_rows() {
    local file
    # All radii are equal, so that several segments have equal shares of voxels at the bifurcation.
    printf '1 3 0 0 0 0.9 -1\n2 3 10 0 0 0.9 1\n3 3 17 6 0 0.9 2\n4 3 17 -6 0 0.9 2\n5 3 20 0 0 0.9 2\n' >a.swc
    printf '1 3 0 0 0 0.9 -1\n2 3 10 0 0 0.9 1\n5 3 20 0 0 0.9 2\n4 3 17 -6 0 0.9 2\n3 3 17 6 0 0.9 2\n' >b.swc
    # The ids do not ascend from the root.
    printf '5 3 17 0 0 0.9 -1\n2 3 10 0 0 0.9 5\n3 3 17 6 0 0.9 2\n1 3 0 0 0 0.9 2\n' >c.swc
    printf '5 3 17 0 0 0.9 -1\n2 3 10 0 0 0.9 5\n1 3 0 0 0 0.9 2\n3 3 17 6 0 0.9 2\n' >d.swc
    for file in a b c d; do run_ok corcast export $file.swc -o $file.nii --spacing 0.5 --labels segment --quiet; done
    expect_same a.labels.nii b.labels.nii
    expect_same c.labels.nii d.labels.nii
}

test_memory_is_that_of_the_estimate() {
    local said peak
    run_ok corcast grow --terminals 8000 --domain ball:50 -o many.swc --quiet
    /usr/bin/time -f '%M' -o peak "$CORCAST" export many.swc -o m.nii --spacing 40 --threads 1 2>said || fail "$(cat said)"
    said=$(sed -nE 's/.* s, ([0-9.]+) MB of memory.*/\1/p' said)
    awk -v said="$said" -v peak="$(cat peak)" 'BEGIN { exit !(peak / 1000 < 1.3 * said && said < 1.5 * peak / 1000) }' ||
        fail "said $said MB, took $(cat peak) kB"
}

test_says_that_a_segment_with_the_ends_of_a_thicker_one_has_no_voxels() {
    printf '1 3 0 0 0 0.9 -1\n2 3 10 0 0 0.9 1\n3 3 10 0 0 0.4 1\n' >s.swc
    run_ok corcast export s.swc -o s.nii.gz --spacing 0.5 --labels segment --quiet
    expect_sentence '1 segment is inside other segments between the same two points, without voxels of their own'
    expect_json s.nii.gz.json '.segments == 2 and .segments_within_others == 1'
}

test_ids_beyond_16_bits_take_32() {
    printf '65535 3 0 0 0 0.9 -1\n65537 3 10 0 0 0.9 65535\n' >big.swc
    run_ok corcast export big.swc -o b.nii.gz --spacing 0.5 --labels segment --quiet
    python <<'END'
labels = volume("b.labels.nii.gz")[0]
assert labels.dtype == numpy.uint32 and set(numpy.unique(labels)) == {0, 65537}
END
}

test_same_bytes_for_any_number_of_threads() {
    local file
    grown
    run_ok corcast export t.swc -o one.nii.gz --spacing 0.3 --labels segment --centreline c1.nii.gz --threads 1 --quiet
    run_ok corcast export t.swc -o six.nii.gz --spacing 0.3 --labels segment --centreline c6.nii.gz --threads 6 --quiet
    expect_same c1.nii.gz c6.nii.gz
    for file in nii.gz labels.nii.gz csv; do
        expect_same one.$file six.$file
    done
    expect_same <(jq 'del(.command)' one.nii.gz.json) <(jq 'del(.command)' six.nii.gz.json)
}

test_memory_does_not_grow_with_the_volume() {
    grown
    # 400 million voxels.
    (ulimit -v 300000 && "$CORCAST" export t.swc -o t.nii.gz --spacing 0.1 --threads 2 --quiet) 2>stderr || fail "$(cat stderr)"
    expect_json t.nii.gz.json '.voxels | .[0] * .[1] * .[2] > 3.9e8'
}

test_volumes_of_parts_of_a_tree_fit_together() {
    grown
    run_ok corcast export t.swc -o t.nii.gz --spacing 0.7 --quiet
    run_ok corcast export t.swc -o p.nii.gz --spacing 0.7 --prune-radius 0.5 --quiet
    python <<'END'
import json
a, b = (numpy.array(json.load(open(name + ".nii.gz.json"))["first_voxel_mm"]) / 0.7 for name in "tp")
assert numpy.allclose(a, numpy.rint(a)) and numpy.allclose(b, numpy.rint(b)) and (a != b).any()
shift = numpy.rint(b - a).astype(int)
whole, part = volume("t.nii.gz")[0], volume("p.nii.gz")[0]
box = tuple(slice(s, s + n) for s, n in zip(shift, part.shape))
assert part.sum() > 300 and (whole[box] + 0.015 >= part).all()
END
}

test_the_tree_stands_beside_as_csv() {
    grown
    run_ok corcast export t.swc -o t.nii.gz --quiet
    expect_only t.swc t.csv t.nii.gz t.nii.gz.json
    run_ok corcast convert t.csv again.swc --quiet
    expect_same <(grep -v '^#' t.swc) <(grep -v '^#' again.swc)
}

test_the_manifest_has_integers_for_counts_and_the_shortest_numbers() {
    grown
    run_ok corcast export t.swc -o t.nii.gz --spacing 4,4.1,4.4 --quiet
    tr -d ' \n' <t.nii.gz.json >line
    grep -qE '"voxels":\[[0-9]+,[0-9]+,[0-9]+\],"voxel_mm":\[4\.0,4\.1,4\.4\]' line || fail "$(cat line)"
}

test_refuses_what_cannot_be() {
    grown
    while IFS='@' read -r options sentence; do
        # shellcheck disable=SC2086
        run corcast export t.swc --quiet $options
        expect_status 2
        expect_sentence "$sentence"
    done <<'END'
-o x.nii.gz --spacing 0@--spacing: 0 is not above 0
-o x.nii.gz --spacing 1,2@--spacing takes one number or three, not 2
-o x.nii.gz --spacing 1e-3@--spacing: [0-9]+ x [0-9]+ x [0-9]+ voxels; .nii.gz holds at most 32767 along an axis
-o x.nrrd --spacing 1e-12@--spacing: 1e-12 mm would make .* voxels along an axis
-o x.df3 --depth float@\.df3 has no samples of float
-o x.df3 --labels tree@\.df3 holds no labels and no centrelines
-o x.nii.gz --centreline c.stl@--centreline: 'c.stl' must end in .nii.gz
-o x.nii.gz --model isosurface@--model is for surfaces; a volume always contains cylinders and balls
-o x.nii.gz --color-by flow@--color-by is for formats with colors
-o x.stl --labels tree@--labels is for volumes
-o x.tif@does not end in .*, or for volumes in .nii.gz, .nii, .nrrd, .mha, .df3
END
    run corcast export t.swc -o x.nii --spacing 0.003 --quiet
    expect_status 3
    expect_sentence 'x.nii: needs .* TB, and its disk has .* left'
    expect_only t.swc
}

run_tests "$@"
