#!/usr/bin/env bash
# Whole-tree optimisation: `grow --refine` and `refine`.
. "$(dirname "$0")/../lib.sh"

target() {
    corcast info "$1" --json | jq .target
}

expect_lower() {
    awk -v a="$(target "$1")" -v b="$(target "$2")" -v part="$3" 'BEGIN { exit !(a < b * part) }' ||
        fail "expected $1 to have less than $3 of the target of $2: $(target "$1"), $(target "$2")"
}

test_each_level_lowers_the_target_and_keeps_the_promises_of_a_tree() {
    local level
    run_ok corcast grow --terminals 300 --seed 5 -o plain.swc
    for level in geometry topology; do
        run_ok corcast grow --terminals 300 --seed 5 --refine $level -o $level.swc
        check_tree $level.swc
        expect_stdout '^terminals 300$'
    done
    expect_lower geometry.swc plain.swc 0.995
    expect_lower topology.swc geometry.swc 1
}

test_trees_whose_viscosity_follows_the_radius_are_refined() {
    local flow
    for flow in '' '--q-perf 0.5 --terminal-flow territory'; do
        # shellcheck disable=SC2086
        run_ok corcast grow --terminals 300 --seed 5 --viscosity-law pries $flow -o plain.swc
        run_ok corcast refine plain.swc -o refined.swc
        check_tree refined.swc
        expect_lower refined.swc plain.swc 0.98
    done
    grep -v '^# hematocrit' plain.swc >without.swc
    run corcast refine without.swc -o refused.swc
    expect_status 2
    expect_sentence 'no header key hematocrit'
}

test_annealing_stays_within_its_moves_and_is_repeatable() {
    run_ok corcast grow --terminals 120 --seed 6 -o plain.swc
    run_ok corcast refine plain.swc --refine anneal --refine-moves 30000 --seed 3 -o a.swc
    run_ok corcast refine plain.swc --refine anneal --refine-moves 30000 --seed 3 -o b.swc
    expect_same a.swc b.swc
    check_tree a.swc
    expect_lower a.swc plain.swc 1
}

test_the_json_of_grow_tells_the_refined_target() {
    run_ok corcast grow --terminals 60 --refine geometry --json grow.json -o tree.swc
    run_ok corcast info tree.swc --json
    awk -v a="$(jq .target stdout)" -v b="$(jq .target grow.json)" 'BEGIN { exit !(a - b < 1e-9 * b && b - a < 1e-9 * b) }' ||
        fail "expected the target of grow.json to be the tree's"
}

test_an_interrupted_refinement_writes_the_best_tree_so_far() {
    run_ok corcast grow --terminals 400 -o plain.swc
    hearing "$CORCAST" refine plain.swc --refine anneal --refine-seconds 60 -o best.swc 2>stderr &
    local process=$!
    sleep 1
    kill -INT $process
    wait $process || fail "expected exit status 0 after SIGINT, got $?"
    check_tree best.swc
}

test_a_tree_that_cannot_be_refined_is_refused() {
    run corcast refine "$DATA/trifurcation.swc" -o refined.swc
    expect_status 2
    expect_sentence "trifurcation|binary|header|gamma|daughters"
    expect_only
    run corcast refine "$DATA/trifurcation.swc" --refine fastest -o refined.swc
    expect_status 2
    expect_sentence "refine.*fastest"
}

run_tests "$@"
