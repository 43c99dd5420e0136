#!/usr/bin/env bash
# Provenance: the command line stored in a tree, a scene or a picture makes the same file again.
. "$(dirname "$0")/../lib.sh"

# command_of FILE: prints the last command line in a file.
command_of() {
    grep -aoE 'corcast [a-z]+ .* -o [[:print:]]+\.(swc|pov|png)' "$1" | tail -1
}

# again FILE COMMAND_LINE: the command line makes the same bytes if it is pasted into a shell in
# another folder that contains the inputs.
again() {
    local file=$1 line=$2
    rm -rf pasted
    mkdir pasted
    find . -maxdepth 1 -type f ! -name "$file" -exec cp {} pasted \;
    (cd pasted && rm -f "T.swc" && eval "$line --quiet") || fail "expected to run when pasted: $line"
    made=pasted/$(eval "set -- $line"; while [ "$1" != -o ]; do shift; done; echo "$2")
    cmp -s "$file" "$made" || fail "expected the same bytes from: $line ($(cmp "$file" "$made" 2>&1))"
}

# grows OPTION...: grows a tree with the options; the command line in its header makes the same
# tree.
grows() {
    run_ok corcast grow --quiet --threads 2 "$@" -o it.swc
    again it.swc "$(command_of it.swc)"
}

test_the_header_of_a_tree_makes_it_again() {
    grows --terminals 23 --seed 9999999999999999999
    grows --terminals 30 --domain ball:21.5 --gamma 2.71 --lambda 1.3 --p-perf 93.5 --p-term 61.25 --q-perf 312 --viscosity 3.1
    grows --terminals 30 --inlet 0.5,47 --inlet=-3,-41.5 --inlet-shares 1,0.43
    grows --terminals 25 --viscosity-law pries --hematocrit 0.42 --plasma-viscosity 1.15 --terminal-flow territory
    grows --terminals 25 --candidates 20 --toss terminal --refine geometry --refine-moves 700
}

