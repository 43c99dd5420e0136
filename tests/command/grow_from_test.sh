#!/usr/bin/env bash
# `grow --from`: continues a tree, which must keep its nodes and segments. check_tree derives the
# radii and pressures of the result again. The kept part is compared with the original file.
. "$(dirname "$0")/../lib.sh"

# expect_kept OLD NEW: every node of OLD is in NEW with its type and position. Its nearest ancestor
# that is also in OLD is its old parent. All nodes between the two are on the straight line.
expect_kept() {
    awk '/^#/ { next }
         FNR == NR { old[$1] = $2 " " $3 " " $4 " " $5; parent[$1] = $7; n++; next }
         { row[$1] = $2 " " $3 " " $4 " " $5; above[$1] = $7; x[$1] = $3; y[$1] = $4; z[$1] = $5 }
         END {
             for (id in old) {
                 if (row[id] != old[id]) { print "node " id " has changed: " row[id]; exit }
                 if (parent[id] == -1) { if (above[id] != -1) print "no root " id; continue }
                 p = parent[id]
                 ux = x[id] - x[p]; uy = y[id] - y[p]; uz = z[id] - z[p]
                 for (k = above[id]; !(k in old); k = above[k]) {
                     if (!(k in row)) { print "node " id " has lost its way to the root"; exit }
                     vx = x[k] - x[p]; vy = y[k] - y[p]; vz = z[k] - z[p]
                     cross2 = (uy * vz - uz * vy) ^ 2 + (uz * vx - ux * vz) ^ 2 + (ux * vy - uy * vx) ^ 2
                     if (cross2 > 1e-24 * (ux * ux + uy * uy + uz * uz) ^ 2) { print "node " k " is off the segment of " id; exit }
                 }
                 if (k != p) { print "node " id " hangs on " k ", not on " p; exit }
             }
             print "kept"
         }' "$1" "$2" >kept.out
    [ "$(cat kept.out)" = kept ] || fail "$(head -2 kept.out)"
}

stated() {
    sed -n "s/^$1 //p" stdout
}

# Writes measured.swc: a bent vessel of many segments with one side branch, and with ids and types
# unlike those of grown trees.
write_measured() {
    cat >measured.swc <<'END'
# measured by hand
# domain: rect:40,40
# who: nobody
100 2 0 19.5 0 1 -1
90 2 0.3 19 0 1 100
80 2 0.5 18.4 0 1 90
70 2 0.9 17.8 0 1 80
60 2 1.1 17 0 1 70
50 5 1.2 15 0 0.9 60
40 5 1.4 11 0 0.9 50
30 5 1 7 0 0.9 40
20 5 -6 2 0 0.5 30
10 5 6 2 0 0.5 30
END
}

test_a_grown_tree_grows_on_and_stays_as_it_is() {
    run_ok corcast grow --terminals 100 --seed 5 -o first.swc
    run_ok corcast grow --terminals 900 --seed 5 -o whole.swc
    check_tree whole.swc
    local whole
    whole=$(stated target)
    run_ok corcast grow --from first.swc --terminals 900 --seed 5 -o second.swc
    check_tree second.swc
    expect_stdout '^terminals 900$'
    [ "$(stated short)" -le 4 ] || fail "expected next to no segment shorter than wide, got $(stated short)"
    expect_kept first.swc second.swc
    awk -v a="$(stated target)" -v b="$whole" 'BEGIN { exit !(a < 1.03 * b) }' ||
        fail "expected a target near that of a tree grown whole, $whole, got $(stated target)"
    grep -v '^#' second.swc | awk '{ print $1 }' | sort -n | uniq | awk '$1 != NR { exit 1 } END { exit NR != 1800 }' ||
        fail "expected the ids 1 to 1800"
}

test_a_tree_far_from_the_domain_is_refused_with_both_places() {
    write_measured
    awk '/^[0-9]/ { $3 += 83.5 } { print }' measured.swc >away.swc
    run corcast grow --from away.swc --terminals 50 -o grown.swc
    expect_status 2
    expect_sentence 'the whole tree is outside the domain: the tree extends from x 7[0-9.]+ to .* the domain from x -20 to 20'
    expect_only measured.swc away.swc
}

# One tip of the tree is in a small part of the domain that is not connected to the large part.
test_a_domain_that_holds_a_part_of_the_tree_is_said_to_when_there_is_no_room() {
    write_measured
    printf '50 0\n95 0\n95 45\n50 45\n\n5.99 1.99\n6.01 1.99\n6.01 2.01\n5.99 2.01\n' >apart.txt
    run corcast grow --from measured.swc --domain polygon:apart.txt --terminals 20 -o grown.swc
    expect_status 2
    expect_sentence 'the domain does not contain the tree of --from; [0-9]+ of 10 nodes are outside'
}

