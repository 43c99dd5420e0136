#!/usr/bin/env bash
# Networks in VTK files: files written by VTK, and files of other programs.
. "$(dirname "$0")/../lib.sh"

PYTHON=/usr/bin/python3 # Debian's, which has VTK

# expect_network FILE FILTER [OPTION...]: the jq filter is true for the output of `info --json` for
# the file.
expect_network() {
    local file=$1 filter=$2
    shift 2
    [ -e "$SHARED/$file" ] || skip "the measured network $SHARED/$file is not here"
    run_ok corcast info --quiet --json "$@" "$SHARED/$file"
    expect_json stdout "$filter"
}

test_whatever_vtk_writes_is_read_alike() {
    local file
    "$PYTHON" -c 'import vtkmodules' 2>/dev/null || skip "python3-vtk9 is not installed"
    mkdir files
    "$PYTHON" "$REPO/tests/oracle/write_vtk.py" files >names || fail "VTK did not write its files"
    [ "$(wc -l <names)" = 64 ] || fail "expected 64 files, got $(wc -l <names)"
    cat >expected.csv <<'END'
id,parent,x_mm,y_mm,z_mm,radius_mm,type,"pressure [Pa]","flow"
1,-1,0,0,0,1.5,3,100.5,
2,1,1.5,0.25,0,1.5,3,98,7.5
3,2,3,0,0.5,1.375,3,95.25,7.5
4,3,4,1,1,0.75,3,93,6.25
5,4,5,2,1.25,0.625,3,92.125,6.25
6,3,4,-1,-0.5,0.5,3,91,5.125
END
    while read -r file; do
        run_ok corcast convert "files/$file" tree.csv
        expect_same tree.csv expected.csv
    done <names
}

test_the_arteries_of_a_brain_in_metres() {
    expect_network brain_pvs/arteries_smooth.vtk '.segments == 12708 and .bifurcations == 145 and
        .reading.degrees[1] == 147 and .reading.components == 1 and
        .reading.roots[0].reason == "from the file" and .reading.network.points == 12709 and
        .reading.median_radius_mm > 0.49 and .reading.median_radius_mm < 1.40 and
        (.reading.unit_said and .reading.believed_unit == "m") and
        (.reading.assumed[2] | startswith("inlets stated in the file that are not roots: 2 "))' --input-unit m
    run_ok corcast info "$SHARED/brain_pvs/arteries_smooth.vtk"
    expect_sentence 'assuming mm, but a median radius of 0.000536 suggests m; set the unit with --input-unit'
}

test_vessels_of_the_cortex_with_radii_of_cells() {
    expect_network bluebrain_vascpy/penetrating_artery.vtk '.segments == 1273 and
        .reading.components == 1 and .reading.assumed[0] == "radius is the cell array '"'radius'"'"'
    expect_network bluebrain_vascpy/penetrating_artery2.vtk '.segments == 809'
    expect_network bluebrain_vascpy/test_smaller_vasculature.vtk '.segments == 897 and
        .roots == 15 and .reading.believed_unit == "um"'
    expect_network bluebrain_vascpy/one_loop.vtk '.segments == 159 and .reading.network.loops == 1 and
        (.reading.network.cuts | length) == 1' --break-loops
    run_ok corcast info "$SHARED/bluebrain_vascpy/one_loop.vtk" --break-loops
    expect_stdout '^  left out      1 line cut where a loop closed$'
    expect_network bluebrain_vascpy/one_loop.vtk '.segments == 160 and .loops == 1 and .components == 3'
    run corcast info "$SHARED/bluebrain_vascpy/fork_multiple_properties.vtk"
    expect_status 2
    expect_sentence "no array has the name of a radius; name one with --radius-array, or set --radius; .*'edge_property1'"
    expect_network bluebrain_vascpy/fork_multiple_properties.vtk '.segments == 3 and
        .min_radius_mm == 1' --radius-array point_property2
}

test_tumours_and_a_retina_whose_points_are_not_shared() {
    expect_network microvesselchaste/retinal.vtp '.reading.network.loops == 203 and
        .reading.components == 8' --radius-array Distance --break-loops
    expect_network microvesselchaste/bio_original.vtp '.reading.network.lines == 7650 and
        .reading.network.points == 15300 and .reading.network.merged_points == 6973 and
        .reading.components == 1309' --break-loops
    expect_network microvesselchaste/markelc_network.vtp '.reading.network.lines == 12656 and
        .reading.network.unused_points == 8' --break-loops
    expect_network microvesselchaste/tapmeier_network.vtp '.reading.segments_without_radius == 15 and
        .reading.network.loops == 4 and .reading.degrees[4] == 3' --break-loops
}

test_trees_of_other_generators() {
    local each='.terminals == 100 and .bifurcations == 99 and .reading.components == 1 and
        .reading.network.loops == 0 and .reading.believed_unit == "mm"'
    expect_network peers/ccolab_2d_100.vtk "$each"
    expect_network peers/v3_100.vtp "$each and .root_radius_mm == 1.3"
}

