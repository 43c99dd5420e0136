#!/usr/bin/env bash
# `grow --stages`: one tree grown in stages. Also --min-radius, --clearance and --demand, which
# stages may set.
. "$(dirname "$0")/../lib.sh"

write_stages() {
    cat >stages.ini <<'END'
# the trunk, then the tissue
[trunk]
domain = ball:30
terminals = 40
gamma = 2.4
p-term = 88.5
q-perf = 45
[tissue]
domain = ball:31.5
terminals = 600
keep-radii = on
gamma = 3
p-term = 60
END
}

# expect_within OLD NEW: every node of OLD is in NEW with its position and, except for roots, its
# radius.
expect_within() {
    awk '/^#/ { next } FNR == NR { at[$1] = $3 " " $4 " " $5 " " ($7 == -1 ? "" : $6); next }
         { seen[$1] = $3 " " $4 " " $5 " " ($7 == -1 ? "" : $6) }
         END { for (id in at) if (seen[id] != at[id]) { print "node " id ": " at[id] " became " seen[id]; exit } }' "$1" "$2" >within.out
    [ ! -s within.out ] || fail "$(cat within.out)"
}

test_each_stage_grows_on_the_one_before() {
    write_stages
    run_ok corcast grow --domain ball:30 --terminals 40 --gamma 2.4 --p-term 88.5 --q-perf 45 --seed 5 -o trunk.swc
    run_ok corcast grow --stages stages.ini --seed 5 -o tree.swc --json tree.json
    expect_within trunk.swc tree.swc
    grep -qx '# domain: ball:31.5' tree.swc || fail "expected the last domain in the header"
    grep -qx '# gamma: 3' tree.swc || fail "expected the last gamma in the header"
    grep -qx '# command: corcast grow --stages stages.ini --seed 5 -o T.swc' tree.swc || fail "expected the stages in the command"
    run_ok corcast info tree.swc --json
    expect_json stdout '.terminals == 600 and (.terminal_pressure_mmHg.min - 60 | fabs) < 1e-6'
    run_ok corcast grow --stages stages.ini --seed 5 --threads 1 -o again.swc
    expect_same <(grep -v '^# command' tree.swc) <(grep -v '^# command' again.swc)
}

test_stages_that_contradict_each_other_are_refused_with_their_names() {
    local change sentence
    while IFS='|' read -r change sentence; do
        write_stages
        sed -i "$change" stages.ini
        run corcast grow --stages stages.ini --quiet -o tree.swc
        expect_status 2
        expect_sentence "$sentence"
        expect_only stages.ini
    done <<'END'
s/keep-radii = on/toss = terminal/|^corcast grow: stages.ini: \[tissue\]: gamma 3 would change the radii of stage \[trunk\], which has gamma 2.4; set keep-radii = on, or use the same gamma$
s/p-term = 60/p-term = 90/|stages.ini: \[tissue\]: p-term 90 mmHg leaves no pressure drop beyond stage \[trunk\], whose radii are kept and whose terminals are at 88.5
s/terminals = 600/terminals = 40/|stages.ini: \[tissue\]: terminals is 40; it must be above 40, the number of stage \[trunk\]$
s/^gamma = 3/gamma = 3\ngamma = 2.9/|stages.ini:13: stage \[tissue\] sets 'gamma' twice
s/.tissue./[trunk]/|stages.ini:8: the stage \[trunk\] is defined twice
s/keep-radii = on/inlet = 0,0,30/|stages.ini:11: 'inlet' can be set only in the first stage; later stages continue its trees
s/keep-radii = on/inlet-shares = 2,1/|stages.ini:11: 'inlet-shares' can be set only in the first stage
s/domain = ball:31.5/domain = ball:5@100,0,0/|stages.ini: \[tissue\]: .*the whole tree is outside the domain
s/^keep-radii.*//;s/gamma = 3/gamma = 0.1:3,2:2/|stages.ini: \[tissue\]: gamma 0.1:3,2:2 would change the radii of stage \[trunk\], which has gamma 2.4
s/gamma = 3/gama = 3/|stages.ini:12: unknown option 'gama' in a stage
s/gamma = 3/from = x.swc/|stages.ini:12: unknown option 'from' in a stage
s/gamma = 3/gamma = three/|stages.ini:12: --gamma: 'three'
1,2s/.trunk./; none/|stages.ini:3: 'domain' is before the first stage
END
    printf '# nothing\n' >stages.ini
    run corcast grow --stages stages.ini -o tree.swc
    expect_status 2
    expect_sentence 'stages.ini: has no stage'
    write_stages
    run corcast grow --stages stages.ini --refine geometry -o tree.swc
    expect_status 2
    expect_sentence '--refine cannot be used with --stages'
}

