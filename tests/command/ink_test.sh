#!/bin/bash
# Line drawings of `render --ink`, checked with poppler and libxml2 and compared with pictures.
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

# drawing_lies_on_picture MODEL: ink is only where a flat picture of the same view shows vessels,
# and covers their whole outline.
drawing_lies_on_picture() {
    local view='--size 60mm --dpi 200 --projection perspective --turn 20,10 --quiet' beside ink edges bare
    run_ok corcast render tree.swc --model "$1" --ink 0.3 $view -o lines.pdf
    run_ok corcast render tree.swc --model "$1" --look flat --background 1,1,1 --antialias 1 --exact $view -o flat.ppm
    pdftoppm -r 200 lines.pdf lines
    ppmtopgm flat.ppm | pamthreshold -simple -threshold 0.9 | pamtopnm >vessels.pbm
    ppmtopgm lines-1.ppm | pamthreshold -simple -threshold 0.5 | pamtopnm >ink.pbm
    # A pixel that is dark in both pictures is 0 in the difference. Ink outside of vessels is dark
    # only in `ink`.
    beside=$(pnmarith -subtract vessels.pbm ink.pbm | pamsumm -sum -brief)
    ink=$(pnminvert ink.pbm | pamsumm -sum -brief)
    [ "$ink" -gt 2000 ] || fail "expected lines, got $ink dark pixels"
    awk "BEGIN { exit !($beside < 0.02 * $ink) }" || fail "expected ink on vessels alone, got $beside of $ink beside"
    pbmtopgm 7 7 ink.pbm | pamthreshold -simple -threshold 0.9999 | pamtopnm >near.pbm
    pamdepth 255 vessels.pbm 2>error | pamtopnm | pgmtopgm | pamedge | pamthreshold -simple -threshold 0.1 | pamtopnm >edges.pbm
    edges=$(pamsumm -sum -brief edges.pbm)
    bare=$(pnmarith -multiply edges.pbm near.pbm | pamsumm -sum -brief)
    [ "$edges" -gt 1000 ] || fail "expected an outline, got $edges pixels"
    awk "BEGIN { exit !($bare < 0.02 * $edges) }" || fail "expected ink along the outline of $1, not on $bare of $edges pixels"
}

test_a_drawing_lies_on_the_picture_of_the_same_view() {
    local model
    run_ok corcast grow --terminals 12 --seed 2 -o tree.swc
    for model in cylinders joined rounded; do
        drawing_lies_on_picture $model
    done
}

# Lines of vessels behind a thick vessel end where its wall hides them, exact to 1/100 of the line
# width [METHODS 3.4]. Each vessel begins at another position, so that the steps along its lines
# differ.
test_lines_end_where_a_vessel_in_front_begins() {
    { printf '1 1 0 -14 5 3 -1\n2 3 0 14 5 3 1\n'
      for k in 1 2 3 4 5 6 7; do
          echo "$((10 * k)) 1 $(awk "BEGIN { print -10 - 0.37 * $k, 3 * $k - 12, -5 }") 0.8 -1"
          echo "$((10 * k + 1)) 3 $(awk "BEGIN { print 10 + 0.53 * $k, 3 * $k - 12, -5 }") 0.8 $((10 * k))"
      done; } >tree.swc
    run_ok corcast render tree.swc --input-unit mm --model cylinders --ink 0.5 --size 60mm --location 0,0,50 --look-at 0,0,0 \
        --up 0,1,0 --height 30 --quiet -o lines.svg
    /usr/bin/python3 - >said 2>&1 <<'END' || fail "$(tail -1 said)"
import re
text = open("lines.svg").read()
side = float(re.search(r'width="([0-9.]+)mm"', text)[1])
walls = [side / 2 - 3 * side / 30, side / 2 + 3 * side / 30]
ends = []
for path in re.findall(r'<path d="([^"]*)"', text):
    for part in path.split("M")[1:]:
        points = [tuple(map(float, p.split(","))) for p in re.findall(r"[-0-9.]+,[-0-9.]+", part)]
        ends += [p[0] for p in (points[0], points[-1]) if points[0] != points[-1]]
near = [min(abs(x - wall) for wall in walls) for x in ends]
assert len(ends) == 28, f"expected 28 ends, found {len(ends)}"
assert max(near) <= 0.01 * 0.5 + 0.002, f"a line ends {max(near)} mm from the wall that hides it"
END
}

# A panel of lines, with an inset of lines, beside a panel with a picture. The page has one picture,
# and lines in the panel and in the inset.
test_a_figure_has_panels_in_lines() {
    printf '%s\n' '[figure]' 'size = 90mmx45mm' 'columns = 2' '[panels]' 'grow = --terminals 20 --domain ball:20 --seed 4' \
        '[panel a]' 'ink = 0.15' 'model = cylinders' '[panel b]' 'model = rounded' \
        '[inset c]' 'of = a' 'at = 0.5,0.4' 'place = 0.2,0.2' 'magnify = 3' 'width = 15' >lines.ini
    run_ok corcast figure lines.ini -o lines.svg --dpi 100 --quiet
    [ "$(grep -c '<image' lines.svg)" -eq 1 ] || fail "expected the picture of b alone"
    [ "$(grep -c 'stroke-width="0.15"' lines.svg)" -ge 2 ] || fail "expected the lines of the panel and its inset"
    run_ok corcast figure lines.ini -o lines.pdf --dpi 100 --quiet
    [ "$(pdfimages -list lines.pdf | wc -l)" -eq 3 ] || fail "expected one picture in the PDF"
    run_ok corcast figure lines.ini -o lines.png --dpi 100 --quiet
    sed -i 's/^ink.*/&\ncolor-by = flow\nlegend = on/' lines.ini
    run corcast figure lines.ini -o no.svg --quiet
    expect_status 2
    expect_sentence '\[panel a\]: --?legend has no effect on a line drawing'
}

test_what_has_no_effect_on_lines_is_refused() {
    run_ok corcast grow --terminals 5 -o tree.swc
    run corcast render tree.swc --ink 0.2 -o lines.png
    expect_status 2
    expect_sentence 'ink writes \.svg, \.pdf or \.eps only'
    run corcast render tree.swc --ink 0.2 --color-by flow -o lines.svg
    expect_status 2
    expect_sentence 'color-by has no effect on a line drawing'
    run corcast render tree.swc --ink 0.2 --model isosurface -o lines.svg
    expect_status 2
    expect_sentence '--ink needs --model cylinders, joined and rounded, not isosurface'
    run corcast render tree.swc --ink 0 -o lines.svg
    expect_status 2
    expect_sentence 'ink.*from 0\.01 to 10'
    [ ! -e lines.svg ] || fail "expected nothing written"
}

run_tests "$@"
