#!/usr/bin/env bash
# Files that are almost trees: what the program reports about them, and what options repair.
. "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

# vtk_lines POINTS LINES MORE: prints a legacy VTK file with the points, the lines, each like "2 0
# 1", and the arrays MORE.
vtk_lines() {
    local points lines
    points=$(wc -l <<<"$1")
    lines=$(wc -l <<<"$2")
    printf '# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS %d double\n%s\nLINES %d %d\n%s\n%s\n' \
        "$points" "$1" "$lines" "$((3 * lines))" "$2" "$3"
}

test_lines_between_the_same_points_are_vessels_of_their_own() {
    vtk_lines $'0 0 0\n0 0 10\n0 0 20' $'2 0 1\n2 1 2\n2 1 2' \
        $'CELL_DATA 3\nSCALARS radius double\nLOOKUP_TABLE default\n3 2 3' >twins.vtk
    run_ok corcast info --json twins.vtk
    expect_json stdout '.loops == 1 and .segments == 3 and .min_radius_mm == 2 and .bifurcations == 1'
    run_ok corcast info --json --break-loops twins.vtk
    expect_json stdout '.reading.network.loops == 1 and .reading.network.repeated_lines == 0 and .min_radius_mm == 3'
}

test_lines_that_differ_in_a_column_alone_are_vessels_of_their_own() {
    vtk_lines $'0 0 0\n0 0 10\n0 0 20' $'2 0 1\n2 1 2\n2 2 1' \
        $'CELL_DATA 3\nSCALARS radius double\nLOOKUP_TABLE default\n3 2 2\nSCALARS flow double\nLOOKUP_TABLE default\n5 2 3' >twins.vtk
    run_ok corcast info --json --break-loops twins.vtk
    expect_json stdout '.reading.network.loops == 1 and .reading.network.repeated_lines == 0'
    sed -i 's/^5 2 3/5 2 2/' twins.vtk
    run_ok corcast info --json twins.vtk
    expect_json stdout '.reading.network.loops == 0 and .reading.network.repeated_lines == 1'
}

# Each polyline leads from the root to one outlet, and has its own number.
test_polylines_may_overlap_whatever_their_numbers_are() {
    printf '# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 4 double\n0 0 0\n0 0 10\n0 5 20\n0 -5 20\nLINES 2 8\n3 0 1 2\n3 0 1 3\nCELL_DATA 2\nSCALARS path int\nLOOKUP_TABLE default\n1 2\nPOINT_DATA 4\nSCALARS radius double\nLOOKUP_TABLE default\n2 2 1 1\n' >paths.vtk
    run_ok corcast info --json paths.vtk
    expect_json stdout '.segments == 3 and .reading.network.repeated_lines == 1'
}

test_ends_that_miss_another_tree_are_reported_and_joined() {
    vtk_lines $'0 0 0\n0 0 10\n0 0.0009 10\n0 5 20' $'2 0 1\n2 2 3' \
        $'CELL_DATA 2\nSCALARS radius double\nLOOKUP_TABLE default\n0.5 0.4' >gap.vtk
    run corcast info gap.vtk
    expect_status 0
    expect_sentence 'gap.vtk: ends of trees that are at most 0.0009 mm from another tree: 2; --merge-tolerance 0.00091 joins them'
    run_ok corcast info --json --merge-tolerance 0.00091 gap.vtk
    [ ! -s stderr ] || fail "expected no report: $(cat stderr)"
    expect_json stdout '.roots == 1 and .segments == 2'
}

test_trees_that_stand_apart_are_not_reported() {
    vtk_lines $'0 0 0\n0 0 10\n0 1 10\n0 5 20' $'2 0 1\n2 2 3' \
        $'CELL_DATA 2\nSCALARS radius double\nLOOKUP_TABLE default\n0.5 0.4' >apart.vtk
    run_ok corcast info apart.vtk
    [ ! -s stderr ] || fail "expected no report: $(cat stderr)"
}