test_it_is_said_how_the_radii_of_the_tree_changed() {
    write_measured
    run_ok corcast grow --from measured.swc --terminals 150 --q-perf 30 -o grown.swc --json grown.json
    grep -q 'the radii of the --from tree changed by factors of [0-9.]* to [0-9.]*, median [0-9.]*' stderr ||
        fail "expected the change of the radii$(said)"
    grep -v '^#' measured.swc | awk '{ print $1, $6 }' | sort >before
    grep -v '^#' grown.swc | awk '{ print $1, $6 }' | sort >after
    join before after | awk '$1 != 100 { print $3 / $2 }' | sort -g >changes
    expect_json grown.json "(.radius_change.min - $(head -1 changes) | fabs) < 1e-4 and
        (.radius_change.max - $(tail -1 changes) | fabs) < 1e-4 and
        (.radius_change.median - $(sed -n 5p changes) | fabs) < 1e-4"
}

# The first vessel of the inlet is thin, the second is thick.
test_the_root_has_the_radius_of_the_thickest_vessel_that_leaves_it() {
    printf '%s\n' '# domain: rect:40,40' '1 3 0 15 0 0.2 -1' '2 3 -3 10 0 0.2 1' '3 3 2 8 0 1.9 1' '4 3 -4 -6 0 0.7 3' \
        '5 3 6 -7 0 0.9 3' '6 3 9 -12 0 0.6 5' '7 3 3 -15 0 0.6 5' >forked.swc
    run_ok corcast info forked.swc --json
    expect_json stdout '.root_radius_mm == 1.9'
    run_ok corcast grow --from forked.swc --terminals 60 -o grown.swc --json grown.json
    local thickest
    thickest=$(grep -v '^#' grown.swc | awk '$7 == 1 && $6 > r { r = $6 } END { print r }')
    [ "$(grep '^1 ' grown.swc | cut -d ' ' -f 6)" = "$thickest" ] || fail "expected a root of radius $thickest"
    expect_json grown.json ".root_radius_mm == $thickest"
    run_ok corcast info grown.swc --json
    expect_json stdout ".root_radius_mm == $thickest"
}

# A bifurcation as in measured trees: both daughters begin with a point at its position.
test_given_vessels_that_touch_each_other_are_no_fault_of_growth() {
    printf '%s\n' '1 3 0 20 0 1.4 -1' '2 3 0 8 0 1.3 1' '3 3 0 8 0 1.1 2' '4 3 0 8 0 1.1 2' '5 3 -9 -3 0 1.1 3' '6 3 8 -4 0 1.1 4' >forked.swc
    run_ok corcast grow --from forked.swc --domain disc:22 --terminals 30 --q-perf 20 --keep-radii -o grown.swc --json grown.json --quiet
    expect_json grown.json '.broken == 0 and .root_radius_mm == 1.4'
    [ ! -s stderr ] || fail "expected silence$(said)"
    grep -q '^1 3 0 20 0 1.4 -1$' grown.swc || fail "expected the root to keep its radius: $(grep '^1 ' grown.swc)"
}

test_the_checker_of_what_stays_finds_what_does_not() {
    run_ok corcast grow --terminals 20 -o first.swc
    run_ok corcast grow --from first.swc --terminals 60 -o second.swc
    awk '$1 == 45 { $3 += 0.001 } { print }' second.swc >bent.swc
    (expect_kept first.swc bent.swc) 9>/dev/null && fail "expected a bent segment to be found"
    (expect_kept second.swc first.swc) 9>/dev/null && fail "expected lost nodes to be found"
    return 0
}

test_a_tree_in_space_grows_on() {
    run_ok corcast grow --terminals 50 --domain ball:30 --gamma 2.55 --lambda 1 -o first.swc
    run_ok corcast grow --from first.swc --terminals 400 -o second.swc
    check_tree second.swc
    expect_kept first.swc second.swc
    expect_stdout '^gamma 2.55$'
    expect_stdout '^lambda 1$'
}

test_a_measured_tree_of_many_pieces_grows_on() {
    write_measured
    run_ok corcast grow --from measured.swc --terminals 150 --q-perf 30 -o grown.swc
    check_tree grown.swc
    expect_stdout '^terminals 150$'
    expect_kept measured.swc grown.swc
    grep -q '^# measured by hand$' grown.swc && grep -q '^# who: nobody$' grown.swc ||
        fail "expected the comments of the tree that growth started from"
    [ "$(grep -c '^# domain:' grown.swc)" = 1 ] || fail "expected one domain in the header"
    [ "$(awk '!/^#/ && $1 == 1 { print $2 }' grown.swc)" = 3 ] || fail "expected a new node with the smallest free id"
}

