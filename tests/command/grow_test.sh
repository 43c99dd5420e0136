#!/usr/bin/env bash
# `grow`: the same seed gives the same bytes, and the tree keeps the promises of docs/METHODS.md,
# which a program that shares no code with corcast checks.
. "$(dirname "$0")/../lib.sh"

# The checker must detect faults; otherwise its approval would mean nothing.
test_the_checker_finds_what_is_wrong() {
    run_ok corcast grow --terminals 50 --seed 3 -o tree.swc
    awk '!/^#/ && $1 == 20 { $6 *= 1.00000000001 } { print }' tree.swc >radius.swc
    run "$CHECK_TREE" radius.swc
    expect_status 1
    expect_sentence "Murray"
    run_ok corcast grow --terminals 50 --seed 3 --gamma 0.05:3,1:2.2 -o curve.swc
    sed 's/^# gamma_by_radius: 0.05:3/# gamma_by_radius: 0.05000000001:3/' curve.swc >curved.swc
    run "$CHECK_TREE" curved.swc
    expect_status 1
    expect_sentence "Murray"
    sed 's/^# p_term_mmHg: 60/# p_term_mmHg: 60.0000001/' tree.swc >pressure.swc
    run "$CHECK_TREE" pressure.swc
    expect_status 1
    expect_sentence "p_term"
    awk '!/^#/ && $1 == 30 { $3 = 51 } { print }' tree.swc >outside.swc
    run "$CHECK_TREE" outside.swc
    expect_status 1
    expect_sentence "outside"
    printf '%s\n' '# dimension: 2' '# domain: disc:9' '1 3 0 9 0 1 -1' '2 3 0 4 0 1 1' '3 3 -4 0 0 1 2' \
        '4 3 4 0 0 1 2' '5 3 0 -2 0 1 3' '6 3 3 2.5 0 1 3' >crossing.swc
    run "$CHECK_TREE" crossing.swc
    expect_status 1
    expect_sentence "segments (4 and 6|6 and 4) cross"
    # Radii that are 4 times as large carry 256 times the flow. All laws hold, but vessels overlap.
    sed 's/^# q_perf_ml_min: 500$/# q_perf_ml_min: 128000/' tree.swc |
        awk -v CONVFMT=%.17g '!/^#/ { $6 *= 4 } { print }' >wide.swc
    run_ok "$CHECK_TREE" wide.swc
    expect_stdout '^short [1-9]'
    expect_stdout '^overlaps [1-9]'
}

test_the_same_seed_gives_the_same_bytes() {
    run_ok corcast grow --terminals 150 --seed 11 -o first.swc
    run_ok corcast grow --terminals 150 --seed 11 -o second.swc
    expect_same first.swc second.swc
}

test_another_seed_gives_another_tree() {
    run_ok corcast grow --terminals 50 --seed 11 -o first.swc
    run_ok corcast grow --terminals 50 --seed 12 -o second.swc
    [ -z "$(comm -12 <(grep -v '^#' first.swc | sort) <(grep -v '^#' second.swc | sort))" ] ||
        fail "expected the two trees to share no row"
}

test_the_number_of_threads_does_not_change_the_tree() {
    local threads
    run_ok corcast grow --terminals 150 --threads 1 -o one.swc
    for threads in 2 3; do
        run_ok corcast grow --terminals 150 --threads $threads -o many.swc
        expect_same one.swc many.swc
    done
}

test_the_locale_does_not_change_the_tree() {
    run_ok corcast grow --terminals 20 -o c.swc
    LC_ALL=de_DE.UTF-8 run_ok corcast grow --terminals 20 -o de.swc
    expect_same c.swc de.swc
}

test_a_tree_in_the_disc_keeps_murray_pressures_and_domain_without_crossings() {
    run_ok corcast grow --terminals 400 --seed 3 -o tree.swc
    check_tree tree.swc
    expect_stdout '^terminals 400$'
}

test_a_tree_in_the_ball_keeps_murray_pressures_and_domain() {
    run_ok corcast grow --terminals 300 --domain ball:28.794 --seed 4 -o tree.swc
    check_tree tree.swc
    expect_stdout '^terminals 300$'
    grep -q '^# dimension: 3$' tree.swc || fail "expected the header to say dimension 3"
}

