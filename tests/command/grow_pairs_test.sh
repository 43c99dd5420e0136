#!/usr/bin/env bash
# `grow --pair`: two trees whose terminals form pairs. These tests measure distances and clearance
# again.
. "$(dirname "$0")/../lib.sh"

two=(--domain ball:30 --inlet 0,30,0 --inlet 2,-29,0 --q-perf 100 --pair 1.25)

# pairs_of FILE: prints, per pair, both ids, their roots and the distance of their ends; then the
# number of unpaired terminals, and the minimum distance between the walls of the two trees, sampled
# at points along the axes.
pairs_of() {
    awk '/^# terminal_pair:/ { a[++pairs] = $3; b[pairs] = $4; mates[$3]++; mates[$4]++; next } /^#/ { next }
         { id[++n] = $1; x[$1] = $3; y[$1] = $4; z[$1] = $5; r[$1] = $6; p[$1] = $7; has[$7] = 1; root[$1] = $7 == -1 ? $1 : root[$7] }
         function apart(i, j) { return sqrt((x[i] - x[j]) ^ 2 + (y[i] - y[j]) ^ 2 + (z[i] - z[j]) ^ 2) }
         END {
             for (k = 1; k <= pairs; k++) print a[k], b[k], root[a[k]], root[b[k]], apart(a[k], b[k])
             for (k = 1; k <= n; k++) odd += (mates[id[k]] != !(id[k] in has))
             least = 1e9
             for (k = 1; k <= n; k++) if (p[id[k]] != -1) for (s = 0; s <= 8; s++) {
                 i = id[k]; q = p[i]; m++; t[m] = root[i]; pr[m] = r[i]
                 px[m] = x[q] + (x[i] - x[q]) * s / 8; py[m] = y[q] + (y[i] - y[q]) * s / 8; pz[m] = z[q] + (z[i] - z[q]) * s / 8 }
             for (k = 1; k <= m; k++) for (j = k + 1; j <= m; j++) if (t[k] != t[j]) {
                 d = sqrt((px[k] - px[j]) ^ 2 + (py[k] - py[j]) ^ 2 + (pz[k] - pz[j]) ^ 2) - pr[k] - pr[j]; if (d < least) least = d }
             print "odd", odd + 0; print "least", least }' "$1"
}

test_every_terminal_of_one_tree_has_one_of_the_other_beside_it() {
    run_ok corcast grow "${two[@]}" --clearance 0.12 --terminals 160 -o pairs.swc --json pairs.json
    check_tree pairs.swc
    expect_stdout '^terminals 160$'
    pairs_of pairs.swc >measured
    [ "$(grep -c '^[0-9]' measured)" = 80 ] || fail "expected 80 pairs"
    grep -qx 'odd 0' measured || fail "expected a mate for each terminal, and for nothing else"
    awk '/^[0-9]/ { if ($3 == $4 || $5 < 1.25 - 1e-9 || $5 > 1.25 + 1e-9) exit 1 }' measured ||
        fail "expected pairs of both trees, 1.25 mm apart"
    awk -v said="$(jq .apart_mm pairs.json)" '/^least/ { exit !($2 >= 0.12 && said >= 0.12 && $2 >= said - 1e-9 && $2 < said + 0.3) }' measured ||
        fail "expected a clearance of $(jq .apart_mm pairs.json), got $(tail -1 measured)"
    expect_json pairs.json '(.terminal_pairs | length) == 80 and all(.terminal_pairs[]; (.[2] - 1.25 | fabs) < 1e-9)'
    [ "$(jq -r '.terminal_pairs[] | "\(.[0]) \(.[1])"' pairs.json)" = "$(awk '/^[0-9]/ { print $1, $2 }' measured)" ] ||
        fail "expected the same pairs in JSON"
}

