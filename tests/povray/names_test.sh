#!/usr/bin/env bash
# File and folder names that POV-Ray does not accept on its command line, with the real POV-Ray.
. "$(dirname "$0")/../lib.sh"

ODD=$'José\'s "日本"; a&b\n$(x)-\xff'

test_a_folder_of_any_name_is_verified() {
    mkdir -- "$ODD"
    cp "$DATA/bifurcation.swc" "$ODD/t.swc"
    run_ok corcast verify "$ODD/t.swc" --size 40x30 -o "$ODD/out"
    expect_json "$ODD/out/report.json" '.verdict == "agree" and .povray.version != "unknown"'
    cd "$ODD" || fail "expected the folder"
    run_ok corcast verify t.swc --size 40x30 --model isosurface -o v
    expect_json v/report.json '.verdict == "agree"'
    [ -z "$(find . -name '.*' ! -name .)" ] || fail "expected nothing hidden to be left"
}

# The name of the tree is a program in POV-Ray's language. An earlier version wrote it into the
# description of the scene.
test_the_name_of_a_tree_is_no_program() {
    local name=$'x\n#fopen F "pwned.txt" write #write (F,"hi") #fclose F #if (0) .swc'
    cp "$DATA/bifurcation.swc" "$name"
    run_ok corcast verify "$name" --size 40x30 -o out
    [ -z "$(find . -name 'pwned*')" ] || fail "expected no file of the name's making"
    expect_json out/report.json '.name == "x #fopen F \"pwned.txt\" write #write (F,\"hi\") #fclose F #if (0) .swc"'
}

test_a_tree_of_any_name_is_reported() {
    cp "$DATA/bifurcation.swc" "$ODD<i>.swc"
    run_ok corcast verify "$ODD<i>.swc" --size 40x30 -o out
    expect_json out/report.json '.verdict == "agree" and (.name | endswith("<i>.swc"))'
    iconv -f UTF-8 -t UTF-8 out/report.html >/dev/null || fail "expected a page of UTF-8"
    ! grep -q '<i>' out/report.html || fail "expected the name to be text in the page"
    python3 -c 'import xml.dom.minidom; xml.dom.minidom.parse("out/junit.xml")' || fail "expected XML"
    run_ok corcast report out -o "$ODD.html"
    expect_file "$ODD.html"
}

test_a_scene_of_any_name_is_drawn_and_finds_what_it_includes() {
    mkdir -p "$ODD/below"
    run_ok corcast scene "$DATA/bifurcation.swc" --size 40x30 -o "$ODD/plain.pov"
    printf '#include "plain.pov"\n#include "below/ball.inc"\n' >"$ODD/$ODD.pov"
    echo 'sphere { 0, 5 pigment { rgb 1 } }' >"$ODD/below/ball.inc"
    run_ok corcast povray "$ODD/plain.pov" -o plain.png
    run_ok corcast povray "$ODD/$ODD.pov" --size 40x30 -o "$ODD.png"
    expect_differing 44 44 plain.png "$ODD.png"
    cp "$ODD/plain.inc" "$ODD/plain.pov" .
    mv plain.pov -- -plain.pov
    run_ok corcast povray --size 40x30 -o -again.png -- -plain.pov
    cmp -s <(pngtopnm plain.png) <(pngtopnm ./-again.png) || fail "expected the same pixels"
}

test_a_name_as_long_as_the_system_allows_is_drawn() {
    local stem
    stem=$(printf 'n%.0s' $(seq 251))
    run_ok corcast scene "$DATA/bifurcation.swc" --size 40x30 -o "$stem.pov"
    run_ok corcast povray "$stem.pov" -o "$stem.png"
    expect_file "$stem.png"
}

test_an_error_is_told_by_the_name_of_the_scene() {
    echo 'sphere { 0, 1 pigmnt {} }' >'é b.pov'
    run corcast povray 'é b.pov' --size 5x5 -o x.png
    expect_status 3
    expect_sentence "POV-Ray failed on é b.pov \(exit status 1\): File 'é b.pov' line 1: Parse Error"
}

test_a_picture_goes_to_another_file_system_and_through_links() {
    local other
    other=$(mktemp -d -p /dev/shm 2>/dev/null) || skip "there is no /dev/shm"
    [ "$(stat -c %d "$other")" != "$(stat -c %d .)" ] || {
        rm -r "$other"
        skip "/dev/shm is this file system"
    }
    run_ok corcast scene "$DATA/bifurcation.swc" --size 40x30 -o t.pov
    ln -s "$other/there.png" link.png
    corcast povray t.pov -o link.png 2>stderr
    status=$?
    ls -A "$other" >found
    rm -r "$other"
    expect_status 0
    [ "$(cat found)" = there.png ] || fail "expected there.png alone, found $(cat found)"
    [ -L link.png ] || fail "expected the link to stay"
}

run_tests "$@"
