#!/usr/bin/env bash
# `certify`: bounds of grown, forked and measured trees. A checker that shares no code and computes
# in exact fractions must accept the certificates, and refuse changed ones.
. "$(dirname "$0")/../lib.sh"

check_certificate() {
    run python3 "$REPO/tests/oracle/check_certificate.py" "$@"
}

# expect_proved T [OPTION ...]: the certificate of T proves the bound, which is below T's target.
expect_proved() {
    run_ok corcast certify "$@" --certificate proof.cert --json
    mv stdout certify.json
    expect_json certify.json '.bound > 0 and .bound <= .best_geometry and .best_geometry <= .target'
    check_certificate "$1" proof.cert
    expect_status 0
    expect_stdout "proved: .* at least $(jq .bound certify.json | cut -c 1-8)"
}

test_grown_trees_of_all_kinds_are_bounded_closely() {
    local options
    for options in '--lambda 0.5' '--domain ball:50' '--domain ball:50 --lambda 4' \
        '--terminal-flow territory --lambda 1.5'; do
        # shellcheck disable=SC2086
        run_ok corcast grow --terminals 185 --seed 23 $options -o tree.swc
        expect_proved tree.swc
        expect_json certify.json '.gap < 0.0005 and .terminals == 185 and .best_murray > .best_geometry'
    done
}

test_a_bound_of_a_thousand_terminals_is_within_a_twentieth_of_a_percent() {
    run_ok corcast grow --seed 7 -o tree.swc
    expect_proved tree.swc
    expect_json certify.json '.gap < 0.0005 and .target / .bound < 1.03'
}

test_a_refined_tree_is_nearer_to_its_bound() {
    run_ok corcast grow --terminals 285 --seed 23 -o tree.swc
    run_ok corcast refine tree.swc --refine geometry -o refined.swc
    expect_proved tree.swc
    mv certify.json plain.json
    expect_proved refined.swc
    jq -se '.[0].target > .[1].target and .[1].target >= .[0].bound' plain.json certify.json >/dev/null ||
        fail "expected refinement to end between the tree and its bound"
}

test_the_parts_of_the_distance_add_up() {
    run_ok corcast grow --terminals 285 --seed 23 -o tree.swc
    run_ok corcast certify tree.swc --explain-gap --json
    expect_json stdout '(.parts | add) as $sum | .target - .bound - $sum | fabs < 1e-9'
    expect_json stdout '.parts.search > 0 and .parts.rules > 0 and .parts.radii > 0 and .refined < .target'
    run_ok corcast certify tree.swc
    expect_stdout '^  lower bound  *[0-9.]*, proved'
    expect_stdout 'above bound +[0-9.]+ %'
}

test_forests_forks_polylines_and_measured_trees_are_bounded() {
    run_ok corcast grow --terminals 90 --inlet 0,50 --inlet 0,-50 -o forest.swc
    expect_proved forest.swc
    expect_proved "$DATA/trifurcation.swc" --lambda 2
    expect_proved "$DATA/coronary.swc" --lambda 2
    expect_proved "$DATA/coronary.swc" --lambda 2 --flow-split murray --flow-exponent 2.7
    expect_proved "$DATA/collinear.swc" --lambda 2.3
}

test_a_certificate_with_one_digit_changed_is_refused() {
    run_ok corcast grow --terminals 20 -o tree.swc
    run_ok corcast certify tree.swc --certificate proof.cert
    sed '9s/[1-8]$/9/;9s/0$/1/' proof.cert >changed.cert
    check_certificate tree.swc changed.cert
    expect_status 1
    expect_sentence 'changed.cert: its SHA-256 is another'
}

# seal FILE: replaces the SHA-256 in a changed certificate by that of its present content.
seal() {
    sed -i '/^# sha256/d' "$1"
    printf '# sha256: %s\n' "$(sha256sum "$1" | cut -c 1-64)" >>"$1"
}