test_growth_ends_at_a_radius() {
    run_ok corcast grow --terminals 5000 --min-radius 0.235 -o tree.swc
    grep -v '^#' tree.swc | awk '{ r[$1] = $6; has[$7] = 1 } END { for (i in r) if (!(i in has)) { s += r[i]; n++ }
        m = s / n; exit !(m > 0.22 && m < 0.237 && n > 50 && n < 1000) }' || fail "expected terminals of 0.235 mm in the mean"
}

# The ends of the trunk keep their radii and are not counted as terminals.
test_growth_on_a_trunk_that_keeps_its_radii_ends_at_a_radius() {
    run_ok corcast grow --terminals 200 -o trunk.swc
    run_ok corcast grow --from trunk.swc --keep-radii --q-perf 90 --terminals 5000 --min-radius 0.0565 -o tree.swc
    awk '/^#/ { next } FNR == NR { old[$1] = 1; next } { r[$1] = $6; has[$7] = 1 }
        END { for (i in r) if (!(i in has) && !(i in old)) { s += r[i]; n++ }
        m = s / n; exit !(m > 0.0525 && m < 0.0568 && n > 200 && n < 2000) }' trunk.swc tree.swc || fail "expected new terminals of 0.0565 mm in the mean"
}

# least_apart FILE: prints the minimum distance between the walls of two trees, sampled at points on
# the axes.
least_apart() {
    awk '/^#/ { next } { x[$1] = $3; y[$1] = $4; r[$1] = $6; p[$1] = $7; tree[$1] = $7 == -1 ? $1 : tree[$7]; id[++n] = $1 }
         END { least = 1e9
             for (k = 1; k <= n; k++) if (p[id[k]] != -1) for (s = 0; s <= 8; s++) {
                 i = id[k]; m++; px[m] = x[p[i]] + (x[i] - x[p[i]]) * s / 8; py[m] = y[p[i]] + (y[i] - y[p[i]]) * s / 8; pr[m] = r[i]; pt[m] = tree[i] }
             for (a = 1; a <= m; a++) for (b = a + 1; b <= m; b++) if (pt[a] != pt[b]) {
                 d = sqrt((px[a] - px[b]) ^ 2 + (py[a] - py[b]) ^ 2) - pr[a] - pr[b]; if (d < least) least = d }
             print least }' "$1"
}

test_trees_keep_the_clearance_that_was_asked_for() {
    run_ok corcast grow --terminals 160 --inlet 0,50 --inlet 4.5,-49 --q-perf 200 --clearance 3.25 -o apart.swc --json apart.json
    expect_json apart.json '.apart_mm >= 3.25'
    awk -v a="$(least_apart apart.swc)" -v b="$(jq .apart_mm apart.json)" 'BEGIN { exit !(a >= 3.25 && a >= b && a < b + 0.8) }' ||
        fail "expected about $(jq .apart_mm apart.json) mm, got $(least_apart apart.swc)"
    run corcast grow --terminals 160 --inlet 0,50 --inlet 4.5,-49 --clearance -1 -o none.swc
    expect_status 2
    expect_sentence "clearance.*-1"
    run corcast grow --terminals 160 --clearance 1.5 -o none.swc
    expect_status 2
    expect_sentence '^corcast grow: --clearance is 1.5, the distance between trees, but there is only one tree; repeat --inlet to grow several$'
    run corcast grow --terminals 160 --inlet 0,50 --inlet 4.5,49 --clearance 30.5 -o none.swc
    expect_status 2
    expect_sentence 'no straight vessel leads from --inlet 4.5,49,0 into the domain, clear of those of the other inlets'
}

