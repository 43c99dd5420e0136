#!/usr/bin/env bash
# `grow` with a viscosity that depends on the diameter and flows that depend on territories.
# check_tree derives flows, viscosities and pressures again from the SWC file alone, and these tests
# count territories again.
. "$(dirname "$0")/../lib.sh"

# stated KEY: prints the value of KEY in the output of check_tree.
stated() {
    sed -n "s/^$1 //p" stdout
}

test_viscosity_by_diameter_gives_an_exact_tree() {
    local options
    for options in '--terminals 400' '--terminals 300 --domain ball:28.794 --gamma 2.55 --lambda 1' \
        '--terminals 200 --hematocrit 0.31 --plasma-viscosity 1.05 --q-perf 0.0317' '--terminals 1'; do
        run_ok corcast grow --viscosity-law pries $options -o tree.swc
        check_tree tree.swc
        grep -q '^# viscosity_law: pries$' tree.swc || fail "expected the header to tell the law"
        ! grep -q '^# viscosity_cP' tree.swc || fail "expected no constant viscosity in the header"
    done
}

test_viscosity_by_diameter_is_felt_in_thin_vessels() {
    run_ok corcast grow --terminals 200 --q-perf 0.1 --viscosity 1.2 -o constant.swc
    run_ok corcast grow --terminals 200 --q-perf 0.1 --viscosity-law pries -o pries.swc
    check_tree constant.swc
    local constant
    constant=$(stated min_radius_mm)
    check_tree pries.swc
    awk -v a="$constant" -v b="$(stated min_radius_mm)" 'BEGIN { exit !(b > 1.3 * a) }' ||
        fail "expected vessels wider than with plasma alone: $constant, $(stated min_radius_mm)"
}

test_vessels_too_thin_for_blood_are_refused() {
    run corcast grow --terminals 100 --viscosity-law pries --q-perf 1e-9 -o tree.swc
    expect_status 2
    expect_sentence 'no blood flows.*um wide.*--terminals or raise --q-perf'
    expect_only
}

test_flow_by_territory_gives_an_exact_tree() {
    local options
    for options in '--terminals 400' '--terminals 250 --domain box:21,30,44 --q-perf 100' \
        '--terminals 150 --viscosity-law pries --gamma 2.7'; do
        run_ok corcast grow --terminal-flow territory $options -o tree.swc
        check_tree tree.swc
        grep -q '^# terminal_flow: territory$' tree.swc || fail "expected the header to tell the rule"
        [ "$(grep -c '^# flow_share: ' tree.swc)" = "$(stated terminals)" ] ||
            fail "expected a flow share for each terminal"
    done
}

# Recomputes the territories in a disc of radius 50 mm from the file alone, by counting the points
# of a different lattice.
recount() {
    awk '/^# flow_share:/ { share[$3] = $4; shares += $4; next }
         /^#/ { next }
         { x[$1] = $3; y[$1] = $4; inner[$7] }
         END {
             for (id in x) if (!(id in inner)) { n++; at[n] = id; px[n] = x[id]; py[n] = y[id] }
             for (u = -49.9; u < 50; u += 0.25) for (v = -49.9; v < 50; v += 0.25) {
                 if (u * u + v * v > 2500) continue
                 least = 1e9
                 for (k = 1; k <= n; k++) {
                     d = (u - px[k]) ^ 2 + (v - py[k]) ^ 2
                     if (d < least) { least = d; nearest = k }
                 }
                 count[nearest]++; counts++
             }
             for (k = 1; k <= n; k++) {
                 off = share[at[k]] / shares / (count[k] / counts) - 1
                 if (off > 0.03 || off < -0.03) print "terminal " at[k] " is off by " off
             }
             print n " terminals"
         }' "$1"
}

test_the_flow_of_a_terminal_is_that_of_the_tissue_nearest_to_it() {
    run_ok corcast grow --terminals 60 --terminal-flow territory --seed 4 -o tree.swc
    recount tree.swc >recount.out
    [ "$(cat recount.out)" = '60 terminals' ] || fail "$(head -3 recount.out)"
    sed -i '0,/^# flow_share:/s/\(^# flow_share: [0-9]* \).*/\14000/' tree.swc
    [ "$(recount tree.swc | wc -l)" -gt 1 ] || fail "expected the count to find a wrong share"
}

test_threads_change_nothing() {
    run_ok corcast grow --terminals 300 --terminal-flow territory --viscosity-law pries --threads 1 -o one.swc
    run_ok corcast grow --terminals 300 --terminal-flow territory --viscosity-law pries --threads 3 -o many.swc
    expect_same one.swc many.swc
}

test_territories_in_a_domain_much_longer_than_wide_are_counted_in_seconds() {
    local domain
    for domain in ellipsoid:1,1e6,1 box:1,1e6,1e-6 box:1e-6,1e6,1e6 rect:1e6,1; do
        run bash -c 'ulimit -t 2; exec "$@"' sh "$CORCAST" grow --terminals 20 --domain $domain \
            --terminal-flow territory --viscosity-law pries -o tree.swc
        expect_status 0
    done
}

test_info_and_scene_take_such_trees() {
    run_ok corcast grow --terminals 30 --terminal-flow territory --viscosity-law pries -o tree.swc
    run_ok corcast info tree.swc
    expect_stdout 'terminals at  60 to 60 mmHg'
    run_ok corcast render --exact tree.swc --color-by pressure --size 60x60 -o tree.png
}

test_options_out_of_range_are_refused() {
    local options
    while read -r options; do
        run corcast grow $options -o tree.swc
        expect_status 2
        expect_sentence "${options%% *}"
        expect_only
    done <<'END'
--hematocrit 0.951
--hematocrit -0.1
--plasma-viscosity 0 --viscosity-law pries
--viscosity-law newton
--terminal-flow random
END
}

run_tests "$@"