test_vessels_are_as_long_as_wide_and_clear_of_each_other_at_their_final_radii() {
    local seed domain
    for domain in disc:50 ball:40; do
        for seed in 1 2 3; do
            run_ok corcast grow --terminals 4000 --domain $domain --seed $seed -o tree.swc
            check_tree tree.swc
            expect_stdout '^short 0$'
            expect_stdout '^overlaps 0$'
        done
    done
}

test_a_tree_in_any_convex_shape_stays_inside() {
    local domain
    for domain in rect:30,52 box:21,30,44 ellipsoid:20,33,15; do
        run_ok corcast grow --terminals 150 --domain $domain --q-perf 100 -o tree.swc
        check_tree tree.swc
    done
}

test_a_full_domain_is_said_and_partial_writes_the_tree_so_far() {
    run corcast grow --terminals 50 --gamma 0.05 --lambda 100 -o tree.swc
    expect_status 2
    expect_sentence "gave up placing terminal 2"
    expect_only
    run corcast grow --terminals 50 --gamma 0.05 --lambda 100 --partial --json grow.json -o tree.swc
    expect_status 0
    grep -q "gave up placing terminal 2" stderr || fail "expected the reason on standard error"
    expect_json grow.json '.complete == false and .terminals == 1 and .rejected > 0'
    check_tree tree.swc
}

test_the_exponent_may_follow_the_radius() {
    local options
    for options in '--gamma 0.05:3,1:2.2 --terminals 300' \
        '--gamma 0.1:2.2,1:2.9,2:2.4 --domain ball:30 --lambda 1 --terminals 150' \
        '--gamma 0.05:3,1:2.2 --viscosity-law pries --terminal-flow territory --terminals 80' \
        '--gamma 0.05:3,1:2.2 --inlet 0,50 --inlet 30,-40 --terminals 120'; do
        # shellcheck disable=SC2086
        run_ok corcast grow $options -o tree.swc
        check_tree tree.swc
    done
    grep -qx '# gamma_by_radius: 0.05:3,1:2.2' tree.swc || fail "expected the exponents in the header"
    ! grep -q '^# gamma:' tree.swc || fail "expected no single exponent in the header"
    run_ok corcast info tree.swc --json
    expect_json stdout '.gamma == null and .gamma_by_radius == [[0.05, 3], [1, 2.2]]'
    run_ok corcast convert tree.swc tree.graphml
    run_ok corcast info tree.graphml
    expect_stdout 'gamma         3 at a parent radius of 0.05 mm'
    run_ok corcast grow --from tree.swc --terminals 200 -o larger.swc
    check_tree larger.swc
    run corcast info tree.swc --stats --flow-split murray
    expect_status 2
    expect_sentence '--flow-split murray: the exponent of tree.swc varies with radius; set one exponent with --flow-exponent'
}

# If all exponents are equal, the tree is that of the single exponent.
test_exponents_that_are_all_the_same_are_one_exponent() {
    run_ok corcast grow --terminals 80 --gamma 2.7 -o one.swc
    run_ok corcast grow --terminals 80 --gamma 0.1:2.7,1:2.7 -o all.swc
    expect_same <(grep -v '^#' one.swc) <(grep -v '^#' all.swc)
}

test_exponents_that_make_no_curve_are_refused() {
    local value
    for value in 0 11 3:1,2:2 0.05:3,1:0 0.05: 0:3,1:2.2; do
        run corcast grow --gamma $value -o tree.swc
        expect_status 2
        expect_sentence "--gamma: '$value' is not a number above 0 and at most 10, or PLACE:NUMBER,... with PLACE above 0, rising"
    done
    run_ok corcast grow --terminals 5 --gamma 0.05:3,1:2.2 -o tree.swc
    sed 's/^# gamma_by_radius:.*/# gamma_by_radius: 1:3,0.5:2/' tree.swc >falling.swc
    run corcast info falling.swc
    expect_status 2
    expect_sentence "falling.swc:[0-9]+: gamma_by_radius is '1:3,0.5:2'; it must be MM:NUMBER,..., MM above 0 and rising"
}

