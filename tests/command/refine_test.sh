#!/usr/bin/env bash
# Optimisation of the whole tree: `grow --refine` and `refine`.
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

test_trees_whose_viscosity_or_exponent_follows_the_radius_are_refined() {
    local flow
    for flow in '' '--q-perf 0.5 --terminal-flow territory'; do
        # shellcheck disable=SC2086
        run_ok corcast grow --terminals 300 --seed 5 --viscosity-law pries $flow -o plain.swc
        run_ok corcast refine plain.swc -o refined.swc
        check_tree refined.swc
        expect_lower refined.swc plain.swc 0.98
    done
    run_ok corcast grow --terminals 300 --seed 5 --gamma 0.05:3,1:2.2 -o curve.swc
    run_ok corcast refine curve.swc --refine topology -o refined.swc
    check_tree refined.swc
    expect_lower refined.swc curve.swc 0.97
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

test_cycles_side_by_side_give_the_same_bytes_on_any_number_of_threads() {
    local threads
    run_ok corcast grow --terminals 14 --seed 4 --relax 0 -o plain.swc
    run_ok corcast refine plain.swc --refine anneal --refine-moves 4000 -o cycle.swc
    run_ok corcast refine plain.swc --refine anneal --refine-moves 30000 --threads 1 -o one.swc --json one.json
    expect_json one.json '.moves_tried > 10000 and .moves_tried <= 30000'
    for threads in 2 5; do
        run_ok corcast refine plain.swc --refine anneal --refine-moves 30000 --threads $threads -o many.swc
        expect_same one.swc many.swc
    done
    check_tree one.swc
    expect_lower one.swc cycle.swc 1.000001
}

test_the_json_of_grow_tells_the_refined_target_and_root() {
    run_ok corcast grow --terminals 60 --inlet 0,50 --inlet 0,-50 --inlet-shares 0.2,0.8 --refine geometry --json grow.json -o tree.swc
    run_ok corcast info tree.swc --json
    jq -e --slurpfile said grow.json '$said[0] as $s | (.target - $s.target | fabs) < 1e-9 * .target and
        .root_radius_mm == $s.root_radius_mm' stdout >jq.out || fail "expected grow.json to tell the tree's target and root"
}

test_vessels_that_stay_in_each_others_way_are_counted() {
    run_ok corcast grow --terminals 230 --domain rect:4,30 --gamma 2 --seed 5 --p-term 80 --refine geometry --json grow.json -o tree.swc --quiet
    [ "$(jq .broken grow.json)" -gt 10 ] || fail "expected broken rules: $(jq .broken grow.json)"
    grep -qx "corcast: $(jq .broken grow.json) segments are still shorter than wide or too close to other segments" stderr ||
        fail "expected their number$(said)"
    run_ok corcast refine tree.swc --refine geometry --json refined.json -o refined.swc --quiet
    grep -qx "corcast: $(jq .broken refined.json) segments are still shorter than wide or too close to other segments" stderr ||
        fail "expected their number$(said)"
    run_ok corcast grow --terminals 60 -o clear.swc
    run_ok corcast refine clear.swc --refine geometry --json clear.json -o refined.swc --quiet
    expect_json clear.json '.broken == 0'
    [ ! -s stderr ] || fail "expected silence$(said)"
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

# terminals_by_tree FILE: prints the positions of the roots and, per root, of its terminals, sorted.
terminals_by_tree() {
    awk '/^#/ { next } { parent[$1] = $7; at[$1] = $3 " " $4 " " $5; is_parent[$7] = 1; id[++n] = $1 }
         END { for (k = 1; k <= n; k++) {
             i = id[k]
             if (parent[i] == -1) { tree[i] = at[i]; print "root", at[i] } else tree[i] = tree[parent[i]]
             if (!(i in is_parent)) print tree[i], "has", at[i] } }' "$1" | sort
}

test_forests_are_refined_each_tree_with_its_terminals() {
    local level
    run_ok corcast grow --terminals 400 --inlet 0,50 --inlet 3,-40.5 --inlet-shares 0.7,0.3 -o plain.swc
    for level in geometry topology; do
        run_ok corcast refine plain.swc --refine $level -o $level.swc
        check_tree $level.swc
        expect_stdout '^short 0$'
        expect_stdout '^overlaps 0$'
        [ "$(terminals_by_tree $level.swc)" = "$(terminals_by_tree plain.swc)" ] || fail "expected the same terminals on each tree"
    done
    expect_lower geometry.swc plain.swc 0.985
    expect_lower topology.swc geometry.swc 0.99
    run_ok corcast grow --terminals 60 --inlet 0,50 --inlet 3,-40.5 --refine geometry -o grown.swc
}

# T has a local minimum where a bifurcation is next to an end, and a lower one farther upstream.
test_forks_leave_ends_that_they_were_caught_at() {
    cat >caught.swc <<'END'
# gamma: 3
# lambda: 2
# p_perf_mmHg: 100
# p_term_mmHg: 60
# q_perf_ml_min: 1e-6
# viscosity_cP: 3.6
1 3 0 50 0 0.00647 -1
2 3 0 49.984 0 0.00647 1
3 3 3.884 36.270 0 0.00618 2
4 3 13.296 25.469 0 0.00539 3
5 3 13.301 25.453 0 0.000663 4
6 3 33.989 5.402 0 0.00538 4
7 3 33.955 5.298 0 0.00162 6
8 3 46.131 1.405 0 0.00533 6
9 3 -22.317 -2.116 0 0.0043 3
10 3 -18.526 44.423 0 0.00324 2
END
    run_ok corcast refine caught.swc --refine topology -o free.swc --json free.json
    expect_json free.json '.target < 0.987 * .target_before'
}

test_vessels_of_several_segments_become_straight() {
    cat >bent.swc <<'END'
# domain: rect:40,40
# dimension: 2
# gamma: 3
# lambda: 2
# p_perf_mmHg: 100
# p_term_mmHg: 60
# q_perf_ml_min: 40
# viscosity_cP: 3.6
1 2 0 19.5 0 1 -1
2 2 0.3 17 0 1 1
3 2 1.2 9 0 1 2
4 2 0.5 6 0 0.9 3
5 2 -6 2 0 0.5 4
6 2 6.5 3.25 0 0.5 4
7 2 9 -4 0 0.4 6
8 2 -2 15.5 0 0.4 2
END
    run_ok corcast refine bent.swc --refine geometry -o straight.swc
    check_tree straight.swc
    run_ok corcast info straight.swc --json
    expect_json stdout '.segments == 5 and .terminals == 3'
    grep -q '^[0-9]* 2 9 -4 0 ' straight.swc || fail "expected the terminal where it was"
    run corcast refine bent.swc --domain 'rect:14,40' -o refused.swc
    expect_status 2
    expect_sentence 'node 7 at \(9, -4, 0\) is outside the domain'
    printf '0 20\n10 20\n10 -5\n5 -5\n5 2\n-8 2\n-8 1\n-10 1\n-10 20\n' >hook.txt
    sed 's/^7 2 9 -4/7 2 5.1 -4/; s/^6 2 6.5 3.25/6 2 9 2.5/; s/^5 2 -6 2/5 2 -6 3/' bent.swc >round.swc
    run corcast refine round.swc --domain polygon:hook.txt -o refused.swc
    expect_status 2
    expect_sentence 'the vessel that ends in node 7 leaves the domain when it is straight'
}

test_forests_keep_the_clearance_of_their_header_or_of_the_option() {
    run_ok corcast grow --terminals 120 --inlet 0,50 --inlet 4.5,-49 --q-perf 200 --clearance 3.25 -o apart.swc
    grep -qx '# clearance_mm: 3.25' apart.swc || fail "expected the header to say the clearance"
    run_ok corcast refine apart.swc --refine-moves 4000 -o kept.swc --json kept.json
    expect_json kept.json '.apart_mm >= 3.25 and .target < 0.97 * .target_before'
    grep -q 'walls of different trees are at least [34]\.[0-9]* mm apart' stderr || fail "expected the distance to be said"
    grep -qx '# clearance_mm: 3.25' kept.swc || fail "expected the header to say the clearance still"
    run_ok corcast refine apart.swc --clearance 0 --refine-moves 4000 -o free.swc --json free.json
    expect_json free.json '.apart_mm == null'
    run_ok corcast refine free.swc --clearance 0.125 --refine-moves 200 -o again.swc --json again.json
    grep -qx '# clearance_mm: 0.125' again.swc || fail "expected the header to say the option's clearance"
    run corcast refine apart.swc --clearance 30.5 -o none.swc
    expect_status 2
    expect_sentence 'as the trees are, --clearance 30.5 cannot be kept: the vessels that end in nodes [0-9]+ and [0-9]+, of different trees, are [0-9.]+ mm apart'
    [ ! -e none.swc ] || fail "expected no file"
    run_ok corcast grow --terminals 120 --inlet 0,50 --inlet 4.5,-49 --q-perf 200 --clearance 3.25 \
        --refine topology --refine-moves 4000 -o at_once.swc --json at_once.json
    expect_json at_once.json '.apart_mm >= 3.25'
}

run_tests "$@"