test_a_certificate_that_claims_too_much_is_refused_whatever_its_sum_says() {
    run_ok corcast grow --terminals 20 -o tree.swc
    run_ok corcast certify tree.swc --certificate proof.cert
    awk '/^# bound/ { $3 *= 1.0001 } { print }' proof.cert >bound.cert
    awk '!/^#/ { $6 *= 0.99 } { print }' proof.cert >charge.cert
    awk '!/^#/ { $3 *= 1.01; $4 *= 1.01 } { print }' proof.cert >pull.cert
    awk '!/^#/ && !cut++ { next } { print }' proof.cert >cut.cert
    local name
    for name in bound charge pull cut; do
        seal $name.cert
        check_certificate tree.swc $name.cert
        expect_status 1
        expect_sentence "$name.cert: (it proves|the pull)"
    done
    run_ok corcast grow --terminals 20 --seed 2 -o other.swc
    check_certificate other.swc proof.cert
    expect_status 1
}

test_says_what_has_no_bound() {
    run_ok corcast grow --terminals 20 --viscosity-law pries -o pries.swc
    run corcast certify pries.swc
    expect_status 2
    expect_sentence "pries.swc: no bound can be proved for the viscosity law pries"
    expect_proved pries.swc --viscosity-law constant
    run_ok corcast grow --terminals 20 --lambda 0 -o length.swc
    run corcast certify length.swc --certificate none.cert
    expect_status 2
    expect_sentence 'length.swc: lambda is 0, .* from 0.5 to 4; give --lambda'
    run corcast certify pries.swc --lambda 4.5
    expect_status 2
    expect_sentence '^corcast certify: --lambda.*4.5.*from 0.5 to 4'
    run corcast certify "$DATA/coronary.swc"
    expect_status 2
    expect_sentence 'coronary.swc does not state lambda.*--lambda'
    sed 's/ [^ ]* 1$/ 0 1/' length.swc >thin.swc
    run corcast certify thin.swc --lambda 2
    expect_status 2
    expect_sentence 'thin.swc: node 2: blood flows to it through a radius of 0'
    run corcast certify "$DATA/coronary.swc" --lambda 2 --explain-gap
    expect_status 2
    expect_sentence '--explain-gap: .*coronary.swc: the tree cannot be refined'
    [ ! -e none.cert ] || fail "expected no certificate of a tree without a bound"
}

# For one set, annealing ends 0.06 % above the optimum (docs/VALIDATION.md).
test_annealing_finds_the_best_trees_of_small_point_sets() {
    run_ok "$(dirname "$CHECK_TREE")/optima/optima" "$REPO/tests/optima/sets.txt" 5 5
    expect_stdout '^\| disc \| 5 \| 105 \| 20 \|'
    expect_stdout '^The best tree of 39 of 40\.$'
}

test_reports_in_json_carry_the_bound() {
    run_ok corcast grow --terminals 85 --seed 3 --bound --json grow.json -o tree.swc
    run_ok corcast certify tree.swc --json
    cp stdout certified.json
    expect_json grow.json '.bound.above > 0.005 and .bound.bound < .target'
    run_ok corcast info tree.swc --json --bound
    expect_json stdout "(.bound.bound / $(jq .bound certified.json) - 1 | fabs) < 1e-9"
    run_ok corcast certify "$DATA/coronary.swc" --lambda 2 --json
    cp stdout certified.json
    run_ok corcast info "$DATA/coronary.swc" --json --bound --lambda 2
    expect_json stdout "(.bound.bound / $(jq .bound certified.json) - 1 | fabs) < 1e-9"
    run_ok corcast info "$DATA/coronary.swc" --json --bound
    expect_json stdout '.bound == null'
    run_ok corcast refine tree.swc --json refined.json -o refined.swc
    expect_json refined.json '.bound.target == .target or (.bound.target / .target - 1 | fabs) < 1e-9'
    expect_json refined.json '.target < .target_before and .bound.above > 0 and .moves_kept <= .moves_tried and .stopped == false'
    run_ok corcast grow --terminals 30 --viscosity-law pries --bound --json pries.json -o pries.swc
    expect_json pries.json '.bound == null'
    run corcast info tree.swc --bound
    expect_status 2
    expect_sentence '--bound needs --json'
}

run_tests "$@"
