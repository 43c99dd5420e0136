#!/usr/bin/env bash
# `compare --reference`: a folder of pictures against a folder of references, as a test suite.
. "$(dirname "$0")/../lib.sh"

# picture LEVEL: prints a grey PPM of 5 x 4 pixels, in which pixel 7 (counted from 0) has the given
# level.
picture() {
    printf 'P6\n5 4\n255\n'
    printf 'ddd%.0s' 1 2 3 4 5 6 7
    printf "\\$(printf %o "$1")%.0s" 1 2 3
    printf 'ddd%.0s' 1 2 3 4 5 6 7 8 9 10 11 12
}

# Makes six cases: two equal pictures, and one case of each other state except `broken`.
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
    expect_stdout '^changed moved\.ppm: cause unknown, but all differences are in the 1 x 1 pixels at \(2, 1\); 5 % of the pixels are off by more than 1 levels \(allowed: 0.0002 %, no pixel at this size\); the worst, 31 levels'
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
    expect_sentence '--accept and --reason must be used together'
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
    run timeout 300 "$CORCAST" compare --reference stored drawn
    expect_status 1
    expect_stdout '^broken  b\.ppm: stored/b\.mask\.png: .*is a pipe'
    expect_stdout '^broken  p\.png: stored/p\.png: .*is a pipe'
    expect_stdout '^broken  q\.png: stored/q\.png: .*is a pipe'
    run timeout 300 "$CORCAST" compare --reference stored drawn --accept p.png --reason 'x'
    expect_status 2
    expect_sentence 'drawn/p\.png: .*is a pipe'
    mkfifo stored/accepted.tsv
    run timeout 300 "$CORCAST" compare --reference stored drawn --accept a.ppm --reason 'x'
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
    run corcast compare --reference stored drawn --flicker f.png
    expect_status 2
    expect_sentence '--flicker is for two pictures, not for --reference'
    run corcast compare --reference nowhere drawn
    expect_status 3
    expect_sentence 'nowhere.*: cannot be read as a folder'
}

# Makes one case with three accepted references, as from three machines.
several() {
    mkdir -p stored drawn
    picture 100 >stored/a.ppm
    picture 160 | tee drawn/a.ppm >stored/a.ref-gpu.ppm
    picture 220 >stored/a.ref-old.ppm
    for label in gpu old; do
        printf '[a.ref-%s.ppm]\nreason = other rounding\nmachine = %s\nexpires = 2999-12-31\n' $label $label
    done >stored/a.references.ini
}

test_any_accepted_reference_will_do_and_an_unused_one_is_told() {
    several
    run_ok corcast compare --reference stored drawn
    expect_stdout '^unused  a\.ref-old\.ppm: the picture agrees without it$'
    expect_stdout '^agree: 1 case: 1 same; 1 unused file$'
    run_ok corcast compare --reference stored drawn --json
    expect_json stdout '.cases[0].reference == "a.ref-gpu.ppm" and .unused == ["a.ref-old.ppm"]'
    picture 190 >drawn/a.ppm
    run corcast compare --reference stored drawn
    expect_status 1
    expect_stdout '^changed a\.ppm: .*; no further reference agrees either \(2 tried\)$'
}

test_an_expired_reference_fails_even_where_the_picture_agrees() {
    several
    cp stored/a.ppm drawn/a.ppm
    sed -i '0,/2999-12-31/s//2020-02-29/' stored/a.references.ini
    run corcast compare --reference stored drawn
    expect_status 1
    expect_stdout '^expired a\.ppm: the reference a\.ref-gpu\.ppm expired on 2020-02-29 \(machine: gpu; reason: other rounding\)'
    run_ok corcast compare --reference stored drawn --accept all --reason 'no GPU any more'
    expect_stdout '^accepted a\.ppm \(expired\)$'
    run_ok corcast compare --reference stored drawn
    [ ! -e stored/a.ref-gpu.ppm ] && [ "$(grep -c '^\[' stored/a.references.ini)" = 1 ] || fail 'expected one reference to be removed'
}

