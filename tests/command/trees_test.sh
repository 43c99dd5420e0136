#!/usr/bin/env bash
# `info` and `convert`: what is reported about a tree, and which files are accepted as trees.
. "$(dirname "$0")/../lib.sh"

# swc: writes standard input to bad.swc.
swc() {
    cat >bad.swc
}

# expect_refused PATTERN: info, render and convert refuse bad.swc; the sentence of info matches the
# pattern.
expect_refused() {
    run corcast info bad.swc
    expect_status 2
    expect_sentence "bad\.swc.*$1|$1.*bad\.swc"
    run corcast render bad.swc -o picture.ppm --size 20x20
    expect_status 2
    run corcast convert bad.swc good.swc
    expect_status 2
    expect_only bad.swc
}

test_info_agrees_with_the_independent_checker() {
    local domain key value
    for domain in disc:50 ball:20; do
        run_ok corcast grow --terminals 90 --domain $domain --gamma 2.55 --lambda 1.5 -o tree.swc
        run_ok corcast info --json tree.swc
        mv stdout info.json
        run_ok "$CHECK_TREE" tree.swc
        while read -r key value; do
            case $key in *_deviation | short | overlaps) continue ;; esac
            expect_json info.json "(.$key - $value | fabs) <= 1e-9 * ($value | fabs)"
        done <stdout
    done
}

test_info_json_has_every_key_of_the_contract() {
    local key
    grow_tree 20
    run_ok corcast info --json tree.swc
    for key in segments terminals bifurcations total_length_mm volume_mm3 target gamma lambda \
        root_radius_mm min_radius_mm max_level max_strahler bbox_mm; do
        expect_json stdout "has(\"$key\")"
    done
}

test_info_for_people_names_the_terminals() {
    grow_tree 23
    run_ok corcast info tree.swc
    expect_stdout '23 terminals'
}

test_info_reads_standard_input() {
    grow_tree 15
    run_ok corcast info --json tree.swc
    mv stdout from_file
    corcast info --json - <tree.swc >from_pipe 2>stderr || fail "info - failed$(said)"
    expect_same from_file from_pipe
}

test_convert_of_a_grown_tree_is_the_tree_itself() {
    grow_tree 40
    run_ok corcast convert tree.swc again.swc
    expect_same tree.swc again.swc
}

test_convert_normalises_and_then_changes_nothing() {
    printf '# ORIGINAL_SOURCE hand\r\n  9 3 1.5 2 0 0.25 4\r\n\r\n4 1 0.10 0 0 .5 -1\r\n\t12 3 1.5 4 1e0 0.2 9\r\n' >raw.swc
    run_ok corcast convert raw.swc once.swc
    run_ok corcast convert once.swc twice.swc
    expect_same once.swc twice.swc
    grep -q '^# ORIGINAL_SOURCE hand$' once.swc || fail "expected the comment to be kept: $(head -3 once.swc)"
    [ "$(grep -v '^#' once.swc | tr '\n' ';')" = "1 1 0.1 0 0 0.5 -1;2 3 1.5 2 0 0.25 1;3 3 1.5 4 1 0.2 2;" ] ||
        fail "expected parents first, ids from 1 and shortest numbers, got $(grep -v '^#' once.swc | tr '\n' ';')"
    ! grep -q "$(printf '\r')" once.swc || fail "expected no carriage return"
}

test_rows_in_any_order_several_roots_and_zero_length_steps_are_fine() {
    printf '3 0 2 0 0 1 2\n1 0 0 0 0 1 -1\n2 0 2 0 0 1 1\n5 0 9 9 0 1 4\n4 0 8 8 0 1 -1\n' >forest.swc
    run_ok corcast info --json forest.swc
    expect_json stdout '.segments == 3 and .terminals == 2'
}

test_an_unknown_header_key_is_kept() {
    printf '# gamma: 2.75\n# surgeon: anonymous\n1 1 0 0 0 1 -1\n2 3 3 0 0 1 1\n' >tree.swc
    run_ok corcast convert tree.swc out.swc
    expect_same tree.swc out.swc
}

