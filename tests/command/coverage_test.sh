#!/usr/bin/env bash
# `coverage`: distances of tissue from vessels, beside a loop over all vessels and beside scipy.
. "$(dirname "$0")/../lib.sh"

# python: runs standard input with numpy, scipy, nibabel and these: `points`, `parent`, `radius` of t.swc by node,
# `volume(name)`: the samples of a volume and the centre of each voxel, mm, and `walls(p)`: the distance of each point
# from the wall of each segment.
python() {
    /usr/bin/python3 -c 'import nibabel, numpy, scipy' 2>python.error || skip "nibabel or scipy is not installed"
    {
        cat <<'END'
import json, nibabel, numpy
rows = [line.split() for line in open("t.swc") if line[0] != "#"]
at = {row[0]: i for i, row in enumerate(rows)}
ids = numpy.array([int(row[0]) for row in rows])
points = numpy.array([[float(x) for x in row[2:5]] for row in rows])
radius = numpy.array([float(row[5]) for row in rows])
parent = numpy.array([at.get(row[6], -1) for row in rows])
segment = numpy.flatnonzero(parent >= 0)
terminal = numpy.setdiff1d(segment, parent)
def volume(name):
    image = nibabel.load(name)
    data = numpy.asarray(image.dataobj)
    index = numpy.stack(numpy.indices(data.shape), axis=-1)
    return data, index @ image.affine[:3, :3].T + image.affine[:3, 3]
def walls(p):
    a, b = points[parent[segment]], points[segment]
    out = numpy.empty((len(p), len(segment)))
    for k in range(len(segment)):
        along = b[k] - a[k]
        t = numpy.clip((p - a[k]) @ along / (along @ along), 0, 1)
        out[:, k] = numpy.linalg.norm(p - a[k] - t[:, None] * along, axis=1) - radius[segment[k]]
    return out
END
        cat
    } >script.py
    /usr/bin/python3 script.py >said 2>&1 || fail "python: $(tail -3 said | tr '\n' ' ')"
}

test_distances_and_territories_are_those_of_a_loop_over_all_vessels() {
    run_ok corcast grow --terminals 50 --domain ellipsoid:9,6,5 --seed 4 -o t.swc --quiet
    run_ok corcast coverage t.swc --spacing 0.5 --beyond 0.3,1 -o d.nii.gz --territories l.nii.gz --json s.json \
        --summary s.csv --quiet
    run_ok corcast coverage t.swc --spacing 0.5 --territories w.nii.gz --territory segment --quiet
    python <<'END'
d, at = volume("d.nii.gz")
inside = ((at / [9, 6, 5]) ** 2).sum(axis=-1) <= 1
assert (numpy.isnan(d) == ~inside).all()
p = at[inside]
each = walls(p)
exact = each.min(axis=1)
assert numpy.abs(d[inside] - numpy.maximum(exact, 0)).max() < 2e-6
tissue = exact > 0
said = json.load(open("s.json"))
assert said["tissue_voxels"] == tissue.sum() and abs(said["mean_mm"] / exact[tissue].mean() - 1) < 1e-12
for row in said["quantiles"]:
    assert abs(numpy.quantile(exact[tissue], row["part"], method="inverted_cdf") - row["distance_mm"]) < 1e-4, row
for row in said["beyond"]:
    assert row["share"] == (exact[tissue] > row["distance_mm"]).mean(), row
# Territories: the nearest wall, or the nearest end of a terminal segment; ties may go either way.
label = volume("w.nii.gz")[0][inside]
column = {ids[segment[k]]: k for k in range(len(segment))}
own = each[numpy.arange(len(p)), [column[x] for x in label]]
assert (own - exact).max() < 1e-12 and (volume("w.nii.gz")[0][~inside] == 0).all()
end = numpy.linalg.norm(p[:, None] - points[terminal], axis=2)
label = volume("l.nii.gz")[0][inside]
column = {ids[terminal[k]]: k for k in range(len(terminal))}
assert (end[numpy.arange(len(p)), [column[x] for x in label]] - end.min(axis=1)).max() < 1e-12
table = numpy.genfromtxt("l.csv", delimiter=",", skip_header=1)
assert abs(table[:, 1].sum() / said["tissue_mm3"] - 1) < 1e-6 and len(table) == 50
assert table[0][1] == (label[tissue] == table[0][0]).sum() * 0.125
# The largest void is one, and no point of the tissue is farther from all vessels.
void = numpy.array(said["largest_at_mm"])
assert ((void / [9, 6, 5]) ** 2).sum() <= 1 and abs(walls(void[None]).min() - said["largest_mm"]) < 1e-9
near = void + numpy.random.default_rng(1).uniform(-0.3, 0.3, (20000, 3))
near = near[((near / [9, 6, 5]) ** 2).sum(axis=1) <= 1]
most = max(exact.max(), walls(near).min(axis=1).max())
assert exact.max() < said["largest_mm"] and most < said["largest_mm"] + said["largest_error_mm"]
END
    grep -q '^quantile,0.95,[0-9.]*,mm$' s.csv || fail "s.csv lacks the quantile 0.95: $(head -9 s.csv)"
    awk -F, '$1 == "share_within" { if ($3 < last) exit 1; last = $3; n++ } END { exit !(n == 100 && last == 1) }' s.csv ||
        fail "the shares of s.csv do not rise to 1"
}