test_points_nearby_are_one_within_the_tolerance() {
    cat >near.vtk <<'END'
# vtk DataFile Version 3.0
two vessels that touch but nearly
ASCII
DATASET POLYDATA
POINTS 4 float
0 0 0 5 0 0 5 0.02 0 9 1 0
LINES 2 6
2 0 1
2 2 3
CELL_DATA 2
FIELD FieldData 1
radius 1 2 float
1.5 1.25
END
    run_ok corcast info --json near.vtk
    expect_json stdout '.roots == 2'
    run_ok corcast info --json near.vtk --merge-tolerance 0.03
    expect_json stdout '.roots == 1 and .reading.network.merged_points == 1 and .segments == 2'
    run_ok corcast info --json near.vtk --input-unit cm --voxel-size 1,2,3 --voxel-radii
    expect_json stdout '(.root_radius_mm - 15 * pow(6; 1/3) | fabs) < 1e-12 and
        (.bbox_mm[0][0] + .root_radius_mm | fabs) < 1e-12'
}

# a_strange_forest: writes a forest with a root without segments, types, flow shares, a segment of
# length 0, columns and comments.
a_strange_forest() {
    cat >tree.csv <<'END'
# gamma: 2.75
#  a remark that begins with two blanks
# command: corcast grow --terminals 2 -o "T é.swc"
id,parent,x_mm,y_mm,z_mm,radius_mm,type,flow_share,"wall shear [Pa]","50% <of> it","radius"
1,-1,50,0,0,0.75,3,0,1.5,2,
2,-1,0,0,0,2.385,1,0,,7,
3,2,1.5,0,0,1.25,2,0.125,3.25,,4
4,3,1.5,0,0,1.25,2,0,1e-300,1,
5,4,3,1,0.5,0.5,-7,0,0.1,2,5.5
6,4,3,-1,0.1,0,3,2.5,-2,3,
7,5,4,1,0.5,0.5,3,0,-0.3333333333333333,4,
END
}

test_nothing_is_lost_on_the_way_through_vtk_and_back() {
    local extension
    a_strange_forest
    run_ok corcast convert tree.csv before.csv
    for extension in vtp vtk; do
        run_ok corcast convert before.csv "there.$extension"
        run_ok corcast convert "there.$extension" after.csv
        expect_same before.csv after.csv
        run_ok corcast convert "there.$extension" "again.$extension"
        expect_same "there.$extension" "again.$extension"
    done
    corcast grow --terminals 77 --domain ball:20 --inlet 0,20,0 --inlet 0,-20,0 -o grown.swc --quiet
    run_ok corcast convert grown.swc grown.vtp
    run_ok corcast convert grown.vtp back.swc
    expect_same grown.swc back.swc
}

# expect_seen FILE FILTER: the jq filter is true for {seen, info}: the content that VTK's own reader
# finds, and the output of `info --json`.
expect_seen() {
    "$PYTHON" "$REPO/tests/oracle/read_vtk.py" "$1" >seen.json || fail "VTK does not read $1"
    corcast info --json "$1" >info.json || fail "info does not read $1"
    jq -s '{seen: .[0], info: .[1]}' seen.json info.json >both.json
    expect_json both.json "$2"
}

test_vtk_reads_what_is_written_and_puts_tubes_about_it() {
    local extension
    "$PYTHON" -c 'import vtkmodules' 2>/dev/null || skip "python3-vtk9 is not installed"
    corcast grow --terminals 120 -o grown.swc --quiet
    a_strange_forest
    for extension in vtp vtk; do
        run_ok corcast convert grown.swc "grown.$extension"
        expect_seen "grown.$extension" '.seen.points == 1 + 2 * 239 and .seen.lines == 239 and
            .seen.tube_strips == 24 * 239 and
            (.seen.length_mm - .info.total_length_mm | fabs) < 1e-9 and
            (.seen.volume_mm3 - .info.volume_mm3 | fabs) < 1e-9 and
            (.seen.tube_bounds[5] - .info.root_radius_mm | fabs) < 1e-6 and
            (.seen.remarks | index("gamma: 3") != null)'
        run_ok corcast convert tree.csv "strange.$extension"
        expect_seen "strange.$extension" '.seen.arrays == ["radius", "wall shear [Pa]",
            "50% <of> it", "radius_", "id", "type", "flow_share"] and .seen.lines == 3 and
            .seen.verts == 2 and .seen.remarks[1] == " a remark that begins with two blanks"'
    done
}

