#!/usr/bin/env bash
# `grow` with several inlets: trees side by side, checked by a program that shares no code with
# corcast.
. "$(dirname "$0")/../lib.sh"

two=(--inlet 0,50 --inlet 30,-40)

# terminals_of FILE: prints the number of terminals of each tree, in the order of the roots.
terminals_of() {
    awk '!/^#/ { if ($7 == -1) trees++; tree[$1] = trees; children[$7]++ }
         END {
             for (id in tree) if (!(id in children)) count[tree[id]]++
             for (k = 1; k <= trees; k++) printf "%s%d", (k > 1 ? " " : ""), count[k]
         }' "$1"
}

expect_terminals() {
    [ "$(terminals_of "$1")" = "$2" ] || fail "expected trees of $2 terminals, got $(terminals_of "$1")"
}

test_two_trees_share_the_disc_without_crossing() {
    run_ok corcast grow "${two[@]}" --terminals 500 -o forest.swc
    check_tree forest.swc
    expect_stdout '^terminals 500$'
    expect_terminals forest.swc '250 250'
    [ "$(awk '!/^#/ && $7 == -1 { printf "%s,%s ", $3, $4 }' forest.swc)" = '0,50 30,-40 ' ] ||
        fail "expected the roots at the inlets, in their order"
}

test_shares_are_kept_to_the_terminal() {
    run_ok corcast grow "${two[@]}" --inlet-shares 0.7,0.3 --terminals 401 -o forest.swc
    check_tree forest.swc
    expect_terminals forest.swc '281 120'
    run_ok corcast grow "${two[@]}" --inlet -50,0 --inlet 3,2 --inlet-shares 1,2,3,400 --terminals 60 -o forest.swc
    check_tree forest.swc
    expect_terminals forest.swc '1 1 1 57'
}

test_trees_take_territories_as_large_as_their_shares() {
    run_ok corcast grow "${two[@]}" --inlet-shares 3,1 --terminals 800 -o forest.swc
    awk '!/^#/ { if ($7 == -1) trees++; tree[$1] = trees; x[$1] = $3; y[$1] = $4 }
         END {
             for (u = -49; u < 50; u += 2) for (v = -49; v < 50; v += 2) {
                 if (u * u + v * v > 2500) continue
                 least = 1e9
                 for (id in x) {
                     d = (u - x[id]) ^ 2 + (v - y[id]) ^ 2
                     if (d < least) { least = d; owner = tree[id] }
                 }
                 all++; first += owner == 1
             }
             exit !(first / all > 0.68 && first / all < 0.82)
         }' forest.swc || fail "expected about three quarters of the disc for the first tree"
}

test_forests_grow_in_space_and_in_any_law() {
    run_ok corcast grow --domain ball:30 --inlet 0,30,0 --inlet 0,-30,0 --inlet 30,0,0 --terminals 300 \
        --gamma 2.55 --lambda 1 -o forest.swc
    check_tree forest.swc
    expect_terminals forest.swc '100 100 100'
    run_ok corcast grow "${two[@]}" --terminals 200 --viscosity-law pries --terminal-flow territory -o forest.swc
    check_tree forest.swc
    expect_terminals forest.swc '100 100'
}

test_as_many_terminals_as_inlets_are_as_many_segments() {
    run_ok corcast grow "${two[@]}" --terminals 2 -o forest.swc
    check_tree forest.swc
    expect_stdout '^segments 2$'
}

test_the_number_of_threads_does_not_change_a_forest() {
    run_ok corcast grow "${two[@]}" --inlet-shares 0.6,0.4 --terminals 3000 --threads 1 -o one.swc
    run_ok corcast grow "${two[@]}" --inlet-shares 0.6,0.4 --terminals 3000 --threads 3 -o many.swc
    expect_same one.swc many.swc
}

test_info_scene_and_render_take_forests() {
    run_ok corcast grow "${two[@]}" --terminals 40 -o forest.swc
    run_ok corcast info forest.swc
    expect_stdout '40 terminals, 38 bifurcations, 2 roots'
    expect_stdout 'terminals at  60 to 60 mmHg'
    run_ok corcast scene forest.swc -o forest.pov
    run_ok corcast render --exact forest.swc --color-by pressure --size 60x60 -o forest.png
    expect_file forest.png
}

test_inlets_come_from_a_recipe_and_the_command_line_replaces_them() {
    printf '%s\n' '[grow]' 'inlet = 0,50' 'inlet = 30,-40' 'inlet-shares = 3,1' >recipe.ini
    run_ok corcast grow --recipe recipe.ini --terminals 40 -o recipe.swc
    run_ok corcast grow "${two[@]}" --inlet-shares 3,1 --terminals 40 -o forest.swc
    expect_same recipe.swc forest.swc
    run_ok corcast grow --recipe recipe.ini --inlet -50,0 --inlet 50,0 --terminals 40 -o other.swc
    [ "$(grep -c ' -1$' other.swc)" = 2 ] || fail "expected the inlets of the command line alone"
}

test_wrong_inlets_and_shares_are_refused() {
    local sentence options
    while IFS='|' read -r sentence options; do
        run corcast grow $options -o forest.swc
        expect_status 2
        expect_sentence "$sentence"
        expect_only
    done <<'END'
--inlet is 0,51,0; it must be inside the domain disc:50|--inlet 0,50 --inlet 0,51
--inlet 0,50,0 occurs twice|--inlet 0,50 --inlet 3,4 --inlet 0,50
clear of those of the other inlets|--inlet 0,50 --inlet 0,49.9 --q-perf 50000
--inlet: 'right' is not X,Y or X,Y,Z|--inlet right
--inlet-shares has 3 shares for 2 inlets|--inlet 0,50 --inlet 3,4 --inlet-shares 1,1,1
--inlet-shares has 2 shares for 1 inlets|--inlet-shares 1,1
--inlet-shares is 0; it must be a finite number above 0|--inlet 0,50 --inlet 3,4 --inlet-shares 1,0
--inlet-shares is -0.5; it must be|--inlet 0,50 --inlet 3,4 --inlet-shares=-0.5,1
--inlet-shares: '1,half' is not a list of numbers|--inlet 0,50 --inlet 3,4 --inlet-shares 1,half
--terminals is 1; it must be at least 2, one per inlet|--inlet 0,50 --inlet 3,4 --terminals 1
END
}

run_tests "$@"