# Writes demand.pgm, 100 x 100 pixels: the demand of the left half is five times that of the right
# half.
write_demand() {
    awk 'BEGIN { print "P2 100 100 255"; for (y = 0; y < 100; y++) { for (x = 0; x < 100; x++) printf "%d ", x < 50 ? 255 : 51; print "" } }' >demand.pgm
}

test_terminals_stand_as_densely_as_the_map_demands() {
    write_demand
    run_ok corcast grow --demand demand.pgm,1 --terminals 1500 -o tree.swc
    check_tree tree.swc
    awk '/^#/ { next } { x[$1] = $3; has[$7] = 1 }
         END { for (i in x) if (!(i in has)) { if (x[i] < 0) left++; else right++ } exit !(left > 4.2 * right && left < 5.5 * right) }' tree.swc ||
        fail "expected about five times as many terminals on the left"
    printf '[all]\ndemand = demand.pgm,1\nterminals = 300\n' >stages.ini
    run_ok corcast grow --stages stages.ini -o staged.swc
    run_ok corcast grow --demand demand.pgm,1 --terminals 300 -o plain.swc
    expect_same <(grep -v '^#' staged.swc) <(grep -v '^#' plain.swc)
}

test_flow_parts_as_the_map_demands() {
    write_demand
    run_ok corcast grow --demand demand.pgm,1 --terminal-flow demand --terminals 400 -o tree.swc
    check_tree tree.swc
    grep -qx '# terminal_flow: demand' tree.swc || fail "expected the header to tell the rule"
    awk '/^# flow_share:/ { share[$3] = $4 } /^#/ { next } $1 in share { n[$3 < 0]++; sum[$3 < 0] += share[$1] }
         END { exit !(sum[1] > 4.4 * sum[0] && sum[1] < 5.2 * sum[0] && n[1] > 0.85 * n[0] && n[1] < 1.15 * n[0]) }' tree.swc ||
        fail "expected about five times as much blood on the left, through as many terminals"
    run corcast grow --terminal-flow demand -o none.swc
    expect_status 2
    expect_sentence '--terminal-flow demand needs a demand map; specify --demand'
}

test_maps_of_demand_that_say_nothing_are_refused() {
    write_demand
    printf 'P2 2 2 255\n0 0\n0 0\n' >zero.pgm
    local sentence options
    while IFS='|' read -r sentence options; do
        # shellcheck disable=SC2086
        run corcast grow -o tree.swc $options
        expect_status 2
        expect_sentence "$sentence"
    done <<'END'
zero.pgm: the demand map is empty: none of its values is above 0|--demand zero.pgm,1
demand.pgm: the demand map does not cover the domain: the demand is 0 at almost all of 20000 random points of the domain; the domain extends from x 490 to 510|--demand demand.pgm,1 --domain disc:10@500,0
--demand demand.pgm: a picture needs the width of a pixel in mm, FILE,MM|--demand demand.pgm
a pixel must be from 1e-06 to 1e.06 mm wide|--demand demand.pgm,0
END
}

test_the_coronary_artery_says_when_there_is_no_heart() {
    CORCAST_SHARED=$PWD/nowhere run_ok "$REPO/docs/coronary/run"
    grep -q 'coronary: SKIPPED, nothing was grown: there is no heart' stderr || fail "expected that to be said"
}

# The stages of the example of the coronary artery, with few terminals, in a box instead of the
# heart.
test_the_coronary_artery_grows_in_its_stages() {
    cp "$REPO"/docs/coronary/{trunk.swc,stages.ini} .
    awk '/^#/ { next } { $6 = 32; print }' trunk.swc >territory.swc
    run_ok corcast export territory.swc -o lad.nii.gz --spacing 4
    sed -i -e 's/^domain = .*/domain = hull:20/' -e 's/^terminals = .*/terminals = 40/' -e 's/^fill-to = .*/fill-to = 5/' stages.ini
    run_ok corcast grow --from trunk.swc --domain hull:20 --stages stages.ini --seed 2 -o tree.swc --json tree.json
    expect_json tree.json '.terminals > 200 and .fill.left_out == 0 and .broken < 0.02 * .terminals'
}

run_tests "$@"
