#!/usr/bin/env bash
# Studies: plans, runs, reuse of finished runs, tables, and the merging of runs.
. "$(dirname "$0")/../lib.sh"

make_plan() {
    printf '[grow]\nterminals = 40 ; of each\nseed = 1..3, 7\ngamma = 2.385, 3\n' >plan.ini
}

# run_of K: prints the file of run K without its extension.
run_of() {
    local found
    found=$(grep -l "^{\"run\":$1," runs/*.json)
    echo "${found%.json}"
}

test_a_run_is_the_tree_of_grow_and_what_info_says_of_it() {
    make_plan
    run_ok corcast study plan.ini -o runs --trees --quiet
    [ "$(find runs -name '*.swc' | wc -l)" -eq 8 ] || fail "expected 8 trees, got: $(ls runs)"
    run_ok corcast grow --terminals 40 --seed 2 --gamma 2.385 --quiet -o tree.swc
    expect_same tree.swc "$(run_of 3).swc"
    run_ok corcast info tree.swc --json
    jq 'del(.reading)' stdout >info.json
    jq 'with_entries(select(.key | IN($keys[0][])))' --slurpfile keys <(jq keys info.json) "$(run_of 3).json" >of_run.json
    diff <(jq -S . info.json) <(jq -S . of_run.json) >&2 || fail "expected of run 3 what info --json says"
    expect_json "$(run_of 3).json" '.grow == {terminals: 40, seed: 2, gamma: 2.385} and .complete and .broken == 0'
}

test_tables_have_a_row_a_run_in_the_order_of_the_plan() {
    make_plan
    run_ok corcast study plan.ini -o runs --quiet
    [ "$(cut -d, -f1-4 runs/study.csv | tr '\n' ' ')" = "run,grow.terminals,grow.seed,grow.gamma \
1,40,1,2.385 2,40,1,3 3,40,2,2.385 4,40,2,3 5,40,3,2.385 6,40,3,3 7,40,7,2.385 8,40,7,3 " ] ||
        fail "expected the runs of the plan, got: $(cut -d, -f1-4 runs/study.csv)"
    expect_json runs/study.jsonl '.segments == 79'
    [ "$(jq -c '.run' runs/study.jsonl | xargs)" = "1 2 3 4 5 6 7 8" ] || fail "expected 8 lines in order"
    awk -F, 'NF != 27' runs/study.csv >odd
    [ ! -s odd ] || fail "expected 27 columns, got $(head -1 odd)"
}

test_commands_make_the_same_files_and_merge_the_same_tables() {
    make_plan
    run_ok corcast study plan.ini -o runs --trees --quiet
    run_ok corcast study plan.ini -o "other place" --trees --quiet --commands
    sort -r stdout >plan.txt
    [ "$(wc -l <plan.txt)" -eq 8 ] || fail "expected 8 commands, got: $(cat plan.txt)"
    (cd / && sh -e) <plan.txt || fail "the commands failed"
    run_ok corcast merge "other place" -o "other place/study.csv"
    run_ok corcast merge "other place"/*.json -o "other place/study.jsonl"
    diff -r runs "other place" >&2 || fail "expected the same files"
}

test_what_is_there_and_right_is_kept() {
    make_plan
    run_ok corcast study plan.ini -o runs --trees --quiet
    stat -c '%n %i' runs/*.swc >before
    rm "$(run_of 2).json"
    printf x >>"$(run_of 5).swc"
    : >"$(run_of 7).json"
    cp -r runs broken
    run_ok corcast study plan.ini -o runs --trees
    grep -qx 'corcast: 8 runs: 3 grown, 5 found from before' stderr || fail "expected 3 to be grown, got: $(cat stderr)"
    [ "$(stat -c '%n %i' runs/*.swc | comm -13 before - | wc -l)" -eq 3 ] || fail "expected 3 new trees"
    run_ok corcast study plan.ini -o fresh --trees --quiet
    diff -r runs fresh >&2 || fail "expected the files of a study that was not broken"
    run corcast merge broken -o all.csv
    expect_status 2
    expect_sentence 'broken/[0-9a-f]*.json: is not valid JSON'
    [ ! -e all.csv ] || fail "expected no table"
}

# grown_anew CHANGE LINE...: the only run of a study is kept, until the shell command CHANGE has
# changed a file that the plan names.
grown_anew() {
    local change=$1
    shift
    rm -rf anew
    { printf '[grow]\nterminals = 12\n'; printf '%s\n' "$@"; } >anew.ini
    run_ok corcast study anew.ini -o anew
    run_ok corcast study anew.ini -o anew
    grep -qx 'corcast: 1 run: 0 grown, 1 found from before' stderr || fail "expected the run to be kept before: $change"
    eval "$change"
    run_ok corcast study anew.ini -o anew
    grep -qx 'corcast: 1 run: 1 grown, 0 found from before' stderr || fail "expected a new run after: $change"
}

test_a_run_is_grown_anew_when_a_file_has_changed() {
    grow_tree 5
    ppmmake white 40 40 >mask.ppm
    ppmmake white 40 40 >demand.ppm
    grown_anew 'ppmmake white 40 39 >mask.ppm' 'domain = mask:mask.ppm,2'
    grown_anew 'pnmgamma 2 demand.ppm | ppmdim 0.5 >other; mv other demand.ppm' 'domain = disc:15' \
        'demand = demand.ppm,2'
    grown_anew 'sed -i "s/^\(2 .*\) \([^ ]*\) \([^ ]*\)\$/\1 0.5 \3/" tree.swc' 'from = tree.swc'
    grow_tree 5
    grown_anew 'corcast grow --terminals 5 --seed 4 -o tree.swc' 'domain = hull:tree.swc,30'
}

# The plan gets more values, one of them at the front. Finished runs are kept, and only their
# numbers change.
test_a_plan_may_grow() {
    make_plan
    run_ok corcast study plan.ini -o runs --quiet
    mv runs/study.csv small.csv
    sed -i 's/^seed.*/seed = 0..3, 7/' plan.ini
    run_ok corcast study plan.ini -o runs
    grep -qx 'corcast: 10 runs: 2 grown, 8 found from before' stderr || fail "expected 2 to be grown, got: $(cat stderr)"
    diff <(tail -n +2 small.csv | cut -d, -f2-) <(tail -n +4 runs/study.csv | cut -d, -f2-) >&2 ||
        fail "expected the old rows below the new"
}

test_a_tree_that_finds_no_room_is_a_row_that_says_so() {
    printf '[grow]\nterminals = 50\nlambda = 100\ngamma = 3, 0.05\n' >plan.ini
    run_ok corcast study plan.ini -o runs --trees --quiet
    expect_json "$(run_of 1).json" '.terminals == 50 and .error == null'
    expect_json "$(run_of 2).json" '(.error | test("gave up placing terminal 2")) and .terminals == null'
    grep -q '^2,50,100,0.05,.*gave up placing terminal 2' runs/study.csv || fail "expected the reason, got: $(cat runs/study.csv)"
    run_ok corcast study plan.ini -o runs --trees
    grep -qx 'corcast: 2 runs: 0 grown, 2 found from before' stderr || fail "expected both to be kept, got: $(cat stderr)"
}

# refuses PLAN SENTENCE: `study` refuses the plan with the sentence and writes nothing.
refuses() {
    # shellcheck disable=SC2059
    printf "$1" >plan.ini
    run corcast study plan.ini -o runs
    expect_status 2
    expect_sentence "$2"
    expect_only plan.ini
}

test_refuses_what_is_wrong_in_a_plan_with_file_and_line() {
    refuses '[grow]\nseed = 1\n[grow]\n' 'plan.ini:3: the section \[grow\] occurs twice'
    refuses '[grow]\nseed = 1\n\nseed = 2\n' "plan.ini:4: 'seed' occurs twice; write all its values in one line"
    refuses '[grow]\nsed = 1\n' "plan.ini:2: 'sed' is not an option of grow; did you mean seed"
    refuses '[grow]\nthreads = 2\n' "plan.ini:2: a plan cannot set the option 'threads' of grow"
    refuses '[tree]\nseed = 1\n' 'plan.ini:1: \[tree\] is not a section of a plan'
    refuses 'seed = 1\n' "plan.ini:1: 'seed' is above \[grow\]"
    refuses '[grow]\n' 'plan.ini: sets no option of grow'
    refuses '[grow]\nseed = 20..1\n' 'plan.ini:2: seed: the range 20..1 is empty: its first value is above its last'
    refuses '[grow]\nseed = 1..2000000\n' 'plan.ini:2: seed: the range 1..2000000 has more than 1000000 values'
    refuses '[grow]\nseed = 1..2000\nterminals = 1..2000\n' 'plan.ini:3: terminals: the plan has more than 1000000'
    refuses '[grow]\ngamma = 2.5, -3\n' "plan.ini:2: --gamma: '-3' is not a number"
    refuses '[grow]\ngamma = 2.5, , 3\n' 'plan.ini:2: gamma: a value is missing'
    refuses '[grow]\ngamma = 2.5, 3, 2.50\n' 'plan.ini:2: gamma: the value 2.5 occurs twice'
    refuses '[grow]\nseed = 1,2\n' "plan.ini:2: --seed: '1,2' is not"
    run corcast study plan.ini
    expect_status 2
    expect_sentence '-o DIR is missing'
    run corcast study nothing.ini -o runs
    expect_status 2
    expect_sentence 'nothing.ini: '
}

test_a_run_that_fails_is_named_after_all_had_their_turn() {
    printf '[grow]\nterminals = 9\ndomain = disc:50, mask:nothing.png,0.5, ball:9\n' >plan.ini
    run corcast study plan.ini -o runs
    expect_status 2
    expect_sentence 'run 2 of 3: nothing.png: '
    [ "$(find runs -name '*.json' | wc -l)" -eq 2 ] || fail "expected 2 runs, got: $(ls runs)"
    [ ! -e runs/study.csv ] || fail "expected no table"
}

test_merge_names_the_run_that_is_missing_doubled_or_another() {
    make_plan
    run_ok corcast study plan.ini -o runs --quiet
    cp "$(run_of 4).json" other.json
    run corcast merge runs other.json -o all.csv
    expect_status 2
    expect_sentence 'are both run 4 of 8'
    rm "$(run_of 4).json"
    run corcast merge runs -o all.csv
    expect_status 2
    expect_sentence 'run 4 of 8 is missing; found 7 runs'
    sed -i 's/^seed.*/seed = 4..6, 8/' plan.ini
    run_ok corcast study plan.ini -o others --quiet --only 4
    run corcast merge runs others -o all.csv
    expect_status 2
    expect_sentence ' and runs/[0-9a-f]*.json are runs of different studies'
    echo '{"segments": 3}' >plain.json
    run corcast merge plain.json -o all.csv
    expect_status 2
    expect_sentence 'plain.json: contains no run of a study'
    [ ! -e all.csv ] || fail "expected no table"
    run corcast study plan.ini -o others --only 9
    expect_status 2
    expect_sentence '--only: 9 is not the number of a run, 1 to 8'
}

test_tables_of_info_have_a_row_a_file() {
    printf '{"segments": 3, "box": [1, 2], "in": {"a": "x,\\"y", "b": null}}' >"one tree.json"
    printf '{"segments": 4}\n{"ratio": 0.287, "in": {"a": true}}\n' >two.json
    run_ok corcast study --table "one tree.json" two.json
    printf '%s\n' file,segments,in.a,in.b,ratio 'one tree,3,"x,""y",,' two,4,,, two,,true,,0.287 | diff - stdout >&2 ||
        fail "expected another table"
    echo '[1' >broken.json
    run corcast study --table broken.json
    expect_status 2
    expect_sentence 'broken.json: is not valid JSON: line'
}

test_parallel_grows_a_study_on_after_a_worker_was_killed() {
    command -v parallel >/dev/null || skip "GNU parallel is not installed"
    make_plan
    run_ok corcast study plan.ini -o runs --quiet
    run_ok corcast study plan.ini -o other --quiet --commands
    sed '3s/^\(.*\) && \(.*\)$/if [ -e tried ]; then \1 \&\& \2; else touch tried; \1; exec \2 \& kill -9 $!; wait $!; fi/' \
        stdout >plan.txt
    run parallel --will-cite -j2 -a plan.txt --joblog log
    [ "$status" -eq 1 ] || fail "expected one failed job, got $status$(said)"
    run_ok parallel --will-cite -j2 -a plan.txt --joblog log --resume-failed
    [ "$(awk 'NR > 1' log | wc -l)" -eq 9 ] || fail "expected 9 jobs, got: $(cat log)"
    run_ok corcast merge other -o all.csv
    expect_same runs/study.csv all.csv
}

run_tests "$@"