test_every_gamma_and_lambda_gives_an_exact_tree() {
    local gamma lambda
    while read -r gamma lambda; do
        run_ok corcast grow --terminals 60 --gamma "$gamma" --lambda "$lambda" -o tree.swc
        check_tree tree.swc
        expect_stdout "^gamma $gamma\$"
        expect_stdout "^lambda $lambda\$"
    done <<'END'
0.5 2
2.55 0
2.7 1
3 2.385
10 4
END
}

test_other_pressures_flows_and_inlets_give_an_exact_tree() {
    run_ok corcast grow --terminals 80 --p-perf 117.3 --p-term 71.9 --q-perf 83.1 --viscosity 2.9 \
        --domain disc:31.7 --inlet 12.5,-20.25 -o tree.swc
    check_tree tree.swc
    grep -q '^1 [0-9]* 12.5 -20.25 0 ' tree.swc || fail "expected the root at the inlet: $(grep -v '#' tree.swc | head -1)"
}

test_ten_thousand_terminals_take_seconds_and_give_an_exact_tree() {
    run_ok timeout 300 "$CORCAST" grow --terminals 10000 --seed 2 -o tree.swc
    check_tree tree.swc
    expect_stdout '^terminals 10000$'
}

test_tubes_are_longer_than_wide_and_overlap_only_where_they_meet() {
    local options
    for options in '' '--toss terminal' '--domain ball:28.794' '--gamma 2.55 --lambda 1'; do
        run_ok corcast grow --seed 5 $options -o tree.swc --json grow.json
        expect_json grow.json '.broken == 0 and .thickness == 1'
        check_tree tree.swc
        expect_stdout '^short 0$'
        expect_stdout '^overlaps 0$'
    done
}

test_one_terminal_is_one_segment() {
    run_ok corcast grow --terminals 1 -o tree.swc
    check_tree tree.swc
    expect_stdout '^segments 1$'
}

test_the_root_is_at_the_top_of_the_rim_by_default() {
    run_ok corcast grow --terminals 3 --domain disc:41.5 -o tree.swc
    [ "$(grep -v '^#' tree.swc | head -1 | cut -d ' ' -f 3-5)" = "0 41.5 0" ] ||
        fail "expected the root at 0 41.5 0, got $(grep -v '^#' tree.swc | head -1)"
}

test_the_header_carries_what_swc_has_no_place_for() {
    local key
    run_ok corcast grow --terminals 3 --seed 99 -o tree.swc
    for key in generator 'seed: 99$' 'dimension: 2$' 'domain: disc:50$' 'gamma: 3$' 'lambda: 2$' \
        'p_perf_mmHg: 100$' 'p_term_mmHg: 60$' 'q_perf_ml_min: 500$' 'viscosity_cP: 3.6$'; do
        grep -q "^# $key" tree.swc || fail "expected a header line '# $key', got $(grep '^#' tree.swc)"
    done
}

test_json_says_what_was_done() {
    run_ok corcast grow --terminals 20 --threads 1 -o tree.swc --json done.json
    expect_json done.json '.terminals == 20 and .threads == 1 and .seconds >= 0 and .tosses >= 19'
    run_ok "$CHECK_TREE" tree.swc
    expect_json done.json "(.target - $(sed -n 's/^target //p' stdout) | fabs) <= 1e-9 * .target"
    expect_json done.json "(.root_radius_mm - $(sed -n 's/^root_radius_mm //p' stdout) | fabs) <= 1e-12"
}

test_a_tree_goes_to_standard_output() {
    grow_tree 12
    run_ok corcast grow --terminals 12 --seed 7 -o -
    expect_same stdout tree.swc
}

test_quiet_says_nothing_and_otherwise_one_line_is_said() {
    run_ok corcast grow --terminals 30 -o tree.swc
    [ "$(wc -l <stderr)" -le 1 ] || fail "expected one line, and no progress where there is no terminal$(said)"
    run_ok corcast grow --terminals 30 -o tree.swc --quiet
    [ ! -s stderr ] || fail "expected silence$(said)"
}

