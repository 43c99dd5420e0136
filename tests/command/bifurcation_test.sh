#!/usr/bin/env bash
# The command `bifurcation`, and the figures of the paper, which consist of bifurcations.
. "$(dirname "$0")/../lib.sh"

# nodes FILE: prints parent, position and radius of each node, rounded.
nodes() {
    awk '!/^#/ { printf "%d %.4f %.4f %g %.5f\n", $7, $3, $4, $5, $6 }' "$1"
}

test_what_is_said_of_a_bifurcation_is_its_shape() {
    run_ok corcast bifurcation --radii 3.1,2.5,2.2 --lengths 12,14,15 --angles 30,45 -o y.swc
    grep -q 'radii 3\.1, 2\.5, 2\.2 mm, angles 30 and 45 degrees' stderr || fail "expected the shape$(said)"
    nodes y.swc | diff - <(printf '%s\n' '-1 0.0000 12.0000 0 3.10000' '1 0.0000 0.0000 0 3.10000' \
        '2 -7.0000 -12.1244 0 2.50000' '2 10.6066 -10.6066 0 2.20000') >difference ||
        fail "expected the left daughter at 30, the right one at 45 degrees: $(cat difference)"
    grep -q '^# command: corcast bifurcation --radii' y.swc || fail "expected the command in the file"
}

# With gamma 3 and lambda 2, forces are squares of radii. For equal daughters, cos A = 2^(2/3) / 2.
test_radii_follow_murray_and_angles_the_target_where_nothing_is_said() {
    run_ok corcast bifurcation --radii 3 -o even.swc
    nodes even.swc | awk 'NR == 3 { exit !(($5 - 3 / 2 ^ (1 / 3)) ^ 2 < 1e-9 && ($3 + 7.937) ^ 2 < 1e-6) }' ||
        fail "expected Murray's bifurcation, got $(nodes even.swc)"
    run_ok corcast bifurcation --radii 3 --ratio 0.8 --gamma 2.55 --lambda 1 --lengths 4 -o odd.swc
    nodes odd.swc | awk 'NR > 2 { sum += $5 ^ 2.55; x += $2 / 4 * $5; y += $3 / 4 * $5; r[NR] = $5 }
        END { exit !((sum / 3 ^ 2.55 - 1) ^ 2 < 1e-8 && (r[4] / r[3] - 0.8) ^ 2 < 1e-9 && x ^ 2 < 1e-7 && (y + 3) ^ 2 < 1e-7) }' ||
        fail "expected radii by gamma 2.55 and forces in balance, got $(nodes odd.swc)"
}

test_a_bifurcation_is_written_in_every_format_of_trees() {
    run_ok corcast bifurcation --radii 3 -o b.vtp
    run_ok corcast info b.vtp --json
    expect_json stdout '.segments == 3 and .terminals == 2 and .bifurcations == 1'
}

test_bifurcations_that_cannot_be_are_refused() {
    local options sentence
    while IFS='|' read -r options sentence; do
        run corcast bifurcation $options -o no.swc
        expect_status 2
        expect_sentence "$sentence"
        [ ! -e no.swc ] || fail "expected no tree"
    done <<'END'
--radii 3,2|--radii takes one number or three, not 2
--radii 0|--radii: 0 is not from 1e-06 to 1e\+06 mm
--lengths 1,-2,3|--lengths: -2 is not from
--angles 30|--angles takes two angles, as in 30,45, not 1
--angles 30,180|--angles: 180 is not above -180 and below 180
--radii 3,1,1|no angles minimize the target for these radii and --lambda 2
--radii 3,2,2 --ratio 0.5|--ratio needs --radii with one radius, the parent's
--angles 30,40 --lambda 1|--lambda has no effect with --angles
END
}

test_the_figures_of_the_paper_are_made_by_name() {
    local name panels
    while read -r name panels; do
        run_ok corcast figure $name --dpi 20 --quiet -o $name.svg
        [ "$(grep -c '<image' $name.svg)" = "$panels" ] || fail "expected $panels pictures in $name"
    done <<'END'
fig1 1
fig2 2
fig3 9
fig4 2
END
}

run_tests "$@"
