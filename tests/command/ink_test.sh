#!/bin/bash
# Line drawings of render --ink, held against what poppler and libxml2 make of them, and against pictures.
. "$(dirname "$0")/../lib.sh"

test_a_line_drawing_is_vectors_of_black_alone() {
    run_ok corcast grow --terminals 60 --domain ball:20 --seed 4 -o tree.swc
    run_ok corcast render tree.swc --ink 0.2 --size 60mm --dpi 300 --quiet -o lines.svg
    xmllint --noout lines.svg || fail "expected XML"
    ! grep -q '<image' lines.svg || fail "expected no picture"
    [ "$(grep -o 'stroke="[^"]*"' lines.svg | sort -u)" = 'stroke="#000000"' ] || fail "expected black lines"
    grep -q 'stroke-width="0.2"' lines.svg || fail "expected lines of 0.2 mm"
    run_ok corcast render tree.swc --ink 0.2 --size 60mm --dpi 300 --quiet -o lines.pdf
    run_ok corcast render tree.swc --ink 0.2 --size 60mm --dpi 300 --quiet --threads 1 -o again.pdf
    cmp lines.pdf again.pdf || fail "expected the same bytes"
    [ "$(pdfimages -list lines.pdf | wc -l)" -eq 2 ] || fail "expected no picture in the PDF"
    pdfinfo lines.pdf | grep -q '^Page size: *170\.' || fail "expected a page of 60 mm"
}

# What the drawing encloses is what the picture shows, but for its lines.
test_a_drawing_lies_on_the_picture_of_the_same_view() {
    run_ok corcast grow --terminals 12 --seed 2 -o tree.swc
    local view='--size 60mm --dpi 200 --projection perspective --quiet'
    run_ok corcast render tree.swc --ink 0.3 $view -o lines.pdf
    run_ok corcast render tree.swc --look flat --background 1,1,1 --antialias 1 --exact $view -o flat.ppm
    pdftoppm -r 200 lines.pdf lines
    pamtopnm <flat.ppm | ppmtopgm | pamthreshold -simple -threshold 0.9 | pamtopnm >vessels.pbm
    ppmtopgm lines-1.ppm | pamthreshold -simple -threshold 0.5 | pamtopnm >ink.pbm
    # Dark in both is 0 in the sum; ink beside vessels would be 0 in `ink` alone.
    local beside ink
    beside=$(pnmarith -subtract vessels.pbm ink.pbm | pamsumm -sum -brief)
    ink=$(pnminvert ink.pbm | pamsumm -sum -brief)
    [ "$ink" -gt 2000 ] || fail "expected lines, got $ink dark pixels"
    awk "BEGIN { exit !($beside < 0.02 * $ink) }" || fail "expected ink on vessels alone, got $beside of $ink beside"
}

test_what_has_no_effect_on_lines_is_refused() {
    run_ok corcast grow --terminals 5 -o tree.swc
    run corcast render tree.swc --ink 0.2 -o lines.png
    expect_status 2
    expect_sentence 'ink draws lines for an \.svg or \.pdf'
    run corcast render tree.swc --ink 0.2 --color-by flow -o lines.svg
    expect_status 2
    expect_sentence 'color-by has no effect on a line drawing'
    run corcast render tree.swc --ink 0.2 --model joined -o lines.svg
    expect_status 2
    expect_sentence 'ink is for --model rounded'
    run corcast render tree.swc --ink 0 -o lines.svg
    expect_status 2
    expect_sentence 'ink.*from 0\.01 to 10'
    [ ! -e lines.svg ] || fail "expected nothing written"
}

run_tests "$@"
