#!/usr/bin/env bash
# `info --stats`: levels, orders and bifurcations.
. "$(dirname "$0")/../lib.sh"

test_stats_add_up() {
    local table
    run_ok corcast grow --terminals 150 --seed 3 -o tree.swc
    run_ok corcast info tree.swc --stats --json
    for table in by_level by_strahler by_diameter_strahler; do
        expect_json stdout "(.stats.$table | map(.vessels) | add) == 299 and .stats.vessels == 299"
        expect_json stdout "(.total_length_mm - (.stats.$table | map(.elements * .length_mm.mean)
            | add) | fabs) < 1e-9 * .total_length_mm"
    done
    expect_json stdout '.stats.by_strahler[0] | .order == 1 and .vessels == 150'
    expect_json stdout '(.stats.by_level | length) == .max_level + 1'
    expect_json stdout '(.stats.by_strahler | length) == .max_strahler'
    expect_json stdout '.stats.strahler_ratios | .number > 2 and .diameter > 1 and .length > 1'
    expect_json stdout '.stats.diameter_orders_converged'
    expect_json stdout '.stats.symmetry.count == 149 and .stats.area_ratio.count == 149'
}

test_stats_for_people_have_three_tables() {
    grow_tree 60
    run_ok corcast info tree.swc --stats
    expect_stdout 'By bifurcation level'
    expect_stdout 'By Strahler order'
    expect_stdout 'By diameter-defined Strahler order'
    expect_stdout 'area ratio'
}

test_a_tree_stands_beside_every_published_table() {
    local name
    run_ok corcast grow --terminals 300 --seed 5 --domain ball:30 -o tree.swc
    run_ok corcast morphometries
    cut -f 1 stdout >names
    printf 'kassab-lad\nkassab-lcx\nkassab-rca\n' >expected
    expect_same names expected
    while read -r name; do
        run_ok corcast info tree.swc --morphometry "$name" --json
        expect_json stdout '.morphometry | (.source | test("Kassab")) and .compared > 20 and
            .compared == (.rows | length) and .passed == (.rows | map(select(.pass)) | length)'
        expect_json stdout '.morphometry | .orders == "published" and (.rows | all(.order == .published_order))'
        expect_json stdout '.morphometry | .counts.published == {compared, passed, passed_strict}'
        run_ok corcast info tree.swc --morphometry "$name" --orders found --json
        expect_json stdout '.morphometry.rows | map(select(.measure == "diameter")
            | .published_order - .order) | length > 3 and (unique | length) == 1'
        expect_json stdout '.morphometry | .counts.found == {compared, passed, passed_strict}'
        run_ok corcast info tree.swc --morphometry "$name"
        expect_stdout 'ratio of diameters  *all  *all'
        expect_stdout 'by published orders: [0-9]* of [0-9]* pass \([0-9]* without standard errors\)$'
    done <names
    run corcast info tree.swc --morphometry kassab
    expect_status 2
    expect_sentence "--morphometry: 'kassab' is unknown; available: kassab-lad, kassab-lcx or kassab-rca"
}

# sampled TABLE LOWEST SEED: tree.swc is sampled from a table [tests/oracle/sampled_tree.py].
sampled() {
    run_ok python3 "$REPO/tests/oracle/sampled_tree.py" "$1" "$2" "$3"
    mv stdout tree.swc
}

test_trees_sampled_from_a_table_agree_with_it() {
    local tables=$REPO/templates/morphometry name lowest seed compared
    while read -r name lowest seed compared; do
        sampled "$tables/$name.txt" "$lowest" "$seed"
        run_ok corcast info tree.swc --morphometry "$name" --json
        expect_json stdout ".morphometry | .compared == $compared and .passed >= $compared - 3 and .counts.found.passed < $compared - 3"
    done <<'END'
kassab-lad 4 1 49
kassab-lad 4 2 49
kassab-lcx 4 1 42
kassab-rca 4 1 48
END
}

test_a_tree_sampled_from_another_table_fails_where_the_tables_differ() {
    sed 's/2.50 0.080  1.91 0.111/2.50 0.080  3.5 0.111/; s/^8 462 41 4.99/8 462 41 9.5/' "$REPO/templates/morphometry/kassab-lad.txt" >other.txt
    sampled other.txt 5 3
    run_ok corcast info tree.swc --morphometry kassab-lad --json
    expect_json stdout '.morphometry.rows | map(select(.pass | not) | [.measure, .order])
        | contains([["length", 8], ["daughters two orders less", 7]])'
    run_ok corcast info tree.swc --morphometry ./other.txt --json
    expect_json stdout '.morphometry | .passed >= .compared - 3'
}

test_a_tree_of_one_segment_has_stats_without_ratios() {
    printf '1 1 0 0 0 1.5 -1\n2 3 3 0 0 1.5 1\n' >tree.swc
    run_ok corcast info tree.swc --stats --json
    expect_json stdout '.stats.vessels == 1 and .stats.strahler_ratios.number == null'
    expect_json stdout '.stats.symmetry | .count == 0 and .median == null'
    run_ok corcast info tree.swc --stats
}

test_flow_shares_and_viscosity_law_reach_the_pressures() {
    cat >tree.swc <<'END'
# p_perf_mmHg: 90
# q_perf_ml_min: 0.01
# viscosity_law: pries
# hematocrit: 0.45
# plasma_viscosity_cP: 1.2
# terminal_flow: territory
# flow_share: 3 2
# flow_share: 4 1
1 1 0 0 0 .1 -1
2 3 3 0 0 .1 1
3 3 4 1 0 .02 2
4 3 4 -1 0 .02 2
END
    run_ok corcast info tree.swc --json
    # Both were computed by hand from Poiseuille's law, with the viscosity of METHODS.md, section
    # 1.4.
    expect_json stdout '.terminal_pressure_mmHg | (.min - 37.5921283 | fabs) < 1e-6 and (.max - 63.6321965 | fabs) < 1e-6'
    run_ok corcast info tree.swc --json --viscosity 3.6
    expect_json stdout '.terminal_pressure_mmHg | (.min - 22.1269296 | fabs) < 1e-6 and (.max - 55.8915634 | fabs) < 1e-6'
    run corcast info tree.swc --viscosity-law casson
    expect_status 2
    expect_sentence 'viscosity-law.*constant, pries'
}

test_statistics_are_written_as_csv_alone() {
    grow_tree 5
    run corcast info tree.swc --stats -o s.json
    expect_status 2
    expect_sentence "'s.json' is not a file that ends in .csv"
    expect_only tree.swc
}

test_color_by_diameter_defined_order() {
    grow_tree 30
    run_ok corcast render --exact tree.swc --color-by diameter-strahler --size 40x30 -o picture.ppm
}

run_tests "$@"