test_a_bad_list_of_references_breaks_its_case() {
    local line
    several
    cp drawn/a.ppm stored/a.ppm
    rm stored/a.ref-old.ppm
    run corcast compare --reference stored drawn
    expect_stdout '^broken  a\.ppm: stored/a\.ref-old\.ppm: cannot be read'
    several
    for line in 'expires = 2027-02-29' 'expires = soon' 'until = 2027-01-01' '[b.ref-x.ppm]' '[a.ref-gpu.ppm]' '[a.ref-new.ppm]'; do
        several_list=$(cat stored/a.references.ini)
        echo "$line" >>stored/a.references.ini
        run corcast compare --reference stored drawn
        expect_status 1
        expect_stdout '^broken  a\.ppm: stored/a\.references\.ini:'
        echo "$several_list" >stored/a.references.ini
    done
}

test_a_picture_is_accepted_beside_its_reference() {
    folders
    run_ok corcast compare --reference stored drawn --accept moved.ppm --as gpu --machine 'ci 7' --expires never --reason 'a; b'
    expect_same stored/moved.ref-gpu.ppm drawn/moved.ppm
    expect_same stored/moved.ppm stored/a.ppm
    [ "$(tail -n 3 stored/moved.references.ini)" = "$(printf 'reason = a, b\nmachine = ci 7\nexpires = never')" ] ||
        fail "expected an entry: $(cat stored/moved.references.ini)"
    run_ok corcast compare --reference stored drawn --only 'moved*'
    run corcast compare --reference stored drawn --accept fresh.ppm --as gpu --machine x --expires never --reason x
    expect_status 2
    expect_sentence 'fresh\.ppm has no reference yet; --as adds a picture to a reference'
    run corcast compare --reference stored drawn --accept moved.ppm --as ../x --machine x --expires never --reason x
    expect_sentence "--as is '\.\./x'; it must be 1 to 64 letters"
    run corcast compare --reference stored drawn --accept moved.ppm --as y --machine x --expires 2020-02-29 --reason x
    expect_sentence "--expires is '2020-02-29'; this day is over"
    run corcast compare --reference stored drawn --accept moved.ppm --as y --reason x
    expect_sentence '--as needs --machine and --expires'
}

test_patterns_accept_only_what_fails() {
    folders
    run corcast compare --reference stored drawn --accept 'moved.ppm,x*' --reason 'x'
    expect_status 2
    expect_sentence "no picture 'x\*' in drawn or stored"
    [ ! -e stored/accepted.tsv ] || fail 'expected nothing to be accepted'
    run corcast compare --reference stored drawn --only 'moved.ppm,x*'
    expect_sentence "no picture 'x\*' in drawn or stored"
    run_ok corcast compare --reference stored drawn --levels 1 --accept 'm*,views/*,gone.ppm' --reason 'x'
    [ "$(cat stdout)" = "$(printf 'accepted gone.ppm (missing)\naccepted moved.ppm (changed)')" ] || fail "got $(cat stdout)"
    run_ok corcast compare --reference stored drawn --levels 1 --accept all --reason 'x'
    [ "$(cat stdout)" = 'accepted fresh.ppm (new)' ] || fail "got $(cat stdout)"
    run_ok corcast compare --reference stored drawn --levels 1
    expect_stdout '1 within'
    run_ok corcast compare --reference stored drawn --levels 1 --accept all --reason 'x'
    expect_stdout '^nothing to accept: all selected cases agree$'
}

test_a_case_has_its_own_tolerance() {
    folders
    printf 'color_levels = 40\ncolor_ppm = 0\n' >stored/moved.tolerance.ini
    cp stored/moved.tolerance.ini stored/nothing.tolerance.ini
    run corcast compare --reference stored drawn
    expect_stdout '^within  moved\.ppm: '
    expect_stdout '^changed near\.ppm: '
    expect_stdout '^unused  nothing\.tolerance\.ini: no picture has this name$'
    echo 'color_levels = 40' >stored/moved.tolerance.ini
    run corcast compare --reference stored drawn --only moved.ppm
    expect_status 1
    expect_stdout '^changed moved\.ppm: .*; the tolerance file sets no limit that applies to these two images$'
    run_ok corcast compare stored/a.ppm drawn/a.ppm --tolerance stored/moved.tolerance.ini
    echo 'color_levels = many' >stored/moved.tolerance.ini
    run corcast compare --reference stored drawn --only moved.ppm
    expect_status 1
    expect_stdout '^broken  moved\.ppm: stored/moved\.tolerance\.ini:1: color_levels is'
}