# reported GAP LENGTH RADIUS OTHER: succeeds if an end that misses another tree's axis by GAP mm is
# reported. The last line before the end is LENGTH mm long and has the radius RADIUS mm; the other
# tree has the radius OTHER mm.
reported() {
    vtk_lines "$(awk -v gap="$1" -v length_mm="$2" 'BEGIN {
        printf "0 0 0\n0 0 %.9g\n0 0 10\n0 %.9g 10\n-5 %.9g 10\n5 %.9g 10\n9 %.9g 10\n", 10 - length_mm, gap, gap, gap, gap
    }')" $'2 0 1\n2 1 2\n2 4 3\n2 3 5\n2 5 6' \
        $'CELL_DATA 5\nSCALARS radius double\nLOOKUP_TABLE default\n'"$3 $3 $4 $4 $4" >gap.vtk
    run corcast info gap.vtk
    expect_status 0
    grep -q 'mm from another tree' stderr
}

# reported_below GAP LENGTH RADIUS OTHER: a gap of GAP with a digit 9 appended is reported, and a
# gap that is 3 % larger is not.
reported_below() {
    local gap=$1
    shift
    reported "${gap}9" "$@" || fail "expected a report of a gap of ${gap}9 mm: $*"
    ! reported "$(awk -v gap="${gap}9" 'BEGIN { print gap * 1.03 }')" "$@" || fail "expected no report of a gap above ${gap}9 mm: $*"
}

test_ends_are_near_within_the_radius_and_half_the_last_line() {
    reported_below 0.49 3 0.5 0.5
    reported_below 0.09 0.2 0.5 0.5
    reported_below 0.0249 0.02 0.5 0.5
    reported_below 0.19 3 0.5 0.2
}

test_bad_radii_are_repaired_when_asked() {
    printf '1 3 0 0 0 2 -1\n2 3 0 10 0 1.5 1\n3 3 0 20 0 -0.14 2\n4 3 5 20 0 NaN 3\n5 3 9 20 0 1 4\n' >bad.swc
    run corcast info bad.swc
    expect_status 2
    expect_sentence "bad.swc:3: the radius is '-0.14'; .* \(--repair-radii replaces it, from its neighbors\)"
    run corcast convert --repair-radii bad.swc good.swc
    expect_status 0
    expect_sentence 'bad.swc: 2 radii were repaired from their neighbors'
    [ "$(awk '/^[0-9]/ { printf "%.4f ", $6 }' good.swc)" = "2.0000 1.5000 1.2727 1.1023 1.0000 " ] ||
        fail "expected radii between those of the neighbours: $(cat good.swc)"
    printf 'id,parent,x_mm,y_mm,z_mm,radius_mm\n1,,0,0,0,inf\n2,1,0,0,9,2\n3,2,0,0,12,-1\n' >bad.csv
    run_ok corcast convert --quiet --repair-radii bad.csv good.swc
    [ "$(awk '/^[0-9]/ { printf "%s ", $6 }' good.swc)" = "2 2 2 " ] || fail "expected 2 throughout: $(cat good.swc)"
    vtk_lines $'0 0 0\n0 0 10\n0 5 20' $'2 0 1\n2 1 2' \
        $'POINT_DATA 3\nSCALARS radius double\nLOOKUP_TABLE default\n2 1 nan' >bad.vtk
    run_ok corcast info --json --repair-radii bad.vtk
    expect_json stdout '.min_radius_mm == 1 and .reading.repaired_radii == 1'
}

# Files that corcast writes have a radius at each node.
test_a_missing_radius_of_the_programs_own_files_is_refused_or_repaired() {
    grow_tree 4
    run_ok corcast convert --quiet tree.swc own.graphml
    sed -i '0,/<data key="v3">[^<]*</s//<data key="v3">nan</' own.graphml
    run corcast info own.graphml
    expect_status 2
    expect_sentence "own.graphml: .*the radius is 'nan'"
    run_ok corcast info --quiet --json --repair-radii own.graphml
    expect_json stdout '.segments == 7'
}

