#!/usr/bin/env bash
# Runs every command in a code block of the documents unchanged, except for the size of pictures. A
# command that cannot run here ends in a comment that begins with "needs".
. "$(dirname "$0")/../lib.sh"

# commands DOCUMENT: prints the code lines that run programs, in order, as `run COMMAND`. An INI
# block is printed as `file NAME`, followed by its lines as `line TEXT`.
commands() {
    awk '/^$/ { next }
         !/^    / { inside = 0; next }
         { text = substr($0, 5) }
         text ~ /^; / { inside = 1; print "file " substr(text, 3); next }
         text ~ /^(build\/corcast|povray|make|awk|ffmpeg|python3|tetgen|printf) / { inside = 0; print "run " text; next }
         inside { print "line " text }' "$REPO/$1"
}

# small COMMAND: prints the command with pictures of at most 64 x 48 pixels, unless a preset sets
# their size.
small() {
    local small
    small=$(echo "$1" | sed -E 's/ #.*//; s/--size [0-9]+x[0-9]+/--size 64x48/; s/\+W[0-9]+ \+H[0-9]+/+W64 +H48/')
    case $small in
    *' --size '* | *' --preset '* | *--recipe*) ;;
    *'corcast render '* | *'corcast povray '* | *'corcast verify '*) small="$small --size 64x48" ;;
    esac
    echo "$small"
}

# make_target COMMAND: the Makefile has the targets of the command. The targets are not run here.
make_target() {
    local word
    for word in $(echo "$1" | sed 's/#.*//; s/&&.*//; s/^make//'); do
        case $word in
        *=*) ;;
        *) grep -qE "^([a-z -]* )?$word( [a-z -]*)?:" "$REPO/Makefile" || fail "expected the Makefile to have the target $word" ;;
        esac
    done
}

run_commands() {
    local kind text file=
    while read -r kind text; do
        case $kind$text in
        file*) file=$text && : >"$file" ;;
        line*) echo "$text" | sed -E 's/^size = [0-9]+x[0-9]+$/size = 64x48/' >>"$file" ;;
        run*'# needs '*) ;;
        runmake*) make_target "$text" ;;
        run*) run_ok bash -c "$(small "$text" | sed "s|build/corcast|'$CORCAST'|g; s|^python3|/usr/bin/python3|")" ;;
        esac
    done < <(commands "$1")
}

test_the_commands_of_the_readme_run() {
    run_commands README.md
    expect_file tree.png
    expect_file report/report.html
}

test_the_commands_for_teachers_run() {
    [ -e "$REPO/build/viewer/viewer.js" ] || skip "the viewer is not built, for want of npm, esbuild or three.js"
    ln -s "$REPO/tests" .
    run_commands docs/TEACHERS.md
    expect_file area.html
    expect_file coronary.html
}

test_the_commands_for_artists_run() {
    ln -s "$REPO/tests" "$REPO/docs" .
    run_commands docs/ARTIST.md
    expect_file studio.png
    expect_file turn3.png
    ! cmp -s <(pngtopnm turn1.png) <(pngtopnm turn2.png) || fail "expected the tree to turn"
    ! cmp -s <(pngtopnm growth2.png) <(pngtopnm growth3.png) || fail "expected the tree to grow"
}

test_the_commands_of_the_walkthrough_run() {
    run_commands docs/WALKTHROUGH.md
    expect_file blue.png
    expect_file forest.swc
}

test_the_commands_of_every_other_document_run() {
    local document
    ln -s "$REPO/tests" "$REPO/docs" .
    for document in $(cd "$REPO" && echo docs/*.md docs/decisions/*.md); do
        case $document in
        docs/WALKTHROUGH.md | docs/ARTIST.md | docs/TEACHERS.md) ;;
        *) run_commands "$document" ;;
        esac
    done
}

run_tests "$@"