test_distances_agree_with_a_distance_transform_of_the_vessels_voxels() {
    run_ok corcast grow --terminals 20 --domain box:6,5,4 --seed 2 -o t.swc --quiet
    run_ok corcast coverage t.swc --spacing 0.2 -o d.nii --quiet
    run_ok corcast export t.swc -o v.nii.gz --spacing 0.2 --depth float --quiet
    python <<'END'
from scipy.ndimage import distance_transform_edt
d, at = volume("d.nii")
v, there = volume("v.nii.gz")
full = numpy.zeros(d.shape, bool)
index = numpy.rint((there[v > 0] - at[0, 0, 0]) / 0.2).astype(int)
ok = ((index >= 0) & (index < d.shape)).all(axis=1)
full[tuple(index[ok].T)] = True
transform = distance_transform_edt(~full, sampling=0.2)
inside = ~numpy.isnan(d)
# A voxel that a vessel touches has a point of it within half its diagonal; slivers may count as empty.
half = 0.1 * 3 ** 0.5
assert numpy.abs(transform - d)[inside].max() < 1.02 * half, numpy.abs(transform - d)[inside].max()
END
}

test_the_number_of_threads_changes_no_byte() {
    local format
    run_ok corcast grow --terminals 60 --domain disc:9 --seed 4 -o t.swc --quiet
    run_ok corcast coverage t.swc --spacing 0.05 -o 1.nrrd --territories a.mha --json 1.json --threads 1
    cp stdout 1.txt
    run_ok corcast coverage t.swc --spacing 0.05 -o 3.nrrd --territories b.mha --json 3.json --threads 3
    expect_same stdout 1.txt
    expect_same 3.nrrd 1.nrrd
    expect_same b.mha a.mha
    jq 'del(.command)' 1.json >1.out
    jq 'del(.command)' 3.json | cmp -s - 1.out || fail "the results differ"
    expect_json 1.json '(.tissue_mm2 + .vessels_mm2) / (81 * 3.14159265) | . > 0.999 and . < 1.001'
}

test_what_cannot_be_measured_is_refused() {
    printf '1 3 0 0 0 1 -1\n2 3 0 8 0 1 1\n' >one.swc
    run corcast coverage one.swc
    expect_status 2
    expect_sentence 'does not state the tissue it supplies; give --domain'
    run corcast coverage one.swc --domain ball:3@100,0,0
    expect_status 2
    expect_sentence 'no vessel is in the tissue shape; .*--input-unit'
    run_ok corcast coverage one.swc --domain ball:6 --spacing 0.5
    grep -q '^corcast: 25 % of the vessels. length is outside the tissue shape' stderr || fail "no share of the length outside: $(cat stderr)"
    grep -q 'the same z, but the tissue shape has three' stderr || fail "no warning of a flat tree: $(cat stderr)"
    run corcast coverage one.swc --domain hull
    expect_status 2
    expect_sentence '--domain hull: use hull:MM'
    run corcast coverage one.swc --domain box:0.2,9,9 --spacing 1
    expect_status 2
    expect_sentence 'voxels of 1 mm are too large for the tissue shape'
    run corcast coverage one.swc --domain ball:9 --beyond 0.2,0.1
    expect_status 2
    expect_sentence '0.1 is not above 0.2'
    run corcast coverage one.swc --domain ball:9 -o d.df3
    expect_status 2
    expect_sentence "'d.df3' must end in .nii.gz"
    run corcast coverage one.swc --domain ball:9000 --spacing 0.001
    expect_status 3
    expect_sentence 'the distances at this --spacing: out of memory'
    run corcast coverage one.swc --domain ball:9 --spacing 0
    expect_status 2
    expect_only one.swc
}

run_tests