test_a_radius_is_given_to_vessels_without_one() {
    printf '1 1 0 0 0 0 -1\n2 3 0 10 0 0 1\n3 3 0 20 0 2 2\n' >a.swc
    vtk_lines $'0 0 0\n0 0 10\n0 0 20' $'2 0 1\n2 1 2' '' >a.vtk
    printf 'id,parent,x_mm,y_mm,z_mm\n1,,0,0,0\n2,1,0,10,0\n3,2,0,20,0\n' >a.csv
    printf 'x0,y0,z0,x1,y1,z1\n0,0,0,0,10,0\n0,10,0,0,20,0\n' >b.csv
    printf '<graphml><key id="x" for="node" attr.name="x"/><key id="y" for="node" attr.name="y"/><graph><node id="a"><data key="x">0</data><data key="y">0</data></node><node id="b"><data key="x">9</data><data key="y">0</data></node><edge source="a" target="b"/></graph></graphml>\n' >a.graphml
    printf 'ObjectType = Tube\nNDims = 3\nID = 1\nNPoints = 2\nPointDim = x y z\nPoints = \n0 0 0\n0 0 9\n' >a.tre
    printf '# AmiraMesh ASCII 1.0\ndefine Lines 3\ndefine Vertices 2\nParameters { ContentType "HxLineSet" }\nVertices { float[3] Coordinates } = @1\nLines { int LineIdx } = @2\n@1\n0 0 0\n0 0 9\n@2\n0 1 -1\n' >a.am
    local file
    for file in a.vtk a.csv b.csv a.graphml a.tre a.am; do
        run corcast info "$file"
        expect_status 2
        run corcast info --json --radius 0.25 "$file"
        expect_status 0
        expect_sentence '[0-9]+ segments? without a radius got the radius of --radius'
        expect_json stdout '.root_radius_mm == 0.25 and .min_radius_mm == 0.25'
    done
    run corcast convert --radius 0.25 a.swc b.swc
    expect_sentence '1 segments? without a radius got the radius of --radius'
    [ "$(awk '/^[0-9]/ { printf "%s ", $6 }' b.swc)" = "0.25 0.25 2 " ] || fail "expected 0.25 for 0: $(cat b.swc)"
    run_ok corcast render --quiet --radius 0.25 --size 40x40 a.vtk -o a.png
}

test_decimal_commas_are_named() {
    printf '1 1 10,5 0,5 0,0 1,5 -1\n2 3 10,5 20,5 0,0 1,5 1\n' >comma.swc
    printf '1;1;10,5;0,5;0;1,5;-1\n' >semicolon.swc
    printf 'x0;y0;z0;x1;y1;z1;radius\n0,5;0;0;1;1;1;1\n' >comma.csv
    printf '$VERT_LIST_BEGIN\n1 0,5 0 0 1\n$VERT_LIST_END\n' >comma.vmv
    printf 'MODEL m\nNODE 0 0,5 0 0\n' >comma.in
    printf '0,5 0 0 1 1 1 1\n' >comma.dat
    printf '*Tree\n1\n*Vessels\n1\n0 0,5 0 0 1 1 1 0 0 0 0 0 1\n' >comma.cco
    vtk_lines $'0,5 0 0\n0 0 10' '2 0 1' '' >comma.vtk
    printf 'ObjectType = Tube\nID = 1\nNPoints = 1\nPointDim = x y z r\nPoints = \n0,5 0 0 1\n' >comma.tre
    printf '# AmiraMesh ASCII 1.0\ndefine Lines 3\ndefine Vertices 2\nParameters { ContentType "HxLineSet" }\nVertices { float[3] Coordinates } = @1\nLines { int LineIdx } = @2\n@1\n0,5 0 0\n0 0 9\n@2\n0 1 -1\n' >comma.am
    printf '<gxl><graph><node id="a"><attr name=" position"><tup><float>0,5</float><float>0</float></tup></attr></node></graph></gxl>\n' >comma.gxl
    printf '<VTKFile type="PolyData"><PolyData><Piece NumberOfPoints="1"><Points><DataArray type="Float32" NumberOfComponents="3">0,5 0 0</DataArray></Points></Piece></PolyData></VTKFile>\n' >comma.vtp
    local file
    for file in comma.* semicolon.swc; do
        run corcast info "$file"
        expect_status 2
        expect_sentence "$file:[0-9]+: .*decimal comma"
    done
}

test_fields_between_commas_are_no_decimal_commas() {
    printf '1,1,10,5,0,1,-1\n2,3,10,20,0,1,1\n' >a.swc
    run_ok corcast info --json a.swc
    expect_json stdout '.segments == 1'
    printf '1, 1, 10, 5, 0, 1, -1\n2, 3, 10, 20, 0, 1, 1\n' >b.swc
    run_ok corcast info --json b.swc
    expect_json stdout '.segments == 1'
}