test_one_page_shows_all_cases_that_fail_and_how_to_accept_them() {
    folders
    cp stored/a.ppm stored/size.ppm
    pnmcut -width 4 stored/a.ppm >drawn/size.ppm
    run corcast compare --reference stored drawn --levels 1 --html page.html --report out
    expect_status 1
    expect_same page.html out/report.html
    grep -q 'tests="7" failures="4"' out/junit.xml || fail 'expected JUnit XML'
    expect_json out/report.json '.changed == 2'
    [ "$(grep -c '<section class="case" id="case-[123]"' page.html)" = 3 ] || fail 'expected three cases with pictures'
    for case in moved fresh gone size; do
        grep -q "corcast compare --reference stored drawn --accept $case.ppm --reason" page.html || fail "expected how to accept $case"
    done
    grep -q '<h1>4 of 7 cases ' page.html || fail "expected the totals: $(grep '<h1>' page.html)"
    ! grep -q 'near.ppm' page.html || fail 'expected no case that agrees'
}

# answers LINE...: prints id and exit status of the answers of `compare --serve` to the lines.
answers() {
    printf '%s\n' "$@" | corcast compare --serve >stdout || fail "expected --serve to go on: $?"
    jq -c '[.id, .exit_status, has("result")]' stdout | tr '\n' ' '
}

test_a_line_of_json_has_an_answer_and_a_bad_one_an_error() {
    local said
    folders
    said=$(answers '{"id": 1, "operands": ["stored/a.ppm", "drawn/moved.ppm"]}' '{' '[1]' 'null' '' \
        '{"id": 2, "operands": ["stored/a.ppm", "drawn/moved.ppm"], "options": {"levels": 31}}' \
        '{"id": 3, "operands": ["-", "stored/a.ppm"]}' '{"id": 4, "operands": "a"}' \
        '{"id": 5, "operands": ["stored/a.ppm", "nothing.ppm"]}' \
        '{"id": 6, "operands": ["drawn"], "options": {"serve": true}}' \
        '{"id": 7, "operands": ["drawn"], "options": {"tear": "B"}}' \
        '{"id": 7, "operands": ["stored/a.ppm", "drawn/a.ppm"], "option": {"tier": "B"}}' \
        '{"id": {"x": [8]}, "operands": ["drawn"], "options": {"reference": "stored", "accept": "moved.ppm", "reason": "x"}}' \
        '{"id": 9, "operands": ["drawn"], "options": {"reference": "stored", "only": "moved.ppm"}}')
    [ "$said" = '[1,1,true] [null,2,false] [null,2,false] [null,2,false] [2,0,true] [3,2,false] [4,2,false] [5,2,false] [6,2,false] [7,2,false] [7,2,false] [{"x":[8]},0,true] [9,0,true] ' ] ||
        fail "got $said"
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
    [ "$(grep -c 'data-role="heat"' build/page.html)" -ge 2 ] || fail 'expected a page with both new pictures'
    sed -n '/^```ini$/,/^```$/{/^```/!p}' "$REPO/docs/REFERENCES.md" | cmp - tests/references/front.references.ini ||
        fail "expected the list of the document: $(cat tests/references/front.references.ini)"
    [ "$(jq -c '[.id, .exit_status, (.result.verdict // .error[0:8])]' build/answers.txt | tr '\n' ' ')" = \
        '[1,0,"agree"] [2,0,"agree"] [null,2,"the line"] ' ] || fail "expected three answers: $(cat build/answers.txt)"
    grep -q 'failures="2"' build/junit.xml || fail "expected two new cases at first"
}

run_tests "$@"
