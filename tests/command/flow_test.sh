#!/usr/bin/env bash
# `flow`: steady flow in trees and in networks with loops, beside dense matrices in Python.
. "$(dirname "$0")/../lib.sh"

TUMOR=secomb/Tumor1998.network.dat
PRIES="--viscosity-law pries --plasma-viscosity 1.0466 --hematocrit 0.4"

# oracle ARGUMENTS: runs tests/oracle/flow.py, which fails if its results differ.
oracle() {
    /usr/bin/python3 -c 'import numpy' 2>python.error || skip "numpy is not installed"
    /usr/bin/python3 "$REPO/tests/oracle/flow.py" "$@" >said 2>&1 || fail "flow.py $1: $(tail -1 said)"
}

# same_fields A.csv B.csv FIELD TOLERANCE: the relative difference of a field is below the tolerance.
same_fields() {
    awk -F, -v name="$3" -v most="$4" '/^#/ { next } FNR == 1 || !column[FILENAME] {
            for (k = 1; k <= NF; k++) if (index($k, name " ") == 1 || index($k, "\"" name " ") == 1) column[FILENAME] = k; next }
        FILENAME == ARGV[1] { value[$1] = $column[FILENAME]; next }
        value[$1] != "" { n++; d = value[$1] - $column[FILENAME]; if ((d < 0 ? -d : d) > most * value[$1]) exit 1 }
        END { if (n < 2) exit 1 }' "$1" "$2" || fail "$3 of $1 and $2 differ by more than $4"
}

test_a_tree_keeps_its_fields() {
    run_ok corcast grow --terminals 500 --seed 3 -o t.swc --quiet
    run_ok corcast convert t.swc fields.csv --fields flow,pressure,velocity,wss --quiet
    run_ok corcast flow t.swc -o flow.csv --json
    expect_json stdout '.segments == 999 and .loops == 0 and .unknowns == 0 and .mass_imbalance < 1e-15'
    same_fields fields.csv flow.csv flow 1e-13
    same_fields fields.csv flow.csv pressure 1e-14
    same_fields fields.csv flow.csv velocity 1e-13
    same_fields fields.csv flow.csv wss 1e-13
    run_ok corcast flow t.swc --viscosity-law pries --plasma-viscosity 1.05 --hematocrit 0.4 -o flow.csv
    run_ok corcast convert t.swc fields.csv --fields flow,pressure --viscosity-law pries --plasma-viscosity 1.05 \
        --hematocrit 0.4 --quiet
    same_fields fields.csv flow.csv pressure 1e-13
}

test_a_tumor_has_its_stored_flows() {
    [ -s "$SHARED/$TUMOR" ] || skip "$TUMOR is not there"
    run_ok corcast flow "$SHARED/$TUMOR" --viscosity 3 -o f.csv --json --quiet
    expect_json stdout '.loops == 14 and .floating_components == 2 and .mass_imbalance < 1e-12'
    oracle stored "$SHARED/$TUMOR" f.csv
    run_ok corcast flow "$SHARED/$TUMOR" $PRIES --separation --cell-volume 55 -o f.csv --quiet
    oracle separation "$SHARED/$TUMOR" f.csv 0.4 1.0466 55
}

test_red_cells_divide_as_in_dense_matrices() {
    oracle make n.dat
    run_ok corcast flow n.dat $PRIES --separation -o f.csv --json --quiet
    expect_json stdout '.converged == 1 and .loops == 13 and .cell_imbalance < 1e-12 and .mass_imbalance < 1e-12'
    oracle separation n.dat f.csv 0.4 1.0466 92
    run_ok corcast flow n.dat $PRIES --separation --summary s.csv -o f.vtp --quiet
    run_ok corcast convert f.vtp g.csv --quiet
    oracle separation n.dat g.csv 0.4 1.0466 92
    grep -q '^cell_imbalance,[0-9.e-]*,$' s.csv || fail "s.csv lacks cell_imbalance"
}

test_unknown_ends_are_estimated() {
    oracle make n.dat
    printf 'id,pressure [kPa],flow\n21,6.066168627,\n22,,-2.75e-6\n' >b.csv
    sed 's/^4 boundary/2 boundary/; /^23 0 /d; /^24 2 /d' n.dat >few.dat
    run_ok corcast flow n.dat --boundary b.csv --ends estimate --viscosity 3 --target-wss 4 --target-pressure 33 \
        --starts 3 --seed 2 --threads 1 -o f.csv --json --quiet
    expect_json stdout '.estimated_ends == 2 and .turned_max >= .turned_min'
    oracle estimate few.dat f.csv 3 33 4
    run_ok corcast flow few.dat --ends estimate --viscosity 3 --threads 1 -o 1.csv --quiet
    run_ok corcast flow few.dat --ends estimate --viscosity 3 --threads 3 -o 3.csv --quiet
    expect_same 1.csv 3.csv
    run corcast flow few.dat --viscosity 3 --target-wss 4
    expect_status 2
    expect_sentence '\-\-target-wss is for --ends estimate'
}