test_info_of_a_tree_without_segments_has_no_nan() {
    printf '1 1 0 0 0 5 -1\n' >point.swc
    run_ok corcast info point.swc
    if grep -i nan stdout; then fail "expected no nan: $(cat stdout)"; fi
    expect_stdout '  radius        5 mm at the root$'
}

test_an_index_names_files_only() {
    grow_tree 4
    run_ok corcast convert --quiet tree.swc tree.vtp
    local name
    mkfifo pipe.vtp && mkdir folder.vtp
    for name in - pipe.vtp folder.vtp; do
        printf '<VTKFile type="Collection"><Collection><DataSet timestep="0" file="%s"/></Collection></VTKFile>\n' "$name" >index.pvd
        timeout 300 "$CORCAST" info index.pvd <tree.vtp >stdout 2>stderr
        status=$? command_line="info index.pvd, which names $name"
        expect_status 2
        expect_sentence "index.pvd:1: (./)?$name: (unknown extension|is )"
    done
}

test_an_index_need_not_state_times() {
    grow_tree 4
    run_ok corcast convert --quiet tree.swc a.vtp --fields flow
    run_ok corcast convert --quiet tree.swc b.vtp --fields flow --q-perf 7
    printf '<VTKFile type="Collection"><Collection><DataSet file="a.vtp"/></Collection></VTKFile>\n' >one.pvd
    run_ok corcast info --json one.pvd
    expect_json stdout '.segments == 7 and .columns[0].name == "flow"'
    printf '<VTKFile type="Collection"><Collection><DataSet file="a.vtp"/><DataSet file="b.vtp"/></Collection></VTKFile>\n' >two.pvd
    run_ok corcast info --json two.pvd
    expect_json stdout '[.columns[].name] == ["flow_0", "flow_1"]'
    sed -i 's/file="b/timestep="1" file="b/' two.pvd
    run corcast info two.pvd
    expect_sentence 'two.pvd: 1 of 2 DataSets have no timestep'
}

test_an_index_says_that_vessels_that_move_are_read_at_rest() {
    grow_tree 4
    run_ok corcast convert --quiet tree.swc a.vtp
    awk '!/^#/ { $6 *= 1.1 } { print }' tree.swc >wide.swc
    run_ok corcast convert --quiet wide.swc b.vtp
    local other
    for other in a b; do
        printf '<VTKFile type="Collection"><Collection><DataSet timestep="0" file="a.vtp"/><DataSet timestep="1" file="%s.vtp"/></Collection></VTKFile>\n' $other >$other.pvd
        run_ok corcast info --json $other.pvd
    done
    expect_json stdout '.reading.assumed[0] | startswith("positions or radii change with time")'
    run_ok corcast info --json a.pvd
    expect_json stdout '.reading.assumed == []'
}

test_radii_of_moments_are_given_and_repaired() {
    vtk_lines $'0 0 0\n0 0 10\n0 0 20' $'2 0 1\n2 1 2' '' >none.vtk
    vtk_lines $'0 0 0\n0 0 10\n0 0 20' $'2 0 1\n2 1 2' $'CELL_DATA 2\nSCALARS radius double\nLOOKUP_TABLE default\n2 nan' >bad.vtk
    local name
    for name in none bad; do
        printf '<VTKFile type="Collection"><Collection><DataSet file="%s.vtk"/></Collection></VTKFile>\n' $name >$name.pvd
        run corcast info $name.pvd
        expect_status 2
    done
    run_ok corcast info --json --radius 0.25 none.pvd
    expect_json stdout '.min_radius_mm == 0.25'
    run_ok corcast info --json --repair-radii bad.pvd
    expect_json stdout '.min_radius_mm == 2'
}

test_a_domain_in_a_header_is_no_standard_input() {
    grow_tree 4
    printf '# domain: mask:-,1\n' | cat - tree.swc | grep -v '# domain: disc' >piped.swc
    timeout 10 "$CORCAST" refine piped.swc -o out.swc <tree.swc >stdout 2>stderr
    status=$? command_line="refine piped.swc"
    expect_status 2
    expect_sentence 'the domain mask:-,1 was read from standard input'
}

test_flow_shares_that_a_format_lacks_are_left_out_with_their_key() {
    local format
    run_ok corcast grow --quiet --terminals 12 --terminal-flow territory -o tree.swc
    for format in vmv in segments.csv; do
        run corcast convert tree.swc out.$format
        expect_status 0
        grep -q 'the flow shares and the key terminal_flow' stderr || fail "expected a report: $(cat stderr)"
        run_ok corcast info out.$format
    done
}

