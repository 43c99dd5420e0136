#!/usr/bin/env bash
# Text formats of other programs: the contents that are read, and round trips.
. "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

test_decks_of_svonedsolver_have_their_segments_and_outlets() {
    expect_tree simvascular_oned/14_AortoFem_Pulse_RCR.in '.segments == 124 and .terminals == 9 and .bifurcations == 7'
    expect_tree simvascular_oned/Left_coronary_inlet_pressure_wave_outlet_coronary.in '.segments == 86 and .terminals == 6'
}

# tests/data/coronary.swc was made from this input file by hand, with numbers of five digits.
test_a_deck_is_the_tree_that_was_made_of_it_by_hand() {
    local deck=$SHARED/simvascular_oned/Left_coronary_inlet_pressure_wave_outlet_coronary.in
    [ -r "$deck" ] || skip "$deck is not here"
    run_ok corcast convert --quiet "$deck" deck.swc
    run_ok corcast convert --quiet "$DATA/coronary.swc" hand.swc
    # Both files contain the same segments, identified by both ends and the radius, in a different
    # order.
    awk '/^#/ { next } !seen[FILENAME]++ { file++ } { x[file, $1] = $3; y[file, $1] = $4; z[file, $1] = $5 }
         $7 > 0 { n[file]++; id[file, n[file]] = $1; up[file, n[file]] = $7; r[file, n[file]] = $6 }
         function apart(a, b) { return (x[1, a] - x[2, b]) ^ 2 + (y[1, a] - y[2, b]) ^ 2 + (z[1, a] - z[2, b]) ^ 2 > 1e-5 }
         END { for (i = 1; i <= n[1]; i++) for (k = 1; k <= n[2]; k++)
                   if (!apart(id[1, i], id[2, k]) && !apart(up[1, i], up[2, k]) && (r[1, i] - r[2, k]) ^ 2 < 1e-8) found++
               exit !(n[1] == 86 && n[2] == 86 && found == 86) }' deck.swc hand.swc ||
        fail "expected the same tree: $(paste deck.swc hand.swc | head -3)"
}

test_a_grown_tree_comes_back_from_decks_and_vmv() {
    local format
    grow_tree 60
    for format in in vmv; do
        run_ok corcast convert --quiet tree.swc tree.$format
        run_ok corcast convert --quiet tree.$format back.$format
        expect_same tree.$format back.$format
        run_ok corcast convert --quiet tree.$format again.swc
        paste <(grep -v '^#' tree.swc) <(grep -v '^#' again.swc) |
            awk '{ for (k = 1; k <= 7; k++) if (k != 2 && ($k - $(k + 7)) ^ 2 > 1e-24 * $k ^ 2) exit 1 } END { exit NR != 120 }' ||
            fail "expected the same nodes from .$format"
    done
    run_ok corcast info --json tree.in
    expect_json stdout '.gamma == 3'
}

test_trees_of_other_generators_have_their_terminals() {
    expect_tree peers/v3_100.cco '.segments == 199 and .terminals == 100 and .roots == 1'
    expect_tree peers/opencco_3d_60.dat '.segments == 118 and .terminals == 60 and .roots == 1'
}

