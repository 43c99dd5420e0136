#!/usr/bin/env bash
# What `export` writes for printers, as PrusaSlicer reads it.
. "$(dirname "$0")/../lib.sh"

# prusa_said LABEL: what PrusaSlicer said last, "manifold = yes" say.
prusa_said() {
    sed -n "s/^$1 = *//p" said
}

# prints NAME TREES: the STL and the 3MF of NAME.swc are solids of so many parts and of the volume in the manifest.
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

run_tests "$@"