test_a_tree_that_is_not_as_it_should_be_is_said_even_when_quiet() {
    run_ok corcast grow --terminals 50 --gamma 1.568 --lambda 0 --domain ball:11.51 -o tree.swc --quiet --json t.json
    if [ "$(jq .broken t.json)" -gt 0 ]; then
        expect_sentence "$(jq .broken t.json) segments? (is|are) still shorter than wide or too close"
    fi
    run_ok corcast grow --terminals 500 --gamma 0.5 --domain shell:30,50,30,10,20 -o tree.swc --quiet
    grep -q 'smaller than the root radius, [0-9.e+]* mm, so the vessels overlap everywhere' stderr ||
        fail "expected a warning of a root larger than the domain$(said)"
    run_ok corcast grow --terminals 400 --domain rect:40,30 --q-perf 90000 -o tree.swc --quiet
    grep -q '^corcast: the domain, 40 x 30 mm, is too small' stderr || fail "expected a warning with a size$(said)"
}

test_a_mesh_that_is_too_small_is_asked_about_its_unit() {
    printf 'v 0 0 0\nv 9.1 0 0\nv 0 8.3 0\nv 0 0 7.2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n' >cm.obj
    run_ok corcast grow --domain mesh:cm.obj --terminals 200 -o tree.swc
    grep -q 'the domain, 9.1 x 8.3 x 7.2 mm if the file.s unit is that' stderr || fail "expected the size$(said)"
    run_ok corcast grow --domain mesh:cm.obj,10 --terminals 200 -o tree.swc
    ! grep -q 'unit' stderr || fail "expected no word of the unit where it is given$(said)"
}

test_a_domain_too_thin_to_find_points_in_is_refused() {
    printf '0 0\n1000 1000\n1000 1000.000001\n' >thin.txt
    run timeout 300 "$CORCAST" grow --domain polygon:thin.txt -o tree.swc
    expect_status 2
    expect_sentence 'thin.txt: the domain is too thin for random points: it fills [0-9.e-]+ of its bounding box'
    run timeout 300 "$CORCAST" grow --domain shell:10,10,10,1e-6 -o tree.swc
    expect_status 2
    expect_sentence '^corcast grow: --domain shell:10,10,10,1e-6: the domain is too thin'
}

test_a_domain_much_longer_than_wide_is_grown_in_seconds() {
    local domain
    for domain in rect:1e6,1e-6 ellipsoid:1,1e6,1 box:1e-6,1e6,1e6; do
        run bash -c 'ulimit -t 10; exec "$@"' sh "$CORCAST" grow --domain $domain --terminals 20 -o tree.swc
        expect_status 0
    done
}

test_a_tree_in_any_shape_that_the_checker_knows_stays_inside() {
    printf '0 0\n60 0\n60 60\n0 60\n\n20 20\n40 20\n40 40\n20 40\n' >hole.txt
    local domain
    for domain in shell:30,50,30,10 shell:20.5,41.3,18.7,6.1,-3.2 polygon:hole.txt polygon:hole.txt,0.83; do
        run_ok corcast grow --terminals 300 --domain $domain -o tree.swc
        check_tree tree.swc
    done
    sed 's/^\(150 3\) [^ ]* [^ ]*/\1 24.9 24.9/' tree.swc >hole.swc
    run "$CHECK_TREE" hole.swc
    expect_status 1
}

test_a_tree_in_a_mask_keeps_out_of_its_holes() {
    awk 'BEGIN {
        printf "P5\n23 17\n255\n"
        for (row = 0; row < 17; row++)
            for (column = 0; column < 23; column++)
                printf "%s", (row > 2 && row < 9 && column > 8 && column < 19 || column > 21 - row) ? "." : "~"
    }' | tr . '\0' >hole.pgm
    run_ok corcast grow --terminals 300 --domain mask:hole.pgm,2.385 -o tree.swc
    check_tree tree.swc
    sed 's/^\(150 3\) [^ ]* [^ ]*/\1 4.1 6.3/' tree.swc >hole.swc
    run "$CHECK_TREE" hole.swc
    expect_status 1
    expect_sentence 'leaves the domain'
}

test_an_output_in_a_missing_folder_is_refused() {
    run corcast grow --terminals 3 -o missing/tree.swc
    expect_status 3
    expect_sentence "missing/tree.swc"
    expect_only
}

test_an_output_on_a_full_disk_is_refused() {
    [ -w /dev/full ] || skip "there is no /dev/full"
    ln -s /dev/full full.swc
    run corcast grow --terminals 3 -o full.swc
    expect_status 3
    expect_sentence "full"
}

