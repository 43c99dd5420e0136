#!/usr/bin/env bash
# `diagram`: a tree unrolled flat, as SVG and as pixels.
. "$(dirname "$0")/../lib.sh"

# count N PATTERN FILE: exactly N lines of the file match the pattern.
count() {
    local lines
    lines=$(grep -c "$2" "$3")
    [ "$lines" = "$1" ] || fail "$lines lines of $3 say $2, not $1"
}

test_a_diagram_has_a_bar_for_each_segment_with_its_value() {
    grow_tree 40
    run_ok corcast diagram tree.swc --color-by level -o tree.svg
    xmllint --noout tree.svg || fail "xmllint refuses the SVG"
    count 79 '<rect id="s[0-9]*" ' tree.svg
    count 39 '<rect id="l[0-9]*" ' tree.svg
    count 3 '<title>segment [0-9]*, level 1 </title>' tree.svg
    count 1 '<desc>corcast .*: corcast diagram tree.swc --color-by level -o D.svg</desc>' tree.svg
}

test_a_diagram_of_a_measured_network_takes_what_is_said_of_its_file() {
    printf '%s\n' x0,y0,z0,x1,y1,z1,radius 0,0,0,1,0,0,0.2 1,0,0,2,1,0,0.15 2,1,0,3,0,0,0.05 1,0,0,3,0,0,0.1 >net.csv
    run_ok corcast diagram net.csv -o net.svg --quiet
    count 4 '<rect id="s[0-9]*" ' net.svg
    count 1 '<rect id="c[0-9]*" ' net.svg
    run_ok corcast diagram net.csv --break-loops --input-unit cm --color-by radius -o net.svg
    grep -q '1 loop is cut' stderr || fail "expected a sentence about the loop: $(cat stderr)"
    grep -q 'radius 1 to 2 mm, of the 3 segments' stderr || fail "expected radii in cm: $(cat stderr)"
    count 3 '<rect id="s[0-9]*" ' net.svg
}

# Chromium, which shares no code with corcast, draws the SVG.
test_the_pixels_are_those_of_the_svg() {
    command -v chromium >chromium.path || skip "chromium is not installed"
    grow_tree 25
    run_ok corcast diagram tree.swc --color-by radius --margin 0 -o tree.svg
    run_ok corcast diagram tree.swc --color-by radius --margin 0 --size 640x480 -o tree.png
    echo '<body style="margin:0"><img src="tree.svg" style="width:640px;height:480px">' >page.html
    timeout 300 chromium --headless=new --no-sandbox --disable-gpu --hide-scrollbars \
        --window-size=640,480 --screenshot=chromium.png "file://$PWD/page.html" >chromium.log 2>&1
    run corcast compare chromium.png tree.png --json
    expect_json stdout '.rmse < 6 and .mean_abs < 1'
}

test_a_diagram_takes_the_colors_of_a_picture() {
    printf '1 1 0 0 0 2.385 -1\n2 3 30 0 0 2.385 1\n' >tree.swc
    run_ok corcast diagram tree.swc --gap 1 --size 40x40 --background 0.2,0.4,0.6 -o other.ppm
    printf '\063\146\231' >expected
    tail -c 3 other.ppm >corner
    expect_same corner expected
}

test_a_legend_stands_beside_the_diagram() {
    local form
    grow_tree 40
    run_ok corcast diagram tree.swc --color-by strahler -o plain.svg
    run_ok corcast diagram tree.swc --color-by strahler --legend --legend-at bottom -o tree.svg
    xmllint --xpath '//*[local-name()="text"]/text()' tree.svg | tr '\n' ' ' >texts
    grep -q '^1 2 3.* Strahler order $' texts || fail "expected a legend of orders, got $(cat texts)"
    [ "$(grep -c 'rect id' tree.svg)" = "$(grep -c 'rect id' plain.svg)" ] || fail "expected the same bars"
    run_ok corcast diagram tree.swc --color-by wss --legend --log --legend-title stress -o tree.pdf
    pdftotext tree.pdf text.txt
    grep -qx stress text.txt || fail "expected the title in the PDF, got $(cat text.txt)"
    for form in plain legend; do
        # shellcheck disable=SC2046
        run_ok corcast diagram tree.swc --color-by strahler $([ $form = plain ] || echo --legend --legend-at right) \
            --size 600x400 -o $form.ppm
        pnmcut -left 400 -top 0 -width 200 -height 400 $form.ppm | ppmhist -noheader 2>/dev/null | wc -l >$form.colors
    done
    cmp -s plain.ppm legend.ppm && fail "expected a legend in the pixels"
    [ "$(cat legend.colors)" -gt 20 ] || fail "expected letters at the right, got $(cat legend.colors) colors"
    run corcast diagram tree.swc --legend -o no.svg
    expect_status 2
    expect_sentence '--legend needs --color-by'
    run corcast diagram tree.swc --legend --color-by wss -o no.exr
    expect_status 2
    expect_sentence 'an .exr stores measured values and cannot have a legend'
}

test_options_that_do_nothing_are_refused() {
    grow_tree 5
    run corcast diagram tree.swc --size 40x40 -o tree.svg
    expect_status 2
    expect_sentence "--size is for images of pixels"
    run corcast diagram tree.swc --log -o tree.svg
    expect_status 2
    expect_sentence "--log needs --color-by"
    run corcast diagram tree.swc -o tree.xyz
    expect_status 2
    expect_only tree.swc
}

test_a_tree_without_length_has_no_diagram() {
    printf '1 1 0 0 0 2.385 -1\n2 3 0 0 0 2.385 1\n' >tree.swc
    run corcast diagram tree.swc -o tree.svg
    expect_status 2
    expect_sentence "tree.swc: all segments have length 0; a diagram needs at least one with a length"
    expect_only tree.swc
}

run_tests "$@"