test_csv_holds_all_that_swc_does() {
    local options
    for options in '' '--terminal-flow territory --viscosity-law pries' '--inlet 0,50 --inlet 30,-40'; do
        # shellcheck disable=SC2086
        run_ok corcast grow --terminals 12 --seed 5 --q-perf 3 $options -o tree.swc
        run_ok corcast convert tree.swc tree.CSV
        run_ok corcast convert tree.CSV again.swc
        expect_same tree.swc again.swc
    done
}

test_a_tree_on_standard_input_is_told_by_its_first_bytes() {
    grow_tree 7
    run_ok corcast convert tree.swc tree.csv
    grep -v '^#' tree.csv >bare.csv
    local file
    for file in segments.csv vtk vtp gxl graphml vmv in; do
        run_ok corcast convert --quiet tree.swc "tree.$file"
    done
    for file in bare.csv tree.*; do
        run_ok corcast info - --json <"$file"
        expect_json stdout '.terminals == 7'
    done
    printf '*Tree\n0 9 0 1 1 1 1 1 1 1 1 1\n\n*Vessels\n1\n' | run corcast info -
    expect_sentence 'standard input: the file has no section \*Connectivity'
}

test_a_column_of_a_csv_colors_its_segments() {
    printf '%s\n' 'id,parent,x_mm,y_mm,z_mm,radius_mm,age [a]' 1,,0,9,0,1, 2,1,0,4,0,1,41 3,2,-4,0,0,0.5,37.5 \
        4,2,4,0,0,0.5, >tree.csv
    run_ok corcast render --exact tree.csv --color-by age --range 30,50 --size 40x30 -o age.ppm
    run_ok corcast render --exact tree.csv --color-by radius --range 30,50 --size 40x30 -o radius.ppm
    ! cmp -s age.ppm radius.ppm || fail "expected the ages to be seen"
    run corcast render tree.csv --color-by weight --size 40x30 -o weight.ppm
    expect_status 2
    expect_sentence "weight.*branch,.* age"
    run_ok corcast info tree.csv
    expect_stdout '^  columns       age \(a\)$'
    run_ok corcast info tree.csv --json
    expect_json stdout '.columns == [{name: "age", unit: "a"}]'
    run corcast render tree.csv --color-by aeg --size 40x30 -o weight.ppm
    expect_sentence "did you mean age?"
    run_ok corcast convert tree.csv tree.swc
    grep -q "^corcast: the columns age are left out: the format cannot store" stderr || fail "got $(cat stderr)"
    run_ok corcast convert tree.csv other.csv
    [ ! -s stderr ] || fail "expected nothing to be lost: $(cat stderr)"
}

test_growing_on_keeps_columns_and_refining_says_that_they_go() {
    printf '%s\n' '# domain: disc:50' id,parent,x_mm,y_mm,z_mm,radius_mm,age 11,,0,50,0,1, 12,11,0,20,0,1,41 \
        13,12,-15,5,0,0.5,37.5 14,12,15,5,0,0.5, >tree.csv
    run_ok corcast grow --from tree.csv --terminals 6 --q-perf 3 -o grown.csv
    [ "$(cut -d, -f1,8 grown.csv | grep -E '^1[1-4],' | sort | tr '\n' ';')" = "11,;12,41;13,37.5;14,;" ] ||
        fail "expected the given ages to stay: $(cat grown.csv)"
    [ "$(grep -c ',age$\|,"age"$' grown.csv)" = 1 ] || fail "expected the column: $(head -20 grown.csv)"
    run_ok corcast grow --from tree.csv --terminals 6 --q-perf 3 -o grown.swc
    grep -q "^corcast: the columns age are left out" stderr || fail "got $(cat stderr)"
    run_ok corcast refine grown.csv -o refined.csv
    grep -q "^corcast: the columns age are left out, because their segments move$" stderr || fail "got $(cat stderr)"
    ! grep -q age refined.csv || fail "expected no ages"
}

test_the_formats_of_trees_are_listed_and_hinted_at() {
    run_ok corcast formats
    expect_stdout "^\.swc	SWC	"
    expect_stdout "^\.csv	CSV	"
    local command
    for command in "info tree.scw" "grow --terminals 3 -o tree.scw" "convert tree.scw tree.swc"; do
        # shellcheck disable=SC2086
        run corcast $command
        expect_status 2
        expect_sentence "tree\.scw.*\.swc.* or \..*did you mean \.swc?"
    done
}