test_an_extension_that_is_no_tree_is_refused() {
    run corcast grow --terminals 3 -o tree.txt
    expect_status 2
    expect_sentence "tree.txt"
    expect_only
}

test_a_folder_is_not_an_output() {
    mkdir folder.swc
    run corcast grow --terminals 3 -o folder.swc
    expect_status 3
    expect_sentence "folder.swc"
    expect_only folder.swc
}

# write_cube FILE HALF [OPEN]: writes the surface of a cube with half side HALF as OBJ; with a third
# argument, without its top.
write_cube() {
    awk -v r="$2" 'BEGIN { for (i = 0; i < 8; i++) print "v", (i % 2 ? r : -r), (int(i / 2) % 2 ? r : -r), (i >= 4 ? r : -r) }' >"$1"
    printf 'f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 1 5 7 3\nf 2 4 8 6\n' >>"$1"
    [ -n "${3:-}" ] || printf 'f 3 7 8 4\n' >>"$1"
}

test_trees_grow_on_surfaces() {
    write_cube cube.obj 31.5
    run_ok corcast grow --domain surface:cube.obj,1.25 --terminals 400 --q-perf 20 -o tree.swc
    grep -v '^#' tree.swc | awk '{ m = 0; for (k = 3; k <= 5; k++) { a = $k < 0 ? -$k : $k; if (a > m) m = a }
        if (m < 31.5 - 1.25 - 0.55 || m > 31.5 - 1.25 + 0.55) { print "node " $1 " is at " m; exit } }' >off
    [ ! -s off ] || fail "expected all nodes on the surface: $(cat off)"
    grep -qx '# domain: surface:cube.obj,1.25' tree.swc || fail "expected the surface in the header"
    write_cube open.obj 31.5 open
    run corcast grow --domain surface:open.obj --terminals 40 -o refused.swc
    expect_status 2
    expect_sentence 'open.obj: the mesh is not closed: 4 edges belong to an odd number of triangles'
}

# Trees that are relaxed during growth have a lower target and obey every rule.
test_relaxed_trees_have_a_lower_target_and_keep_the_rules() {
    local options
    for options in '--viscosity-law pries' '--domain ball:50' '--domain shell:40,40,60,12' '--inlet 0,50 --inlet 0,-50'; do
        # shellcheck disable=SC2086
        run_ok corcast grow --terminals 237 --seed 3 $options --relax 0 --json plain.json -o plain.swc
        # shellcheck disable=SC2086
        run_ok corcast grow --terminals 237 --seed 3 $options --threads 2 --json relaxed.json -o relaxed.swc
        check_tree relaxed.swc
        expect_stdout '^short 0$'
        expect_stdout '^overlaps 0$'
        awk -v a="$(jq .target relaxed.json)" -v b="$(jq .target plain.json)" 'BEGIN { exit !(a < 0.985 * b) }' ||
            fail "expected a lower target than with --relax 0 $options"
    done
    # shellcheck disable=SC2086
    run_ok corcast grow --terminals 237 --seed 3 $options --threads 1 -o one.swc
    expect_same one.swc relaxed.swc
    # shellcheck disable=SC2086
    run_ok corcast grow --terminals 237 --seed 3 $options --relax 200 -o earlier.swc
    ! cmp -s earlier.swc relaxed.swc || fail 'expected --relax 200 to end before 237 terminals'
}

# A preloaded library makes the machine appear to have 400 MB of memory.
test_refuses_at_once_what_needs_more_memory_than_the_machine_has() {
    printf '%s\n' '#include <unistd.h>' \
        'long sysconf(int n) { return n == _SC_PAGESIZE ? 4096 : n == _SC_PHYS_PAGES ? 97656 : 2; }' >small.c
    cc -shared -fPIC -o small.so small.c
    run timeout 300 env LD_PRELOAD="$PWD/small.so" "$CORCAST" grow --terminals 2385000 -o t.swc --quiet
    expect_status 3
    expect_sentence 'the tree: out of memory: needs 810.9 MB, and this machine has 400.0 MB$'
    expect_only small.c small.so
    run env LD_PRELOAD="$PWD/small.so" "$CORCAST" grow --terminals 23 -o t.swc --quiet
    expect_status 0
}

run_tests "$@"