test_other_commands_solve_networks_with_loops() {
    oracle make n.dat
    run_ok corcast flow n.dat --boundary terminals --q-perf 2e-5 --p-perf 45 --viscosity 3 -o f.vtp --quiet
    run_ok corcast convert f.vtp f.csv --quiet
    sed 's/ 0 0.4$/ * 0.4/' n.dat >free.dat
    run_ok corcast convert free.dat d.vtp --fields pressure,wss --q-perf 2e-5 --p-perf 45 --viscosity 3 --quiet
    run_ok corcast convert d.vtp d.csv --quiet
    same_fields d.csv f.csv pressure 1e-12
    same_fields d.csv f.csv wss 1e-11
}

# refuse_table ROWS SENTENCE
refuse_table() {
    printf "$1" >b.csv
    run corcast flow n.dat --viscosity 3 --boundary b.csv
    expect_status 2
    expect_sentence "$2"
}

test_bad_boundary_conditions_are_refused() {
    oracle make n.dat
    refuse_table 'id,flow\n21,3\n22,-1\n23,-1\n24,-0.5\n' \
        'the inflows of the vessels that are connected with node 21 sum to 0.5 ml/min; they must sum to 0'
    refuse_table 'id,flow\n99,3\n' 'b.csv:2: .*99'
    refuse_table 'id,pressure\n21,40\n22,10\n23,10\n' 'node 24 is an end without a boundary condition'
    refuse_table 'id,pressure,flow\n21,40,1\n' 'node 21 has a pressure and a flow'
    refuse_table 'id,pressure [mm]\n21,40\n' 'the unit of the column pressure is mm; it must be convertible to mmHg'
    refuse_table 'id,pressure,hematocrit\n21,40,1.5\n' 'node 21 has the hematocrit 1.5; it must be from 0 to 0.95'
    refuse_table 'id,speed\n21,40\n' 'must have the columns id and pressure or flow'
    sed 's/^21 0 /21 1 /' n.dat >type.dat
    run corcast flow type.dat --viscosity 3
    expect_status 2
    expect_sentence 'node 21 has the boundary type 1; it must be 0 \(pressure\) or 2 \(flow\)'
    run corcast flow n.dat --viscosity 3 --boundary nothing
    expect_status 2
    expect_sentence "'nothing' is not a FILE.csv, file or terminals"
    run corcast flow n.dat --viscosity 3 --q-perf 1
    expect_status 2
    expect_sentence '\-\-q-perf is for --boundary terminals'
    run corcast flow n.dat --viscosity 3 --separation
    expect_status 2
    expect_sentence '\-\-separation is for --viscosity-law pries'
    run corcast flow n.dat --viscosity 3 -o f.stl
    expect_status 2
}

test_a_ring_without_boundary_conditions_is_refused() {
    cat >ring.dat <<'END_OF_RING'
ring beside a vessel
1 1 1
1 1 1
1
1
4
4 segments
name type from to diam
1 5 1 2 10
2 5 2 3 10
3 5 3 1 10
4 5 4 5 10
5 nodes
name x y z
1 0 0 0
2 100.5 0 0
3 0 100 0
4 300 0 0
5 400 0 0
2 boundary nodes
node type value
4 0 30
5 0 20
END_OF_RING
    run corcast flow ring.dat --viscosity 3
    expect_status 2
    expect_sentence 'the component of node [123] has no boundary condition'
    run_ok corcast flow ring.dat --viscosity 3 --ends closed --json
    expect_json stdout '.loops == 1 and .floating_components == 1 and .lost_segments == 3 and .largest_flow > 0'
}

test_cells_that_do_not_settle_are_reported() {
    oracle make n.dat
    awk 'NF == 7 && $2 == 5 { $5 = $5 * 0.19 } { print }' n.dat >thin.dat
    run_ok corcast flow thin.dat $PRIES --separation --json
    expect_json stdout '.converged == 0 and .rounds == 100 and .hematocrit_change > 1e-3'
    grep -q 'the hematocrit has not converged: in the last of 100 iterations' stderr || fail "no warning: $(cat stderr)"
}

run_tests
