#!/usr/bin/env bash
# `export T -o M.inc`: POV-Ray draws the mesh at the same pixels where `render` draws its surface.
. "$(dirname "$0")/../lib.sh"

# mesh_scene FILE OBJECT: writes a scene that shows mesh.inc from the front, 100 mm high.
mesh_scene() {
    cat >"$1" <<END
#version 3.7;
global_settings { assumed_gamma 1 }
camera { orthographic location <0, 0, 100> right 100 * x up 100 * y direction -z }
light_source { <30, 50, 100>, color rgb 1 parallel point_at 0 shadowless }
#include "mesh.inc"
$2
END
}

# draw SCENE PICTURE OPTION ...: POV-Ray draws the scene without a warning.
draw() {
    local scene=$1 picture=$2
    shift 2
    run_ok timeout 300 povray "+I$scene" "+O$picture" +W500 +H500 -D -A "$@"
    ! grep -qi 'warning:' stderr || fail "expected no warning of POV-Ray: $(grep -i -A 2 'warning:' stderr)"
}

# The vessels cover 12,000 pixels and are 3 pixels wide. Pixels on their edges may differ, and
# `render` draws round ends where the mesh has flat cuts.
test_mesh2_has_the_silhouette_and_the_normals_of_the_surface() {
    /usr/bin/python3 -c 'import skimage' 2>import.log || skip "python3-skimage is not installed"
    run_ok corcast grow --terminals 23 --domain ball:41 --seed 7 -o t.swc --quiet
    run_ok corcast export t.swc -o mesh.inc --quiet
    mesh_scene mask.pov 'object { Tree texture { pigment { color rgb 1 } finish { ambient 0 diffuse 0 emission 1 } } }'
    mesh_scene shaded.pov 'object { Tree texture { pigment { color rgb 1 } finish { ambient 0 diffuse 1 } } }'
    draw mask.pov mask.png
    draw shaded.pov shaded.png
    run_ok corcast render --exact t.swc --model isosurface --potential graph --location 0,0,100 --look-at 0,0,0 --height 100 \
        --size 500x500 --planes id,normal -o ours.ppm
    /usr/bin/python3 - >compared <<'END' || fail "POV-Ray's mesh is not our surface: $(cat compared)"
import sys
import numpy as np
from skimage.io import imread
from skimage.morphology import binary_dilation, disk
theirs = imread("mask.png")[..., :3].any(axis=2)
ours = imread("ours.id.ppm").reshape(500, 500, 3).any(axis=2)
pfm = open("ours.normal.pfm", "rb").read()
normal = np.frombuffer(pfm[-500 * 500 * 12:], "<f4").reshape(500, 500, 3)[::-1]
light = np.array([30, 50, 100]) / np.linalg.norm([30, 50, 100])
code = imread("shaded.png")[..., 0] / 255.0
shade = np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055)**2.4)
both = ours & theirs
iou = both.sum() / (ours | theirs).sum()
beyond = (theirs & ~binary_dilation(ours, disk(1))).sum()
off = np.abs(shade - np.maximum(normal @ light, 0))[both]
print("pixels", ours.sum(), "IoU", iou, "beyond", beyond, "shade off by", np.median(off), np.percentile(off, 95))
sys.exit(0 if ours.sum() > 9000 and iou > 0.98 and beyond == 0 and np.median(off) < 0.01 else 1)
END
}

test_colors_of_segments_are_textures_of_the_mesh() {
    run_ok corcast export "$DATA/bifurcation.swc" --color-by strahler -o mesh.inc --quiet
    mesh_scene colors.pov 'object { Tree texture { pigment { color rgb <0, 0, 1> } } }'
    draw colors.pov colors.png Declare=Vessel_Ambient=1 Declare=Vessel_Diffuse=0 Declare=Vessel_Phong=0
    pngtopnm colors.png | ppmhist -noheader | awk '{ print $1, $2, $3 }' | sort >seen
    printf '0 0 0\n253 231 37\n68 1 84\n' | diff - seen >difference || fail "expected the ends of viridis: $(cat difference)"
}

run_tests
