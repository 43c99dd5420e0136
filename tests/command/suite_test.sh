#!/usr/bin/env bash
# `compare --reference`: a folder of pictures against a folder of references, as a test suite.
. "$(dirname "$0")/../lib.sh"

# picture LEVEL: a grey PPM of 5 x 4, pixel 7 (counted from 0) of the level given.
picture() {
    printf 'P6\n5 4\n255\n'
    printf 'ddd%.0s' 1 2 3 4 5 6 7
    printf "\\$(printf %o "$1")%.0s" 1 2 3
    printf 'ddd%.0s' 1 2 3 4 5 6 7 8 9 10 11 12
}

# Six cases, one of each state but `broken`, two that are the same.
folders() {
    mkdir -p stored/views drawn/views
    picture 100 | tee stored/a.ppm drawn/a.ppm >stored/views/same.ppm
    cp stored/a.ppm drawn/views/same.ppm
    cp stored/a.ppm stored/moved.ppm
    picture 131 >drawn/moved.ppm
    cp stored/a.ppm stored/near.ppm
    picture 101 >drawn/near.ppm
    cp stored/a.ppm stored/gone.ppm
    picture 42 >drawn/fresh.ppm
    echo 'no picture' >drawn/notes.txt
}

test_every_case_has_its_state() {
    folders
    run corcast compare --reference stored drawn --levels 1
    expect_status 1
    expect_stdout '^changed moved\.ppm: color: pixels off by more than 1 level.* the worst, 31 levels'
    expect_stdout '^new     fresh\.ppm: has no reference$'
    expect_stdout '^missing gone\.ppm: has a reference but no picture$'
    expect_stdout '^within  near\.ppm: 1 of 20 pixels differ, 0 are masked$'
    expect_stdout '^differ: 6 cases: 2 same, 1 within, 1 changed, 1 new, 1 missing; 1 other file$'
}

test_json_and_junit_say_the_same() {
    folders
    run corcast compare --reference stored drawn --levels 1 --json --junit j.xml
    expect_status 1
    expect_json stdout '.verdict == "differ" and .changed == 1 and .same == 2'
    expect_json stdout '[.cases[] | select(.state == "changed")][0].name == "moved.ppm"'
    xmllint --noout j.xml || fail "expected XML"
    grep -q 'tests="6" failures="3"' j.xml || fail "expected 3 of 6 to fail: $(cat j.xml)"
    grep -q '<testcase classname="drawn" name="views/same.ppm"' j.xml || fail "expected a case below a folder"
}

test_what_is_accepted_agrees_afterwards_and_has_its_reason() {
    folders
    for case in moved.ppm near.ppm fresh.ppm gone.ppm; do
        run_ok corcast compare --reference stored drawn --accept $case --reason 'a new lamp'
    done
    run_ok corcast compare --reference stored drawn
    expect_stdout '^agree: 5 cases: 5 same; 1 other file$'
    expect_same stored/fresh.ppm drawn/fresh.ppm
    [ ! -e stored/gone.ppm ] || fail 'expected the reference to be removed'
    [ "$(cut -f 1,3 stored/accepted.tsv | tail -n 1)" = "$(printf 'gone.ppm\ta new lamp')" ] ||
        fail "expected the reason: $(cat stored/accepted.tsv)"
    [ "$(awk -F '\t' '$1 == "fresh.ppm" { print $2 }' stored/accepted.tsv)" = "$(sha256sum <drawn/fresh.ppm | cut -c 1-64)" ] ||
        fail "expected the hash of what was accepted"
    run corcast compare --reference stored drawn --accept nothing.ppm --reason 'x'
    expect_status 2
    expect_sentence "no picture 'nothing\.ppm' in drawn or stored"
    run corcast compare --reference stored drawn --accept a.ppm
    expect_status 2
    expect_sentence '--accept and --reason must be given together'
}

test_only_a_case_that_compare_lists_is_accepted() {
    local name
    folders
    mkdir victim
    picture 7 >victim/v.ppm
    cp victim/v.ppm kept.ppm
    cp drawn/a.ppm v.ppm
    for name in ../victim/v.ppm ../v.ppm "$PWD/victim/v.ppm" ./a.ppm views/../a.ppm views//same.ppm notes.txt ../drawn/notes.txt \
        accepted.tsv views '' .; do
        run corcast compare --reference stored drawn --accept "$name" --reason 'x'
        expect_status 2
    done
    expect_same victim/v.ppm kept.ppm
    [ ! -e stored/accepted.tsv ] || fail "expected nothing to be accepted: $(cat stored/accepted.tsv)"
    run corcast compare --reference victim drawn --accept ../stored/a.ppm --reason 'x'
    expect_sentence "no picture '\.\./stored/a\.ppm' in drawn or victim"
}