test_networks_of_secomb_have_loops() {
    local file=$SHARED/secomb/Tumor1998.network.dat
    [ -r "$file" ] || skip "$file is not here"
    expect_tree secomb/Tumor1998.network.dat '.segments == 104 and .loops == 14 and .components == 2'
    run_ok corcast info --break-loops "$file"
    expect_stdout ' 92 points and 104 lines$'
    expect_stdout ' 14 lines cut where loops closed$'
    run_ok corcast convert --quiet --break-loops "$file" cut.csv
    [ "$(awk -F, '/^#/ { next } !n++ { for (k = 1; k <= NF; k++) if ($k ~ /boundary type/) column = k; next }
                  $column != "" { boundary++ } END { print n - 1, boundary }' cut.csv)" = "92 17" ] ||
        fail "expected 92 nodes, 17 of them with a boundary type"
    expect_tree secomb/Brain.network.dat '.segments == 50 and .loops == 3 and .components == 2'
}

# 31 columns without titles: the first six are both ends of a vessel, the 22nd is its radius.
test_a_table_without_titles_is_read_by_the_numbers_of_its_columns() {
    local table=$SHARED/peers/svv_500.csv
    [ -r "$table" ] || skip "$table is not here"
    run_ok corcast info --json --input-unit cm --columns x0=1,y0=2,z0=3,x1=4,y1=5,z1=6,radius=22 "$table"
    expect_json stdout '.segments == 999 and .terminals == 500 and .roots == 1 and (.root_radius_mm - 0.29358 | fabs) < 1e-6'
    run corcast info "$table"
    expect_status 2
    expect_sentence 'svv_500.csv:1: the table has no titles; name its columns with --columns'
}

test_a_grown_tree_comes_back_from_a_csv_of_segments() {
    grow_tree 60
    run_ok corcast convert tree.swc tree.segments.csv
    [ "$(grep -vc '^#' tree.segments.csv)" = 120 ] || fail "expected a title and a row for each segment"
    run_ok corcast convert --quiet tree.segments.csv back.swc
    cmp -s <(grep -v '^#' tree.swc) <(grep -v '^#' back.swc) || fail "expected the same nodes"
}

test_columns_of_any_name_come_back_from_a_csv_of_segments() {
    printf '%s\n' 'id,parent,x_mm,y_mm,z_mm,radius_mm,type,"vessel","value of length_mm","edge"' 1,-1,0,9,0,1,3,,, \
        2,1,0,4,0,1,3,41,2.385,1 3,2,-4,0,0,0.5,3,37.5,,2 4,2,4,0,0,0.25,3,,1,3 >tree.csv
    run_ok corcast convert tree.csv tree.segments.csv
    [ ! -s stderr ] || fail "expected nothing to be lost: $(cat stderr)"
    run_ok corcast convert tree.segments.csv back.csv
    expect_same tree.csv back.csv
}

# The rows are in another order, and the ids are not those that corcast would assign.
test_values_find_the_segments_of_a_csv_of_segments_by_its_ids() {
    printf '%s\n' id,parent,x0_mm,y0_mm,z0_mm,x1_mm,y1_mm,z1_mm,radius_mm,length_mm \
        30,12,0,4,0,4,0,0,0.25,5.65 12,7,0,9,0,0,4,0,1,5 13,12,0,4,0,-4,0,0,0.5,5.65 >tree.segments.csv
    printf '%s\n' id,age 12,41 30,2.385 13,37.5 >age.csv
    run_ok corcast convert tree.segments.csv aged.csv --values age.csv
    grep -q '^[0-9]*,[0-9]*,4,0,0,0.25,3,2.385$' aged.csv || fail "expected the age of segment 30: $(cat aged.csv)"
    run corcast render tree.segments.csv --color-by age.csv:age --size 20x20 -o aged.ppm
    expect_status 0
}

# MetaIO of ITK 5.2 wrote both files. They contain three tubes: a trunk, a tube whose parent point
# is the trunk's second point, and a tube without a parent that ends next to the trunk's last point.
# ElementSpacing is 0.5 0.5 0.25.
test_tubes_that_metaio_wrote_are_the_same_in_text_and_packed() {
    local file
    for file in tubes tubes-packed; do
        run_ok corcast convert --quiet "$DATA/metaio/$file.tre" $file.swc
        [ "$(tr '\n' ';' <$file.swc)" = "1 3 0 0 0 2 -1;2 3 0 10 2 2 1;3 3 0 20 4 1.5 2;4 3 -0.5 10.5 2 1.25 2;5 3 -5 15 3 1 4;6 3 0.5 20.5 4 1 3;7 3 7.5 30 5 0.75 6;" ] ||
            fail "expected three tubes, got $(cat $file.swc)"
    done
    run_ok corcast convert "$DATA/metaio/tubes.tre" tubes.csv
    grep -q '^5,.*,21,' tubes.csv || fail "expected the ids of the points: $(cat tubes.csv)"
}

test_a_diameter_beside_a_radius_is_a_column() {
    printf '%s\n' x0,y0,z0,x1,y1,z1,diameter_um,radius 0,0,0,5,0,0,4770,2.25 >vessels.csv
    run_ok corcast convert vessels.csv tree.csv
    grep -q '"diameter_um"$' tree.csv && grep -q '^2,1,5,0,0,2.25,3,4770$' tree.csv ||
        fail "expected the radius and the diameter: $(cat tree.csv)"
}

test_a_table_of_lines_that_is_empty_is_named() {
    printf '%s\n' id,x,y,z,radius 1,0,0,0,1 2,1,0,0,1 >nodes.csv
    : >lines.csv
    run corcast info nodes.csv --edges lines.csv
    expect_status 2
    expect_sentence 'lines.csv: the edge table has no rows$'
}

# Each file is truncated at seven positions. It is then refused in one sentence with its name, or
# read as a smaller tree.
test_files_of_all_formats_that_are_cut_off_are_refused_in_a_sentence() {
    local extension size k whole
    grow_tree 9
    for extension in csv segments.csv vtk vtp gxl graphml vmv in; do
        run_ok corcast convert --quiet tree.swc "tree.$extension"
    done
    cp "$DATA/metaio/tubes.tre" "$DATA/metaio/tubes-packed.tre" .
    tail -n +2 "$REPO/tests/fuzz/corpus/networks/vita" >tree.cco
    tail -n +2 "$REPO/tests/fuzz/corpus/networks/secomb" >tree.dat
    tail -n +2 "$REPO/tests/fuzz/corpus/networks/amira-text" >tree.am
    tail -n +2 "$REPO/tests/fuzz/corpus/networks/amira-packed" >packed.am
    tail -n +2 "$REPO/tests/fuzz/corpus/networks/amira_xml" >tree.xml
    for whole in tree.* packed.am *.tre; do
        size=$(stat -c %s "$whole")
        for ((k = 0; k < 7; k++)); do
            head -c $((size * k / 7)) "$whole" >"cut-$whole"
            run corcast info --quiet "cut-$whole"
            [ "$status" = 0 ] && continue
            expect_status 2
            expect_sentence "^corcast info: cut-$whole"
        done
    done
}

# zlib expands a byte to at most 1032 bytes, and each byte that is a number takes 9 bytes in memory.
test_a_small_spatial_graph_that_unpacks_to_gigabytes_is_refused_at_once() {
    local vertices=300000000 packed=2400000
    {
        printf '# AmiraMesh BINARY-LITTLE-ENDIAN 3.0\ndefine VERTEX %d\ndefine EDGE 1\ndefine POINT 2\n' "$vertices"
        printf 'Parameters { ContentType "HxSpatialGraph" }\nVERTEX { byte[8] zeros } @1(HxZip,%d)\n' "$packed"
        printf '# Data section follows\n@1\n'
        head -c "$packed" /dev/zero
    } >bomb.am
    run bash -c "ulimit -v 300000; exec '$CORCAST' info bomb.am"
    expect_status 2
    expect_sentence 'bomb.am:2: its header states 300000000 VERTEX; a file of 2.4 MB can hold at most '
}

test_what_a_format_has_no_place_for_is_said() {
    local extension
    printf '%s\n' id,parent,x_mm,y_mm,z_mm,radius_mm,type,flow_share,age 1,,0,9,0,1,3,0, 2,1,0,4,0,1,3,0,41 \
        3,2,-4,0,0,0.5,5,0.75,37.5 4,2,4,0,0,0.5,3,1.5, >tree.csv
    run_ok corcast convert tree.csv tree.vmv
    expect_sentence '^corcast: the columns age and the types and the flow shares are left out: the format cannot store them$'
    run_ok corcast convert tree.csv tree.segments.csv
    expect_sentence '^corcast: the types and the flow shares are left out: '
    run_ok corcast convert tree.csv tree.gxl
    [ ! -s stderr ] || fail "expected nothing to be lost: $(cat stderr)"
    sed -i 's/^1,.*/&2.385/' tree.csv
    run_ok corcast convert tree.csv tree.gxl
    expect_sentence "^corcast: the roots' values are left out: "
    run_ok corcast convert tree.csv tree.vtp
    [ ! -s stderr ] || fail "expected nothing to be lost: $(cat stderr)"
    printf '%s\n' '1 3 0 9 0 1.5 -1' '2 3 0 4 0 0.9 1' '3 3 0 4 0 0.8 2' '4 3 -4 0 0 0.5 3' '5 3 0 4 0 0.4 4' >tree.swc
    for extension in vmv segments.csv in; do
        run_ok corcast convert tree.swc "tree.$extension"
        grep -q "^corcast: the roots' own radii are left out: " stderr || fail "got of $extension: $(cat stderr)"
        grep -q '^corcast: 2 nodes share a position with another node; ' stderr || fail "got of $extension: $(cat stderr)"
        run_ok corcast info --json "tree.$extension"
        expect_json stdout '.segments == 4'
        run_ok corcast convert tree.swc "tree.$extension" --quiet
        [ ! -s stderr ] || fail "expected silence: $(cat stderr)"
    done
    run_ok corcast convert tree.swc tree.gxl
    [ ! -s stderr ] || fail "expected nothing to be lost: $(cat stderr)"
    [ -r "$SHARED/simvascular_oned/14_AortoFem_Pulse_RCR.in" ] || return 0
    run_ok corcast convert "$SHARED/simvascular_oned/14_AortoFem_Pulse_RCR.in" deck.in
    [ ! -s stderr ] || fail "expected nothing to be lost: $(cat stderr)"
}

test_ids_that_start_at_0_are_told_of() {
    printf '0 3 0 9 0 1 -1\n1 3 0 4 0 1 0\n' >tree.swc
    run_ok corcast info tree.swc
    expect_stdout 'ids start at 0 in the file; 1 was added to each'
}

# In the units of svOneDSolver, computed by hand: 60 ml/min through a radius of 2 mm are 1000 mm3/s
# at 79.6 mm/s.
test_derived_fields_become_columns_of_what_is_written() {
    printf '%s\n' '# q_perf_ml_min: 60' '# viscosity_cP: 3.5' '1 3 0 9 0 2 -1' '2 3 0 4 0 2 1' >tree.swc
    run_ok corcast convert tree.swc tree.segments.csv --fields velocity,wss
    [ "$(sed -n '3p' tree.segments.csv)" = 'id,parent,x0_mm,y0_mm,z0_mm,x1_mm,y1_mm,z1_mm,radius_mm,length_mm,"velocity [mm/s]","wss [Pa]"' ] ||
        fail "expected titles with units, got $(sed -n '3p' tree.segments.csv)"
    sed -n '4p' tree.segments.csv | awk -F, '{ exit !(($11 - 79.57747) ^ 2 < 1e-8 && ($12 - 0.5570423) ^ 2 < 1e-12) }' ||
        fail "expected velocity and shear stress, got $(sed -n '4p' tree.segments.csv)"
    run_ok corcast convert tree.swc tree.csv --fields all
    expect_sentence '^corcast: pressure are? left out: they need values that are neither in the tree nor in options$'
    run_ok corcast convert tree.swc tree.csv --fields all --p-perf 90
    [ ! -s stderr ] || fail "expected all fields: $(cat stderr)"
    run_ok corcast convert tree.swc other.csv --fields strahler --quiet
    run corcast convert tree.swc tree.csv --fields speed
    expect_status 2
    expect_sentence "there is no field 'speed'; the fields are radius, "
}

run_tests "$@"