test_an_extension_that_is_no_tree_is_refused() {
    grow_tree 3
    run corcast convert tree.swc tree.docx
    expect_status 2
    expect_sentence "docx"
    expect_only tree.swc
}

test_a_missing_file_is_refused_by_name() {
    local command
    for command in info "render -o a.ppm" "scene -o a.pov" "verify -o a"; do
        # shellcheck disable=SC2086
        run corcast $command nowhere.swc
        expect_status 2
        expect_sentence "nowhere\.swc"
    done
    expect_only
}

test_a_folder_is_not_a_tree() {
    mkdir folder
    run corcast info folder
    expect_status 2
    expect_sentence "folder"
}

test_a_row_of_six_fields_is_refused_with_its_line() {
    printf '1 1 0 0 0 1 -1\n2 3 3 0 0 1\n' | swc
    expect_refused ':2'
}

test_a_row_of_eight_fields_is_refused_with_its_line() {
    printf '# head\n1 1 0 0 0 1 -1\n2 3 3 0 0 1 1 7\n' | swc
    expect_refused ':3'
}

test_a_word_among_the_numbers_is_refused_with_its_line() {
    printf '1 1 0 0 0 1 -1\n2 3 3 zero 0 1 1\n' | swc
    expect_refused ':2.*zero'
}

test_a_duplicate_id_is_refused_with_its_line() {
    printf '1 1 0 0 0 1 -1\n2 3 3 0 0 1 1\n2 3 4 0 0 1 1\n' | swc
    expect_refused ':3'
}

test_an_unknown_parent_is_refused_with_its_line() {
    printf '1 1 0 0 0 1 -1\n2 3 3 0 0 1 8\n' | swc
    expect_refused ':2.*8'
}

test_a_cycle_is_refused() {
    printf '1 1 0 0 0 1 -1\n2 3 3 0 0 1 4\n3 3 4 0 0 1 2\n4 3 5 0 0 1 3\n' | swc
    expect_refused 'its own ancestor|[Cc]ycle'
}

test_a_node_that_is_its_own_parent_is_refused() {
    printf '1 1 0 0 0 1 -1\n2 3 3 0 0 1 2\n' | swc
    expect_refused ''
}

test_a_coordinate_that_is_not_a_number_is_refused_with_its_line() {
    printf '1 1 0 0 0 1 -1\n2 3 nan 0 0 1 1\n' | swc
    expect_refused ':2'
    printf '1 1 0 0 0 1 -1\n2 3 inf 0 0 1 1\n' | swc
    expect_refused ':2'
}

test_a_negative_radius_is_refused_with_its_line() {
    printf '1 1 0 0 0 1 -1\n2 3 3 0 0 -0.5 1\n' | swc
    expect_refused ':2.*-0\.5'
}

test_a_file_without_rows_is_refused() {
    printf '# only a comment\n' | swc
    expect_refused ''
    : | swc
    expect_refused ''
}

test_a_picture_is_not_a_tree() {
    head -c 3000 "$CORCAST" | swc
    expect_refused ''
}

test_measured_trees_are_read() {
    [ -d "$SHARED/brava" ] || skip "the measured trees of ../shared/data/brava are not here"
    local file rows
    for file in "$SHARED"/brava/*.swc; do
        rows=$(grep -cE '^[[:space:]]*[0-9]' "$file")
        run_ok corcast info --json "$file"
        expect_json stdout ".segments < $rows and .segments >= $rows - 20"
        run_ok corcast convert "$file" normal.swc
        run_ok corcast convert normal.swc again.swc
        expect_same normal.swc again.swc
        run_ok corcast render --exact "$file" --model rounded --size 60x40 -o picture.ppm
    done
}

test_what_needs_flow_is_refused_where_the_tree_says_nothing_of_it() {
    printf '1 1 0 0 0 1 -1\n2 3 3 0 0 1 1\n' >tree.swc
    run_ok corcast info --json tree.swc
    expect_json stdout '.segments == 1 and .gamma == null'
}

run_tests "$@"
