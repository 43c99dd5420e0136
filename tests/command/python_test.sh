#!/usr/bin/env bash
# corcast.py: its own tests, and the examples of docs/PYTHON.md.
. "$(dirname "$0")/../lib.sh"

PYTHON=/usr/bin/python3 # the one whose numpy `make deps` installs

python() {
    run env PYTHONPATH="$REPO/src/python" PYTHONDONTWRITEBYTECODE=1 CORCAST="$CORCAST" CORCAST_LIBRARY="$REPO/build/libcorcast.so.0" "$PYTHON" "$@"
}

need_numpy() {
    "$PYTHON" -c 'import numpy' 2>/dev/null || skip "numpy is not installed for $PYTHON"
}

# test_python NAME...: the classes of tests/python/corcast_test.py.
for_class() {
    need_numpy
    python "$REPO/tests/python/corcast_test.py" "$1"
    expect_status 0
    grep -q '^OK$' stderr || fail "expected every test of $1 to pass: $(tail -1 stderr)"
}

test_trees_in_python() {
    for_class Trees
}

test_pictures_in_python() {
    for_class Pictures
}

test_files_in_python() {
    for_class Files
}

test_faults_in_python() {
    for_class Faults
}

test_the_examples_of_the_guide_run() {
    need_numpy
    sed -n '/^```python$/,/^```$/{/^```/!p}' "$REPO/docs/PYTHON.md" >examples.py
    [ "$(grep -c '^# Example' examples.py)" -ge 10 ] || fail 'expected ten examples in docs/PYTHON.md'
    python examples.py
    expect_status 0
}

run_tests
