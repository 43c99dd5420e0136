#!/usr/bin/env bash
# Density files: the light of a medium in POV-Ray is proportional to the path length through
# vessels.
. "$(dirname "$0")/../lib.sh"

# The ray of each pixel passes through a row of voxels. The light of the pixel must equal the sum of
# their densities, and the sum over all pixels the volume in the manifest.
test_the_light_of_a_medium_is_the_way_through_vessels() {
    run_ok corcast grow --terminals 12 --domain ball:30 --seed 5 -o t.swc --quiet
    run_ok corcast export t.swc -o t.df3 --spacing 0.9,0.8,1.1 --depth 16 --quiet
    expect_only t.swc t.csv t.df3 t.df3.json t.pov
    read -r width height depth < <(jq -r '.voxels | @tsv' t.df3.json)
    printf '#declare %s;\n' 'Background_Color = rgb 0' 'Glow_Color = rgb <1, 0.5, 0.25>' 'Glow_Emission = 0.07' \
        'Glow_Interpolate = 0' "Glow_Samples = $((4 * depth))" >glow.pov
    echo '#include "t.pov"' >>glow.pov
    run_ok corcast povray glow.pov -o glow.png --size "${width}x$height" --bits 16 --quiet
    pngtopnm glow.png >glow.ppm 2>netpbm.said
    /usr/bin/python3 - >said 2>&1 <<'END' || fail "$(tail -1 said)"
import array, json, struct
bytes = open("t.df3", "rb").read()
nx, ny, nz = struct.unpack(">HHH", bytes[:6])
voxels = array.array("H", bytes[6:]); voxels.byteswap()
magic, size, most, pixels = open("glow.ppm", "rb").read().split(b"\n", 3)
codes = array.array("H", pixels); codes.byteswap()
assert (magic, size, most) == (b"P6", b"%d %d" % (nx, ny), b"65535")
worst = way = light = 0
for y in range(ny):
    for x in range(nx):
        expected = 0.07 * 1.1 * sum(voxels[(ny - 1 - y) * nx + x::nx * ny]) / 65535
        for channel, part in enumerate((1, 0.5, 0.25)):
            found = codes[(y * nx + x) * 3 + channel] / 65535
            worst = max(worst, abs(found - part * expected))
        way += expected
        light += codes[(y * nx + x) * 3] / 65535
said = json.load(open("t.df3.json"))
assert 0.2 < max(codes) / 65535 < 1
assert worst < 0.07 * 0.002, f"a pixel is off by {worst / 0.07} mm"
assert abs(light / way - 1) < 1e-4, light / way
assert abs(way / 0.07 * 0.9 * 0.8 / said["union_mm3"] - 1) < 1e-3
END
    # From the other side the picture is mirrored; in perspective it differs.
    sed -i 's|^#include|#declare Camera_Location = <0, 0, -200>;\n#declare Camera_Look_At = <0, 0, 0>;\n#include|' glow.pov
    { cat t.pov; echo '#debug concat("\n:", vstr(3, Camera_Right, " ", 0, 6), "; ", vstr(3, Camera_Direction, " ", 0, 3), "\n")'; } >debug.pov
    sed -i 's|t.pov|debug.pov|' glow.pov
    povray +Iglow.pov +Oback.png +W40 +H40 -D >back.log 2>&1
    grep -qE '^:-[0-9.]+ 0.000000 0.000000; 0.000 0.000 1.000$' back.log || fail "expected the camera to look along z: $(grep '^:' back.log)"
    povray +Iglow.pov +Onear.png +W40 +H40 -D Declare=Camera_Perspective=1 >near.log 2>&1
    expect_differing 100 1600 back.png near.png
}

run_tests "$@"