test_the_first_picture_may_be_accepted_before_there_are_references() {
    folders
    run_ok corcast compare --reference none drawn --accept views/same.ppm --reason 'first'
    expect_same none/views/same.ppm drawn/views/same.ppm
    run corcast compare --reference stored nothing-drawn --accept a.ppm --reason 'x'
    expect_status 3
    expect_file stored/a.ppm
}

test_a_pipe_is_a_broken_case_and_is_not_waited_for() {
    mkdir stored drawn
    picture 100 | tee stored/a.ppm stored/b.ppm >drawn/a.ppm
    picture 101 >drawn/b.ppm
    mkfifo stored/p.png drawn/p.png stored/q.png stored/b.mask.png
    cp drawn/a.ppm drawn/q.png
    run timeout 20 "$CORCAST" compare --reference stored drawn
    expect_status 1
    expect_stdout '^broken  b\.ppm: stored/b\.mask\.png: .*is a pipe'
    expect_stdout '^broken  p\.png: stored/p\.png: .*is a pipe'
    expect_stdout '^broken  q\.png: stored/q\.png: .*is a pipe'
    run timeout 20 "$CORCAST" compare --reference stored drawn --accept p.png --reason 'x'
    expect_status 2
    expect_sentence 'drawn/p\.png: .*is a pipe'
    mkfifo stored/accepted.tsv
    run timeout 20 "$CORCAST" compare --reference stored drawn --accept a.ppm --reason 'x'
    expect_status 2
    expect_sentence 'accepted\.tsv: .*is a pipe'
}

test_a_link_to_a_folder_around_it_is_not_followed() {
    mkdir -p stored/views drawn/views elsewhere
    picture 100 | tee stored/a.ppm drawn/a.ppm stored/views/b.ppm drawn/views/b.ppm >elsewhere/c.ppm
    ln -s .. drawn/views/loop
    ln -s . drawn/again
    ln -s ../elsewhere stored/linked
    ln -s ../elsewhere drawn/linked
    run_ok corcast compare --reference stored drawn
    expect_stdout '^agree: 3 cases: 3 same; 2 other files$'
}

test_what_is_masked_is_not_judged() {
    mkdir stored drawn
    picture 100 >stored/a.ppm
    picture 200 >drawn/a.ppm
    { printf 'P5\n5 4\n255\n'; head -c 7 /dev/zero; printf '\377'; head -c 12 /dev/zero; } | pnmtopng >stored/a.mask.png
    run_ok corcast compare --reference stored drawn
    expect_stdout '^within  a\.ppm: 0 of 20 pixels differ, 1 are masked$'
    pnmtopng <<<"P2 5 4 255 $(printf '9 %.0s' {1..20})" >stored/a.mask.png
    run corcast compare --reference stored drawn
    expect_status 1
    expect_stdout '^broken  a\.ppm: the mask hides every pixel$'
    pnmtopng <<<'P2 2 1 255 0 9' >stored/a.mask.png
    run corcast compare --reference stored drawn
    expect_stdout '^broken  a\.ppm: the mask, the reference and the picture differ in size or bits per pixel$'
}

test_a_broken_picture_or_one_of_another_size_fails_alone() {
    mkdir stored drawn
    picture 100 | tee stored/a.ppm stored/b.ppm >stored/c.ppm
    cp stored/a.ppm drawn/a.ppm
    head -c 20 stored/a.ppm >drawn/b.ppm
    pnmcut -width 4 stored/a.ppm >drawn/c.ppm
    run corcast compare --reference stored drawn
    expect_status 1
    expect_stdout '^broken  b\.ppm: drawn/b\.ppm: '
    expect_stdout '^changed c\.ppm: the images differ in size \(5 x 4 and 4 x 4 pixels\)'
    expect_stdout '1 same, 1 changed, 1 broken$'
}

test_folders_without_pictures_and_options_of_pairs_are_refused() {
    mkdir stored drawn
    run corcast compare --reference stored drawn
    expect_status 2
    expect_sentence 'no pictures found in stored or drawn'
    run corcast compare --reference stored drawn --html page.html
    expect_status 2
    expect_sentence '--html is for two pictures, not for --reference'
    run corcast compare --reference nowhere drawn
    expect_status 3
    expect_sentence 'nowhere.*: cannot be read as a folder'
}

test_the_repository_of_the_document_runs() {
    local commands
    commands=$(sed -n '/^```sh$/,/^```$/p' "$REPO/docs/REFERENCES.md" | grep -v '^```')
    [ -n "$commands" ] || fail "expected commands in docs/REFERENCES.md"
    mkdir -p build
    ln -s "$CORCAST" build/corcast
    (eval "PATH=$PWD/build:$PATH; set -e; $commands") >said 2>&1 || fail "the document's commands end with $?: $(cat said)"
    expect_file page.html
    grep -q '^agree: 2 cases: 2 same$' said || fail "expected agreement in the end: $(cat said)"
    grep -q 'failures="2"' build/junit.xml || fail "expected two new cases at first"
}

run_tests "$@"
