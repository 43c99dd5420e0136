#!/usr/bin/env bash
# Files that `export` writes for artists, read and drawn by Blender.
. "$(dirname "$0")/../lib.sh"

# in_blender ARGUMENT ...: runs blender.py in Blender with the arguments.
in_blender() {
    command -v blender >/dev/null || skip "blender is not installed"
    run_ok timeout 300 xvfb-run -a blender -b -noaudio --factory-startup --python-exit-code 1 \
        -P "$REPO/tests/all/blender.py" -- "$@"
}

# looks_as_rendered IOU BEYOND OPTION ...: blender.png shows the same tree as `render` with the
# options draws of t.swc. The outlines have an intersection over union of at least IOU, at most
# BEYOND pixels are outside of corcast's outline, and the colors are the same.
looks_as_rendered() {
    local iou=$1 beyond=$2
    shift 2
    run_ok corcast render --exact t.swc --location 0,0,100 --look-at 0,0,0 --height 100 --size 500x500 \
        --planes color,id --quiet -o ours.ppm "$@"
    /usr/bin/python3 - "$iou" "$beyond" >compared <<'END' || fail "Blender draws another picture: $(cat compared)"
import sys
import numpy as np
from skimage.io import imread
from skimage.morphology import binary_dilation, disk
def shares(codes):
    part = codes / 255.0
    linear = np.where(part <= 0.04045, part / 12.92, ((part + 0.055) / 1.055)**2.4)
    return linear / np.maximum(linear.sum(axis=1, keepdims=True), 1e-9)
picture = imread("blender.png")
theirs = picture[..., 3] > 127
ours = imread("ours.id.ppm").reshape(500, 500, 3).any(axis=2)
iou = (ours & theirs).sum() / (ours | theirs).sum()
beyond = (theirs & ~binary_dilation(ours, disk(1))).sum()
both = ours & theirs
off = np.abs(shares(picture[both][:, :3]) - shares(imread("ours.ppm")[both])).max(axis=1)
print("pixels", ours.sum(), "IoU", iou, "beyond", beyond, "colors off by", np.median(off), np.percentile(off, 90))
sys.exit(0 if ours.sum() > 9000 and iou > float(sys.argv[1]) and beyond <= int(sys.argv[2]) and np.median(off) < 0.03 else 1)
END
}

test_blender_imports_every_format_whole() {
    local extension path triangles volume parts open
    run_ok corcast grow --terminals 30 --domain ball:41 --inlet 0,41,0 --inlet 0,-41,0 --seed 7 --quiet -o t.swc
    for extension in glb obj ply stl; do
        run_ok corcast export t.swc --quiet -o t.$extension
    done
    in_blender measure t.glb t.obj t.ply t.stl
    [ "$(grep -c '^MEASURED' stdout)" = 4 ] || fail "Blender reads not all of four files"
    while read -r _ path triangles volume parts open; do
        [ "$triangles $parts $open" = "$(jq .triangles t.stl.json) 2 0" ] ||
            fail "Blender reads $triangles triangles, $parts parts and $open open edges of $path"
        awk -v a="$(jq .volume_mm3 t.stl.json)" -v b="$volume" 'BEGIN { exit !(a > 100 && (a / b - 1) ^ 2 < 1e-5 ^ 2) }' ||
            fail "Blender measures $volume mm^3 of $path"
    done < <(grep '^MEASURED' stdout)
}

# Vessels are three pixels wide. `render` draws round ends where the mesh has flat cuts. Colors are
# compared by the ratios of red, green and blue, which do not depend on shading except in white
# highlights.
test_blender_draws_a_glb_with_the_outline_and_the_colors_that_render_draws() {
    run_ok corcast grow --terminals 23 --domain ball:41 --seed 7 --quiet -o t.swc
    run_ok corcast export t.swc --color-by radius --quiet -o t.glb
    in_blender draw "$PWD/t.glb" "$PWD/blender.png"
    looks_as_rendered 0.985 0 --model isosurface --potential graph --color-by radius
}

# The script makes curves, which Blender draws as prisms of 16 sides.
test_blender_runs_the_script_and_draws_its_curves_as_render_draws_the_vessels() {
    local triangles volume parts open
    run_ok corcast grow --terminals 23 --domain ball:41 --seed 7 --quiet -o t.swc
    run_ok corcast export t.swc --color-by radius --quiet -o t.py
    in_blender measure "$PWD/t.py"
    read -r _ _ triangles volume parts open < <(grep '^MEASURED' stdout)
    [ "$parts $open" = "$(grep -cE '^\([0-9]+, ' t.py) 0" ] || fail "Blender makes $parts parts and $open open edges"
    [ "$triangles" -gt 2000 ] || fail "Blender makes $triangles triangles"
    corcast info t.swc --json --quiet >info.json
    awk -v a="$(jq .volume_mm3 info.json)" -v b="$volume" 'BEGIN { r = b / (a * 8 / 3.141592653589793 * sin(3.141592653589793 / 8)); exit !((r - 1) ^ 2 < 0.005 ^ 2) }' ||
        fail "Blender measures $volume mm^3 of $(jq .volume_mm3 info.json)"
    in_blender draw "$PWD/t.py" "$PWD/blender.png"
    looks_as_rendered 0.97 9 --model rounded --color-by radius
}

run_tests "$@"