test_pairs_are_read_back_from_every_format_with_columns_and_survive_refinement() {
    run_ok corcast grow "${two[@]}" --terminals 40 -o pairs.swc
    run_ok corcast info pairs.swc --json
    jq -c .terminal_pairs stdout >before
    for name in pairs.vtp pairs.csv pairs.graphml; do
        run_ok corcast convert pairs.swc $name
        run_ok corcast convert $name back.swc
        run_ok corcast info back.swc --json
        [ "$(jq '.terminal_pairs | length' stdout)" = 20 ] || fail "expected 20 pairs by $name"
    done
    run_ok corcast refine pairs.swc -o refined.swc
    run_ok corcast info refined.swc --json
    expect_json stdout '(.terminal_pairs | length) == 20 and all(.terminal_pairs[]; (.[2] - 1.25 | fabs) < 1e-9)'
    pairs_of refined.swc | grep -qx 'odd 0' || fail "expected a mate for each terminal still"
}

# Enough terminals for several tiles.
test_the_number_of_threads_does_not_change_pairs() {
    run_ok corcast grow "${two[@]}" --pair 0.5 --q-perf 20 --terminals 9000 --threads 1 -o one.swc
    run_ok corcast grow "${two[@]}" --pair 0.5 --q-perf 20 --terminals 9000 --threads 3 -o many.swc
    expect_same one.swc many.swc
}

test_pairs_that_cannot_be_are_refused() {
    local sentence options
    while IFS='|' read -r sentence options; do
        # shellcheck disable=SC2086
        run corcast grow --terminals 60 --domain ball:30 $options -o none.swc
        expect_status 2
        expect_sentence "$sentence"
        expect_only
    done <<'END'
--pair needs two trees: specify --inlet twice, once per tree|--pair 1.25
--pair needs two trees: specify --inlet twice, once per tree|--pair 1.25 --inlet 0,30,0 --inlet 0,-30,0 --inlet 30,0,0
--pair needs an even number of --terminals|--pair 1.25 --inlet 0,30,0 --inlet 0,-30,0 --terminals 61
--pair needs .* equal --inlet-shares|--pair 1.25 --inlet 0,30,0 --inlet 0,-30,0 --inlet-shares 2,1
--pair is 1.25; it must be at least --clearance, which is 1.3|--pair 1.25 --clearance 1.3 --inlet 0,30,0 --inlet 0,-30,0
--pair is 0.3; it must be at least 0.[0-9]+, the radii 0.[0-9]+ and 0.[0-9]+ mm of the paired nodes [0-9]+ and [0-9]+ plus the clearance|--pair 0.3 --inlet 0,30,0 --inlet 0,-30,0
--pair: '-1' is not a number from 0 to 1000|--pair=-1
^corcast grow: --pair is 200; it must be at most 141.4 mm, the diagonal of the domain's bounding box$|--domain disc:50 --pair 200 --inlet 0,50 --inlet 4.5,-49
in a plane, two trees that must not cross block each other|--quiet --domain disc:50 --pair 2 --inlet 0,50 --inlet 4.5,-49 --q-perf 20
END
    run_ok corcast grow --terminals 8 --domain disc:50 --pair 2 --inlet 0,50 --inlet 4.5,-49 --q-perf 20 -o few.swc
    grep -q '^corcast: in a plane, two trees that must not cross block each other' stderr ||
        fail "expected that to be said beforehand"
    run_ok corcast grow "${two[@]}" --terminals 40 -o pairs.swc
    run corcast grow --from pairs.swc --terminals 80 --pair 1 -o none.swc
    expect_status 2
    expect_sentence '--pair cannot be combined with --from: both trees must be new'
}

test_wrong_pairs_in_a_file_are_refused_by_line() {
    local sentence line
    while IFS='|' read -r sentence line; do
        sed "1i # terminal_pair: $line" "$DATA/bifurcation.swc" >wrong.swc
        run corcast info wrong.swc
        expect_status 2
        expect_sentence "wrong.swc:1: $sentence"
    done <<'END'
terminal_pair is '3'; it must be the ids of two nodes|3
terminal_pair is '3 4 5'; it must be the ids of two nodes|3 4 5
terminal_pair names the node 77, which is not the id of a node|3 77
node 3 is of a pair twice|3 3
END
}

run_tests "$@"
