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

# for_class NAME: runs the tests of a class of tests/python/corcast_test.py.
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
    sed -n '/^```python$/,/^```$/{/^```/!p}' "$REPO/docs/PYTHON.md" | sed '/^# test_front.py$/,/^    assert_picture/d' >examples.py
    [ "$(grep -c '^# Example' examples.py)" -ge 10 ] || fail 'expected ten examples in docs/PYTHON.md'
    python examples.py
    expect_status 0
}

# pytest ARGUMENT...: runs the tests of the current folder with the plugin.
pytest() {
    python -m pytest -q -p no:cacheprovider -p corcast_pytest "$@"
}

test_a_picture_is_asserted_in_pytest() {
    "$PYTHON" -c 'import pytest' 2>/dev/null || skip "pytest is not installed for $PYTHON"
    sed -n '/^# test_front.py$/,/^```$/{/^```/!p}' "$REPO/docs/PYTHON.md" >test_front.py
    cat >>test_front.py <<'END'


class Drawing:
    def savefig(self, path):
        path.write_bytes(open("front.png", "rb").read())


def test_objects(assert_picture):
    assert_picture(Drawing())
    assert_picture(Drawing(), name="views/second")


def test_bad_option(assert_picture):
    assert_picture("front.png", "options.png", tear="B")
END
    run_ok corcast grow --terminals 9 --seed 3 -o tree.swc
    run_ok corcast render tree.swc --size 60x40 -o front.png
    pytest -k 'not bad'
    expect_status 1
    expect_stdout '^test_front\.test_front\.png: new: has no reference$'
    expect_stdout "--accept test_front\.test_front\.png --reason '\.\.\.'\$"
    pytest -k 'not bad' --accept-pictures 'first'
    expect_status 0
    pytest
    expect_status 1
    expect_stdout "^unknown option '--tear'"
    expect_stdout '^1 failed, 2 passed'
    expect_file references/views/second.png
    run_ok corcast render tree.swc --size 60x40 --look ink -o front.png
    pytest -k front
    expect_status 1
    expect_stdout '^test_front\.test_front\.png: changed: .* of the pixels are off by more than 2 levels'
    expect_stdout '^pictures that differ: .*/build/pictures/report\.html$'
    grep -q 'test_front.test_front.png' build/pictures/report.html || fail 'expected a page with the picture'
}

run_tests "$@"