test_derived_fields_go_along_as_columns() {
    corcast grow --terminals 40 -o grown.swc --quiet
    run_ok corcast convert grown.swc fields.vtp --fields flow,WSS
    run_ok corcast info --json fields.vtp
    expect_json stdout '.columns == [{"name": "flow", "unit": "ml/min"}, {"name": "wss", "unit": "Pa"}]'
    run_ok corcast convert grown.swc all.csv --fields all --q-perf 250
    head -20 all.csv | grep '^id' >titles
    grep -q '"flow \[ml/min\]".*"pressure \[mmHg\]".*"strahler".*"tree"' titles || fail "got $(cat titles)"
    grep -q '250' all.csv || fail "the root segment does not carry 250 ml/min"
    run_ok corcast convert "$DATA/coronary.swc" all.vtp --fields all
    expect_sentence 'flow, velocity, pressure, wss, reynolds are left out'
    run corcast convert grown.swc some.vtp --fields flow,warmth
    expect_status 2
    expect_sentence "there is no field 'warmth'"
    run corcast convert grown.swc some.vtp --q-perf 3
    expect_status 2
    expect_sentence '^corcast convert: --q-perf .*--fields'
}

test_a_file_that_is_cut_off_or_is_something_else_is_refused() {
    local extension size cut
    a_strange_forest
    for extension in vtp vtk; do
        run_ok corcast convert tree.csv "whole.$extension"
        size=$(wc -c <"whole.$extension")
        for cut in 0 1 20 $((size / 5)) $((size / 2)) $((size * 3 / 4)); do
            head -c "$cut" "whole.$extension" >"cut.$extension"
            run corcast info "cut.$extension"
            expect_status 2
            expect_sentence "cut\\.$extension"
        done
    done
    cp whole.vtp other.vtk
    cp whole.vtk other.vtp
    head -c 4000 /dev/urandom >noise.vtp
    for cut in other.vtk other.vtp noise.vtp; do
        run corcast info "$cut"
        expect_status 2
        expect_sentence "$cut"
    done
    run_ok corcast info --input-format vtp other.vtk
    corcast info - <whole.vtk >from_pipe 2>stderr || fail "info - failed$(said)"
}

# write_zeros TYPE POINTS BLOCKS: writes bomb.vtp, whose array of radii expands to BLOCKS blocks of
# 32 MB of zeros.
write_zeros() {
    "$PYTHON" - "$@" >bomb.vtp <<'END'
import base64, struct, sys, zlib
kind, points, blocks = sys.argv[1], sys.argv[2], int(sys.argv[3])
size = 1 << 25
packed = zlib.compress(bytes(size), 1)
head = struct.pack("<%dI" % (3 + blocks), blocks, size, 0, *[len(packed)] * blocks)
print('<VTKFile type="PolyData" byte_order="LittleEndian" compressor="vtkZLibDataCompressor"><PolyData>'
      f'<Piece NumberOfPoints="{points}" NumberOfLines="1"><PointData><DataArray type="{kind}" Name="radius" '
      'format="binary">' + base64.b64encode(head).decode() + base64.b64encode(packed * blocks).decode() +
      '</DataArray></PointData></Piece></PolyData></VTKFile>')
END
}

test_a_small_file_that_unpacks_to_gigabytes_is_refused_before_it_takes_their_memory() {
    write_zeros Float32 6 32
    [ "$(stat -c %s bomb.vtp)" -lt 7000000 ] || fail "expected a small file"
    run bash -c "ulimit -v 300000; exec '$CORCAST' info bomb.vtp"
    expect_status 2
    expect_sentence "bomb.vtp:1: the array 'radius' of PointData: it announces 1.1 GB; the points and cells of its piece allow at most 24 bytes$"
    write_zeros Int8 1000000 1
    run bash -c "ulimit -v 300000; exec '$CORCAST' info bomb.vtp"
    expect_status 2
    expect_sentence 'it announces 33.6 MB; .* allow at most 1.0 MB$'
    write_zeros Int8 999999999999 100
    run bash -c "ulimit -v 300000; exec '$CORCAST' info bomb.vtp"
    expect_status 2
    expect_sentence 'bomb.vtp:1: its header states 999999999999 points; a file of [0-9.]+ MB can hold at most '
}

test_options_that_a_format_does_not_take_are_refused() {
    cp "$DATA/bifurcation.swc" tree.swc
    run corcast info tree.swc --radius-array thickness
    expect_status 2
    expect_sentence "--radius-array applies only to VTK.*; tree.swc is read as SWC"
    run corcast grow --terminals 3 --break-loops -o out.swc
    expect_status 2
    expect_sentence '--break-loops needs --from'
    run corcast info tree.swc --voxel-size 1,2
    expect_status 2
    expect_sentence '--voxel-size takes three numbers above 0'
    run corcast convert tree.swc tree.vtk --input-format vtk
    expect_status 2
    run corcast info tree.swc --input-format swcc
    expect_status 2
    expect_sentence "--input-format is 'swcc'; it must be .swc, .*, without the dot"
}

run_tests
