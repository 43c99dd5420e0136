#!/usr/bin/env bash
# Every tree and network of ../shared/data, with the counts in the README of that folder.
. "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

# expect_values FILE COLUMN FILTER [OPTION...]: converts the file to CSV. The awk expression FILTER
# is true for n, low and high: the count, the minimum and the maximum of the column's values.
expect_values() {
    run_ok corcast convert --quiet "${@:4}" "$SHARED/$1" values.csv
    awk -F, -v column="$2" '/^#/ { next }
        !at { for (k = 1; k <= NF; k++) if ($k == column || $k == "\"" column "\"") at = k; next }
        $at != "" { if (!n++) low = high = $at; if ($at < low) low = $at; if ($at > high) high = $at }
        END { exit !('"$3"') }' values.csv || fail "$1: expected $3 of the values of $2"
}

test_the_arteries_of_a_brain() {
    expect_tree brain_pvs/arteries_smooth.vtk '.reading.network.points == 12709 and .bifurcations == 145 and
        .reading.degrees[1] == 147 and .roots == 1 and .reading.components == 1 and
        .reading.network.loops == 0 and (.reading.assumed | any(test("^inlets stated in the file that are not roots: 2 ")))' --input-unit m
    # The README states 0.49 to 1.40 mm with two digits. Value 2 is an inlet, 1 an end.
    expect_values brain_pvs/arteries_smooth.vtk radius_mm 'n == 12709 && low >= 0.485 && high < 1.405' --input-unit m
    expect_values brain_pvs/arteries_smooth.vtk root 'n >= 147 && high == 2' --input-unit m
}

test_vessels_of_the_cortex() {
    expect_tree bluebrain_vascpy/fork_multiple_properties.vtk '.segments == 3 and .terminals == 2' \
        --radius-array point_property2
    expect_tree bluebrain_vascpy/one_loop.vtk '.reading.network.loops == 1' --break-loops
    expect_tree bluebrain_vascpy/penetrating_artery.vtk '.reading.components == 1 and .segments == 1273 and
        .reading.assumed == ["radius is the cell array '"'radius'"'"] and .reading.believed_unit == "um"'
    expect_tree bluebrain_vascpy/penetrating_artery2.vtk '.reading.components == 1 and .segments == 809'
    expect_tree bluebrain_vascpy/test_smaller_vasculature.vtk '.reading.components == 15 and .segments == 897'
}

test_a_retina_and_three_tumours() {
    expect_tree microvesselchaste/retinal.vtp '.reading.network.loops == 203' --radius-array Distance --break-loops
    expect_tree microvesselchaste/bio_original.vtp '.reading.network.lines == 7650 and
        .reading.network.points == 15300 and .reading.components == 1309' --break-loops
    expect_tree microvesselchaste/markelc_network.vtp '.reading.network.lines == 12656 and
        .reading.network.unused_points == 8' --break-loops
    expect_tree microvesselchaste/tapmeier_network.vtp '.reading.segments_without_radius == 15' --break-loops
}

test_decks_of_the_aorta_and_of_a_coronary_tree() {
    # Segments share no nodes: only joints state which segments meet. One joint has three outlets.
    expect_tree simvascular_oned/14_AortoFem_Pulse_RCR.in '.segments == 124 and .terminals == 9 and
        .reading.components == 1 and .reading.degrees[4] == 1 and .reading.unit == "cm"'
    expect_tree simvascular_oned/Left_coronary_inlet_pressure_wave_outlet_coronary.in '.segments == 86 and
        .terminals == 6 and .reading.components == 1 and .reading.unit == "cm"'
}

test_trees_of_vascusynth() {
    expect_tree vascusynth_gxl/ftilde_tree_structure.xml '.terminals == 1000 and .bifurcations == 999 and .roots == 1'
    expect_tree vascusynth_gxl/tree_structure_from_OpenCCO_Figure6.xml '.terminals == 200 and
        .bifurcations == 199 and .roots == 1'
}

# The six arteries are joined in one tree of 3,514 rows. Their types are 2 to 7; type 0 is a path
# between them.
test_the_six_trees_of_a_brain_in_one_swc() {
    expect_tree brava/BG0002records.swc '.segments == 3513 and .roots == 1'
    expect_values brava/BG0002records.swc type 'n == 3514 && low == 0 && high == 7'
    [ "$(awk -F, '$7 ~ /^[2-7]$/ { print $7 }' values.csv | sort -u | wc -l)" = 6 ] || fail "expected six types"
    expect_tree brava/test1.swc '.segments == 7 and .terminals == 2'
}

test_networks_of_a_tumour_and_of_a_brain_have_diameters() {
    expect_tree secomb/Tumor1998.network.dat '.reading.network.lines == 104 and .reading.network.points == 92 and
        .reading.network.loops == 14 and .reading.unit == "um"' --break-loops
    # The README states 17 boundary nodes. Radii are half of the diameters, and the largest diameter
    # is 33.2 um.
    expect_values secomb/Tumor1998.network.dat 'boundary type' 'n == 17' --break-loops
    expect_values secomb/Tumor1998.network.dat radius_mm 'high == 0.0166' --break-loops
    expect_tree secomb/Brain.network.dat '.reading.network.lines == 50 and .reading.network.points == 49 and
        .reading.network.loops == 3' --break-loops
}

test_trees_that_peers_have_grown() {
    local file hundred='.terminals == 100 and .segments == 199 and .bifurcations == 99 and .roots == 1 and
        .reading.components == 1'
    for file in opencco_2d_100.xml opencco_3d_100.xml vascusynth_100.xml v3_100.vtp v3_100.cco ccolab_2d_100.vtk; do
        expect_tree "peers/$file" "$hundred"
    done
    expect_tree peers/opencco_3d_60.dat '.terminals == 60 and .segments == 118 and .roots == 1'
    expect_tree peers/svv_500.csv '.terminals == 500 and .segments == 999 and .roots == 1' \
        --input-unit cm --columns x0=1,y0=2,z0=3,x1=4,y1=5,z1=6,radius=22
}

# A file of the folder that none of the tests above names has been forgotten.
test_no_tree_of_the_folder_is_forgotten() {
    [ -d "$SHARED" ] || skip "$SHARED is not here"
    local path forgotten=
    for path in "$SHARED"/*/*.{swc,vtk,vtp,xml,dat,cco,csv,in}; do
        grep -qF "$(basename "$path")" "$REPO/tests/command/measured_formats_test.sh" || forgotten+=" $path"
    done
    [ -z "$forgotten" ] || fail "no test reads$forgotten"
}

run_tests "$@"