test_the_unit_of_the_programs_own_trees_is_known() {
    run_ok corcast grow --quiet --terminals 30 --domain disc:3000 --q-perf 5e6 -o large.swc
    run_ok corcast info --json large.swc
    [ ! -s stderr ] || fail "expected no report: $(cat stderr)"
    expect_json stdout '.reading.unit_said and .reading.unit == "mm" and .reading.median_radius_mm > 2.5'
    run_ok corcast bifurcation --quiet --radii 30 -o large.swc
    run_ok corcast info large.swc
    [ ! -s stderr ] || fail "expected no report: $(cat stderr)"
    run_ok corcast figure fig2 -o fig2.pdf
    [ ! -s stderr ] || fail "expected no report: $(cat stderr)"
}

# A compressed file of a few kilobytes that really contains three million points and as many
# numbers.
test_a_small_file_does_not_unpack_to_a_large_tree() {
    python3 - <<'PY'
import struct, zlib
def block(size):
    packed = zlib.compress(bytes(1 << 20), 9)
    n = size >> 20
    return struct.pack('<%dI' % (3 + n), n, 1 << 20, 0, *[len(packed)] * n) + packed * n
def vtp(name, points, array):
    head = ('<VTKFile type="PolyData" byte_order="LittleEndian" compressor="vtkZLibDataCompressor"><PolyData><Piece NumberOfPoints="%d" '
            'NumberOfLines="1"><PointData><DataArray type="UInt8" Name="radius" format="appended" offset="0" NumberOfComponents="%d"/></PointData>'
            '</Piece></PolyData><AppendedData encoding="raw">_' % (points, array))
    open(name, 'wb').write(head.encode() + block(48 << 20) + b'</AppendedData></VTKFile>')
vtp('points.vtp', 48 << 20, 1)
vtp('numbers.vtp', 1 << 19, 96)
open('keys.graphml', 'w').write('<graphml>' + ''.join('<key id="%d" for="node"><default>1</default></key>' % i for i in range(2000)) + '<graph>'
                                + ''.join('<node id="%d"/>' % i for i in range(20000)) + '</graph></graphml>')
PY
    local file
    for file in points.vtp numbers.vtp keys.graphml; do
        (ulimit -v 700000 && exec timeout 300 "$CORCAST" info $file) >stdout 2>stderr
        status=$? command_line="info $file"
        expect_status 2
        expect_sentence "$file:.*a file of [0-9.]+ .B (can hold|may unpack to) at most"
    done
}

test_memory_is_for_the_rows_and_not_for_the_largest_id() {
    printf '1 1 0 0 0 2 -1\n100000000 3 0 0 8 1 1\n' >far.swc
    run_ok corcast convert --quiet far.swc near.gxl
    printf 'id,parent,x_mm,y_mm,z_mm,radius_mm\n1,,0,0,0,2\n100000000,1,0,0,8,1\n' >far.csv
    local format file
    for format in vtk vtp graphml; do
        run_ok corcast convert --quiet far.swc near.$format
    done
    sed 's/<data key="v4">2</<data key="v4">100000000</' near.graphml >far.graphml
    for file in far.*; do
        (ulimit -v 250000 && exec "$CORCAST" info --json "$file") >stdout 2>stderr
        status=$? command_line="info $file"
        expect_status 0
        expect_json stdout '.segments == 1'
    done
    printf '100000000 3 0 0 9 1 1\n' >>far.swc
    run corcast info far.swc
    expect_sentence 'far.swc:3: the id 100000000 is already that of line 2'
}

test_names_do_not_turn_the_text_around() {
    local name=$'a\xe2\x80\xaeb\xe2\x81\xa6c.txt'
    printf '0 0\n40 0\n40 40\n0 40\n' >"$name"
    run_ok corcast grow --quiet --terminals 4 --domain "polygon:$name" -o tree.swc
    run_ok corcast render --quiet --size 40x40 tree.swc -o page.svg
    if LC_ALL=C.UTF-8 grep -lP '[\x{061c}\x{200e}\x{200f}\x{202a}-\x{202e}\x{2066}-\x{2069}]' tree.swc page.svg; then
        fail "expected no characters that set the direction of text"
    fi
}

run_tests "$@"