test_radii_follow_the_flows() {
    write_measured
    run_ok corcast grow --from measured.swc --terminals 20 --q-perf 30 -o thin.swc
    run_ok corcast grow --from measured.swc --terminals 20 --q-perf 480 -o thick.swc
    check_tree thick.swc
    local thick
    thick=$(stated root_radius_mm)
    check_tree thin.swc
    awk -v a="$(stated root_radius_mm)" -v b="$thick" 'BEGIN { exit !(b > 1.9 * a && b < 2.1 * a) }' ||
        fail "expected twice the radius for 16 times the flow"
}

test_segments_outside_the_domain_stay_and_new_ones_are_inside() {
    run_ok corcast grow --terminals 30 --seed 2 -o first.swc
    run_ok corcast grow --from first.swc --domain disc:25 --terminals 120 -o second.swc
    expect_kept first.swc second.swc
    awk '/^#/ { next } FNR == NR { old[$1]; next }
         !($1 in old) && $3 * $3 + $4 * $4 > 625.0001 { exit 1 }' first.swc second.swc ||
        fail "expected new nodes in the disc of radius 25"
}

test_forests_grow_on() {
    local terminals='!/^#/ { if ($7 == -1) trees++; tree[$1] = trees; children[$7]++ }
        END { for (id in tree) if (!(id in children)) n[tree[id]]++; print n[1], n[2] }'
    run_ok corcast grow --inlet 0,50 --inlet 30,-40 --inlet-shares 3,1 --terminals 40 -o first.swc
    run_ok corcast grow --from first.swc --terminals 400 -o second.swc
    check_tree second.swc
    expect_kept first.swc second.swc
    [ "$(awk "$terminals" second.swc)" = '300 100' ] || fail "expected the shares the forest has"
    run_ok corcast grow --from first.swc --inlet-shares 1,1 --terminals 400 -o second.swc
    check_tree second.swc
    [ "$(awk "$terminals" second.swc)" = '200 200' ] || fail "expected the shares that are given"
}

test_flow_options_go_on_from_the_header() {
    run_ok corcast grow --terminals 30 --viscosity-law pries --terminal-flow territory --hematocrit 0.4 -o first.swc
    run_ok corcast grow --from first.swc --terminals 120 -o second.swc
    check_tree second.swc
    expect_kept first.swc second.swc
    grep -q '^# hematocrit: 0.4$' second.swc || fail "expected the hematocrit of the first tree"
    [ "$(grep -c '^# flow_share' second.swc)" = 120 ] || fail "expected a flow share for each terminal"
    run_ok corcast grow --from first.swc --terminals 120 --viscosity 3.6 --terminal-flow equal -o third.swc
    check_tree third.swc
    ! grep -qE '^# (viscosity_law|hematocrit|terminal_flow|flow_share)' third.swc ||
        fail "expected the options to win over the header"
}

test_the_number_of_threads_does_not_change_the_tree() {
    run_ok corcast grow --terminals 200 -o first.swc
    run_ok corcast grow --from first.swc --terminals 2500 --threads 1 -o one.swc
    run_ok corcast grow --from first.swc --terminals 2500 --threads 3 -o many.swc
    expect_same one.swc many.swc
}

test_what_cannot_grow_on_is_refused() {
    local sentence options
    run_ok corcast grow --terminals 20 -o tree.swc
    run_ok corcast grow --inlet 0,50 --inlet 30,-40 --terminals 40 -o forest.swc
    run_ok corcast grow --terminals 20 --domain ball:20 -o ball.swc
    grep -v '^# domain' tree.swc >homeless.swc
    printf '%s\n' '1 3 0 9 0 1 -1' >bare.swc
    printf '%s\n' '1 3 0 9 0 1 -1' '2 3 0 9 0 1 1' >point.swc
    printf '%s\n' '# flow_share: 3 2' '# flow_share: 4 1' '1 3 0 9 0 1 -1' '2 3 0 4 0 1 1' '3 3 -4 0 0 1 2' '4 3 4 0 0 1 2' >shares.swc
    while IFS='|' read -r sentence options; do
        run corcast grow $options -o out.swc
        expect_status "${sentence%% *}"
        expect_sentence "${sentence#* }"
        [ ! -e out.swc ] || fail "expected no output"
    done <<END
2 --from: node 3 has 3 children.*no node has more than 2|--from $DATA/trifurcation.swc --domain ball:50
2 --terminals is 20; it must be above 20|--from tree.swc --terminals 20
2 missing.swc: cannot be read|--from missing.swc
2 --inlet cannot be combined with --from|--from tree.swc --inlet 0,50
2 --inlet-shares has 3 shares for 2 inlets|--from forest.swc --inlet-shares 1,1,1
2 --inlet-shares: tree 2 of --from already has 20 terminals.*only 10|--from forest.swc --inlet-shares 9,1 --terminals 100
2 has no domain; use --domain|--from homeless.swc
2 node 2 is at z = .*all nodes must be at z = 0|--from ball.swc --domain disc:50
2 --from: node 1 is an inlet without a vessel|--from bare.swc --domain disc:50
2 --from: node 2, a terminal, has the position of its parent|--from point.swc --domain disc:50
2 --refine would move the --from tree|--from tree.swc --refine geometry
2 give --terminal-flow equal, territory or demand|--from shares.swc --domain disc:50
END
}

