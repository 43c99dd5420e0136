#!/usr/bin/env bash
# Scenes of large trees, which POV-Ray takes long to read. Pictures have 8 x 6 pixels.
. "$(dirname "$0")/../lib.sh"

# reads MODEL ARGUMENT ...: POV-Ray reads the scene of tree.swc as MODEL, written with the
# arguments, without a warning.
reads() {
    run_ok corcast scene tree.swc --quiet --size 8x6 --ini -o s.pov --model "$@"
    povray s.ini ${SWITCH-} >log 2>&1 || fail "expected POV-Ray to read $*: $(tail -3 log | tr '\n' ' ')"
    ! grep -q 'Warning:' log || fail "expected no warning of $*: $(grep -m 1 'Warning:' log)"
}

# Slow: POV-Ray reads 10 scenes of 9,999 segments.
test_trees_of_10000_segments_are_read_without_a_warning() {
    local model
    run_ok corcast grow --terminals 5000 --quiet -o tree.swc
    for model in $(corcast models | cut -f 1); do
        reads "$model"
        reads "$model" --color-by flow --log --look print --shadows on
    done
}

# Joints are meshes here: POV-Ray would take minutes to find the constants of so many exact joints,
# and half an hour for those of an isosurface.
# Slow: POV-Ray reads 4 scenes of 99,999 segments.
test_trees_of_100000_segments_are_read_without_a_warning() {
    local model
    run_ok corcast grow --terminals 50000 --quiet -o tree.swc
    for model in cylinders rounded blob; do
        reads "$model"
    done
    SWITCH=Declare=Joint_Sides=16 reads joined
}

# Slow: three inlets, 9,997 segments.
test_a_large_forest_is_read_without_a_warning() {
    local model
    run_ok corcast grow --terminals 5000 --inlet 0,50 --inlet 0,-50 --inlet 50,0 --quiet -o tree.swc
    for model in $(corcast models | cut -f 1); do
        reads "$model" --classes 7 --color-by strahler --prune-radius 0.05
    done
}

run_tests "$@"