test_names_with_blanks_and_quotes_stand_in_quotes() {
    mkdir folder
    run_ok corcast grow --quiet --terminals 12 -o "folder/o'neil \"b\"  \$(x) .swc"
    cp folder/*.swc .
    run_ok corcast grow --quiet --terminals 19 --seed 4 --from "folder/o'neil \"b\"  \$(x) .swc" -o it.swc
    again it.swc "$(command_of it.swc)"
    ! grep -q folder it.swc || fail "expected no folder of the user's in the tree"
    cp ./*neil*.swc ./-dash.swc
    run_ok corcast refine --quiet --refine-moves 50 -o it.swc -- -dash.swc
    again it.swc "$(command_of it.swc)"
}

test_what_a_recipe_said_is_said() {
    printf '[grow]\nterminals = 21\ninlet = 1,44\ninlet = 2,-43\nlambda = 1.7\n' >mine.ini
    run_ok corcast grow --quiet --recipe mine.ini --lambda 1.6 -o it.swc
    [ "$(command_of it.swc)" = 'corcast grow --terminals 21 --inlet 1,44,0 --inlet 2,-43,0 --lambda 1.6 -o T.swc' ] ||
        fail "expected the recipe's options, got $(command_of it.swc)"
    rm mine.ini
    again it.swc "$(command_of it.swc)"
}

test_a_tree_says_all_commands_that_made_it() {
    run_ok corcast grow --quiet --terminals 20 --seed 5 -o tree.swc
    run_ok corcast refine --quiet tree.swc --refine geometry -o better.swc
    run_ok corcast grow --quiet --from better.swc --terminals 33 -o larger.swc
    grep '^# command' larger.swc | sed 's/^# command: corcast //' >said
    printf '%s\n' 'grow --terminals 20 --seed 5 -o T.swc' 'refine tree.swc --refine geometry -o R.swc' \
        'grow --terminals 33 --from better.swc -o T.swc' >expected
    expect_same said expected
    grep -q '^# refined: geometry, [0-9]* of [0-9]* moves kept$' larger.swc || fail "expected how the tree was refined"
}

test_runs_that_differ_have_headers_that_differ() {
    local option
    # $line is not quoted, because it contains several options.
    # shellcheck disable=SC2086
    while read -r option; do
        run_ok corcast grow --quiet --terminals 9 $option -o it.swc
        grep '^#' it.swc | md5sum
    done >headers <<'END'

--seed 2
--candidates 20
--toss terminal
--inlet 0,49
--inlet 0,49 --inlet 0,-49 --inlet-shares 2,1
--refine geometry
--refine topology
--refine topology --refine-moves 40
--partial
--terminal-flow territory
--lambda 1
END
    [ "$(sort headers | uniq -d | wc -l)" -eq 0 ] || fail "expected a header of its own for each run"
}

test_neither_threads_nor_names_nor_reports_are_said() {
    run_ok corcast grow --terminals 14 -o a.swc
    run_ok corcast grow --terminals 14 --threads 2 --quiet --json b.json -o b.swc
    run_ok corcast grow --terminals 14 -o -
    expect_same a.swc b.swc
    expect_same a.swc stdout
}

test_the_comment_of_a_scene_makes_it_again() {
    local model
    run_ok corcast grow --quiet --terminals 9 -o 'a "tree".swc'
    for model in $(corcast models | cut -f 1); do
        run_ok corcast scene 'a "tree".swc' --quiet --model "$model" --color-by flow --range 0.5,30.25 --log \
            --location 12.5,3,88 --look-at 1,2,3 --up=0,1,0.125 --shadows --background 0.1,0.2,0.3 -o scene.pov
        cp scene.inc kept
        again scene.pov "$(command_of scene.pov)"
        expect_same kept pasted/scene.inc
    done
}

test_a_scene_says_how_it_is_drawn_in_words_of_a_shell() {
    run_ok corcast grow --quiet --terminals 3 -o tree.swc
    run_ok corcast scene tree.swc --quiet --size 40x30 -o "a b's.pov"
    grep -qxF "// Render: povray +I'\"a b'\\''s.pov\"' +O'\"a b'\\''s.png\"' +W40 +H30 -D" "a b's.pov" ||
        fail "expected quotes for the shell about those for POV-Ray, got $(grep -a Render: "a b's.pov")"
    run_ok corcast scene tree.swc --quiet -o "a b's.scad"
    grep -qF "openscad -o 'a b'\\''s.stl' 'a b'\\''s.scad'" "a b's.scad" || fail "expected names in quotes"
}

test_the_text_of_a_picture_makes_it_again() {
    run_ok corcast grow --quiet --terminals 9 -o tree.swc
    sed 's/^0 /0.04 /' "$REPO/templates/colormaps/magma.txt" >mine.txt
    printf '[render]\nmargin = 0.125\nview = iso\n' >mine.ini
    run_ok corcast render --exact tree.swc --quiet --recipe mine.ini --size 60x44 --antialias 2 --color-by wss --colormap ./mine.txt \
        --prune-radius 0.01 --memory 0.001 -o picture.png
    again picture.png "$(command_of picture.png)"
    ! grep -aq 'memory\|recipe' picture.png || fail "expected only what the picture depends on"
}

test_a_page_of_two_pictures_tells_the_command_that_makes_it() {
    run_ok corcast grow --quiet --terminals 9 -o tree.swc
    run_ok corcast render --exact tree.swc --quiet --size 60x44 -o a.png
    run_ok corcast render --exact tree.swc --quiet --size 60x44 --antialias 3 -o b.png
    run corcast compare a.png b.png --quiet --levels 3.5 --metrics off --html page.html
    expect_status 1
    mkdir pasted
    cp ./*.png pasted
    (cd pasted && eval "$(grep -o 'corcast compare [^<]*' ../page.html | head -1)" >said)
    cmp -s page.html pasted/page.html || fail "expected the same page from: $(grep -o 'corcast compare [^<]*' page.html | head -1)"
}

run_tests "$@"