terminals() {
    awk '/^#/ { next } { place[$1] = $3 " " $4 " " $5; inner[$7] = 1 } END { for (i in place) if (!(i in inner)) print place[i] }' "$1" | sort
}

# A terminal is at its random point. If growth repeated the same points, the new terminals would
# coincide with the old ones.
test_the_points_are_not_those_that_the_same_seed_tosses_for_a_new_tree() {
    run_ok corcast grow --terminals 2 --seed 23 -o small.swc
    run_ok corcast grow --terminals 25 --seed 4 -o new.swc
    run_ok corcast grow --from small.swc --terminals 25 --seed 4 -o grown.swc
    [ "$(terminals new.swc | wc -l) $(terminals grown.swc | wc -l)" = "25 25" ] || fail "expected 25 terminals each"
    [ "$(comm -12 <(terminals new.swc) <(terminals grown.swc) | wc -l)" -eq 0 ] || fail "expected no terminal in both"
}

# expect_radii_kept OLD NEW: every node of OLD, except roots, has exactly the same radius in NEW.
expect_radii_kept() {
    awk '/^#/ { next } FNR == NR { if ($7 != -1) radius[$1] = $6; next }
         $1 in radius && radius[$1] != $6 { print "node " $1 ": " radius[$1] " became " $6; exit }' "$1" "$2" >radii.out
    [ ! -s radii.out ] || fail "$(cat radii.out)"
}

test_a_measured_trunk_keeps_its_radii_and_fills_its_hull() {
    local brava=$SHARED/brava/BG0002records.swc
    [ -r "$brava" ] || skip "no measured tree"
    run_ok corcast convert "$brava" trunk.swc
    run_ok corcast grow --from trunk.swc --keep-radii --domain hull:8.5 --q-perf 30 --terminals 800 -o grown.swc
    expect_kept trunk.swc grown.swc
    expect_radii_kept trunk.swc grown.swc
    grep -qx '# domain: hull:trunk.swc,8.5' grown.swc || fail "expected the hull in the header"
    run_ok corcast info grown.swc --json
    expect_json stdout '.terminals == 800 and .root_radius_mm > 1.68 and .terminal_pressure_mmHg.max < 100 and
        (.terminal_pressure_mmHg.min - 60 | fabs) < 1e-6'
    run corcast grow --from trunk.swc --keep-radii --domain hull:8.5 --q-perf 900 --terminals 200 -o thick.swc
    expect_status 2
    expect_sentence '^corcast grow: --keep-radii: the vessels of --from are too narrow for --q-perf 900 ml/min: on the path to .* give a flow below [0-9.]+ ml/min$'
}

test_domains_stand_where_they_are_placed() {
    run_ok corcast grow --domain ellipsoid:12,9,7@100,-20.5,33 --terminals 120 -o placed.swc
    run_ok corcast info placed.swc --json
    expect_json stdout '.bbox_mm[0][0] > 87 and .bbox_mm[1][0] < 113 and .bbox_mm[1][2] < 41 and .bbox_mm[0][2] > 25'
    grep -qx '# domain: ellipsoid:12,9,7@100,-20.5,33' placed.swc || fail "expected the place in the header"
    run_ok corcast refine placed.swc --refine geometry -o refined.swc
    run corcast grow --domain hull:placed.swc,5@30,0,0 -o hull.swc
    expect_status 2
    expect_sentence 'hull:placed.swc,5@30,0,0: a hull surrounds its tree and cannot be placed with @$'
    run corcast grow --domain hull:5 -o hull.swc
    expect_status 2
    expect_sentence "needs the tree of --from; specify --from"
}

test_a_tree_outside_its_domain_is_said_where_and_by_how_much() {
    write_measured
    run corcast grow --from measured.swc --domain rect:40,40@203.5,0 --terminals 50 -o grown.swc
    expect_status 2
    expect_sentence 'node 20 is (189|190) mm outside. Move the domain with @X,Y,Z'
}

run_tests "$@"
