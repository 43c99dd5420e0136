#!/usr/bin/env bash
# Files that `export` writes for printers, read by PrusaSlicer.
. "$(dirname "$0")/../lib.sh"

# prusa_said LABEL: prints the value of LABEL in PrusaSlicer's last output, such as "yes" of
# "manifold = yes".
prusa_said() {
    sed -n "s/^$1 = *//p" said
}

# prints NAME TREES: PrusaSlicer reads the STL and the 3MF of NAME.swc as TREES solids with the
# volume in the manifest.
prints() {
    local name=$1 trees=$2 extension
    for extension in stl 3mf; do
        run_ok corcast export "$name.swc" --quiet -o "$name.$extension"
        prusa-slicer --info "$name.$extension" >said 2>&1 || fail "PrusaSlicer does not read $name.$extension: $(tail -1 said)"
        [ "$(prusa_said manifold) $(prusa_said number_of_parts)" = "yes $trees" ] ||
            fail "expected $trees solids of $name.$extension, PrusaSlicer finds $(grep -E 'manifold|parts' said | tr '\n' ' ')"
        [ "$(prusa_said number_of_facets)" = "$(jq .triangles "$name.$extension.json")" ] ||
            fail "PrusaSlicer loses triangles of $name.$extension"
        awk -v a="$(jq .volume_mm3 "$name.$extension.json")" -v b="$(prusa_said volume)" \
            'BEGIN { exit !(a > 10 && (a / b - 1) ^ 2 < 1e-4 ^ 2) }' ||
            fail "PrusaSlicer measures $(prusa_said volume) mm^3 of $name.$extension"
    done
}

test_prusaslicer_finds_one_solid_for_each_tree() {
    command -v prusa-slicer >/dev/null || skip "prusa-slicer is not installed"
    cp "$DATA/bifurcation.swc" "$DATA/coronary.swc" .
    run_ok corcast grow --terminals 123 --domain ball:41 --seed 7 --quiet -o grown.swc
    run_ok corcast grow --terminals 60 --domain ball:41 --inlet 0,41,0 --inlet 0,-41,0 --inlet 41,0,0 --quiet -o forest.swc
    prints bifurcation 1
    prints coronary 1
    prints grown 1
    prints forest 3
}

# lays_down NAME.EXT BOUND PRINT: PrusaSlicer finds no fault in the solid that --print PRINT makes
# of NAME.swc. At 100 % infill the volume of the filament equals the solid's volume to within BOUND.
lays_down() {
    local file=$1 bound=$2 print=$3
    run_ok corcast export "${file%.*}.swc" --print "$print,nozzle=0.4" --quiet -o "$file"
    prusa-slicer --info "$file" >said 2>&1 || fail "PrusaSlicer does not read $file: $(tail -1 said)"
    [ "$(prusa_said manifold) $(prusa_said number_of_parts)" = "yes 1" ] ||
        fail "expected one solid of $file, PrusaSlicer finds $(grep -E 'manifold|parts' said | tr '\n' ' ')"
    ! grep -qiE 'open_edges|repair|facets_(removed|reversed)|backwards' said || fail "PrusaSlicer mends $file: $(cat said)"
    timeout 120 prusa-slicer -g --nozzle-diameter 0.4 --layer-height 0.2 --fill-density 100% --fill-pattern rectilinear \
        --skirts 0 --brim-width 0 --center 100,100 -o print.gcode "$file" >said 2>&1 || fail "PrusaSlicer does not slice $file: $(tail -1 said)"
    ! grep -iE 'error|warning|repair|open edges|empty|unsupported' said || fail "PrusaSlicer complains about $file"
    awk -v v="$(jq .volume_mm3 "$file.json")" -v used="$(sed -n 's/^; filament used \[cm3\] = //p' print.gcode)" -v bound="$bound" \
        'BEGIN { exit !(v > 1000 && (1000 * used / v - 1) ^ 2 < bound ^ 2) }' ||
        fail "$(sed -n 's/^; filament used \[cm3\] = //p' print.gcode) cm^3 of filament for $(jq .volume_mm3 "$file.json") mm^3 of $file"
}

# Slow: PrusaSlicer slices hundreds of layers.
test_prusaslicer_lays_down_the_volume_of_walls_blocks_and_trees() {
    command -v prusa-slicer >/dev/null || skip "prusa-slicer is not installed"
    cp "$DATA/bifurcation.swc" "$DATA/coronary.swc" .
    lays_down bifurcation.stl 0.005 scale=2,wall=1.2,base
    lays_down bifurcation.3mf 0.03 scale=2,wall=1.2
    lays_down bifurcation.stl 0.02 block=box,ports
    lays_down coronary.3mf 0.04 min-diameter=2,base
}

run_tests "$@"
