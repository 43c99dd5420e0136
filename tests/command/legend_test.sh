#!/usr/bin/env bash
# Color bars, scale bars and letters on pictures, and PDF and SVG pages with a picture. Checked with
# poppler, xmllint and librsvg.
. "$(dirname "$0")/../lib.sh"

grow() {
    run_ok corcast grow --terminals 60 --seed 7 --quiet -o tree.swc
}

# All options that draw something around or over a picture.
readonly ALL="--quiet --size 61mmx47mm --color-by wss --range 5%,90% --legend --scale-bar 23 --letter c"

test_a_page_has_searchable_text_embedded_fonts_and_the_picture_at_its_resolution() {
    grow
    # shellcheck disable=SC2086
    run_ok corcast render tree.swc $ALL --dpi 450 -o page.pdf
    pdftotext -layout page.pdf text.txt
    for words in '^ *c$' 'wall shear stress' '(Pa)' '23 mm'; do
        grep -q "$words" text.txt || fail "expected $words in the page's text, got $(cat text.txt)"
    done
    [ "$(pdffonts page.pdf | awk 'NR > 2 && /LiberationSans/ && $(NF - 4) == "yes"' | wc -l)" = 2 ] ||
        fail "expected two fonts, embedded, got $(pdffonts page.pdf)"
    pdfimages -list page.pdf | awk 'NR == 3' >image.txt
    read -r _ _ _ width height _ _ _ _ _ _ _ x y _ <image.txt
    [ "$width $height $x $y" = "1081 833 450 450" ] || fail "expected 1081 x 833 at 450 ppi, got $(cat image.txt)"
    pdfinfo page.pdf >info.txt
    grep -q '^CreationDate: .*2000' info.txt || fail "expected a date that is always the same, got $(cat info.txt)"
    grep -q 'Subject: .*corcast render tree.swc' info.txt || fail "expected the command, got $(cat info.txt)"
}

test_a_title_has_italics_and_a_subscript() {
    grow
    run_ok corcast render tree.swc --size 61mmx47mm --color-by wss --legend --legend-title '*τ*_{w} (Pa)' --quiet -o w.pdf
    pdftotext w.pdf w.txt
    grep -qF 'τw (Pa)' w.txt || fail "expected the title, got $(cat w.txt)"
    pdffonts w.pdf >fonts.txt
    grep -q '+LiberationSans-Italic ' fonts.txt || fail "expected italics, got $(cat fonts.txt)"
}

test_an_svg_is_sound_and_its_text_is_text() {
    grow
    # shellcheck disable=SC2086
    run_ok corcast render tree.swc $ALL --legend-title 'shear < "8" & ü' -o page.svg
    run_ok xmllint --noout page.svg
    xmllint --encode UTF-8 --xpath '//*[local-name()="text"]/text()' page.svg >texts
    grep -q '23 mm' texts || fail "expected 23 mm among the texts, got $(cat texts)"
    grep -q '^shear &lt; "8" &amp; ü$' texts || fail "expected the title, got $(cat texts)"
}

test_the_picture_in_a_page_has_the_pixels_of_the_picture_alone() {
    grow
    run_ok corcast render tree.swc --quiet --size 200x150 -o alone.png
    run_ok corcast render tree.swc --quiet --size 200x150 --scale-bar 12.5 -o page.pdf
    pdfimages -png page.pdf inside
    cmp <(pngtopnm alone.png) <(pngtopnm inside-000.png) || fail "expected the same pixels"
}

# The three formats show the same page. Other programs draw the PDF and the SVG at the resolution of
# the PNG, and few pixels differ much from the PNG.
test_pdf_svg_and_png_show_the_same_page() {
    grow
    for form in png pdf svg; do
        # shellcheck disable=SC2086
        run_ok corcast render tree.swc $ALL --background '#ddddee' -o page.$form
    done
    pdftocairo -png -singlefile -r 300 page.pdf pdf
    pngtopnm pdf.png >pdf.ppm
    rsvg-convert --dpi-x 300 --dpi-y 300 page.svg -o svg.png
    pngtopnm svg.png >svg.ppm 2>/dev/null
    pngtopnm page.png >page.ppm
    for other in pdf svg; do
        pnmcut -left 0 -top 0 -width 720 -height 555 $other.ppm >other.ppm
        run corcast compare page.ppm other.ppm --json
        jq -e '.mean_abs < 0.6' stdout >/dev/null || fail "$other is not the page of the png: $(jq .mean_abs stdout)"
    done
}

test_the_same_page_whatever_the_threads_and_bands() {
    grow
    for form in png tif pdf svg; do
        # shellcheck disable=SC2086
        run_ok corcast render tree.swc $ALL -o one.$form
        # shellcheck disable=SC2086
        run_ok corcast render tree.swc $ALL --threads 1 --memory 0.3 -o two.$form
        expect_same one.$form two.$form
    done
    # shellcheck disable=SC2086
    run_ok corcast render tree.swc $ALL --tile 2/3 -o part.png
    pngtopnm one.png >one.ppm
    pngtopnm part.png >part.ppm
    read -r _ height < <(pnmfile part.ppm | sed 's/.* \([0-9]*\) by \([0-9]*\) .*/\1 \2/')
    for first in $(seq 0 8 400); do
        pnmcut -left 0 -top "$first" -width 720 -height "$height" one.ppm | cmp -s - part.ppm && return
    done
    fail "expected the tile to be rows of the whole picture"
}

test_the_legend_leaves_the_tree_alone() {
    grow
    for side in right bottom; do
        run_ok corcast render tree.swc --quiet --size 50mm --color-by flow --log --legend --legend-at $side \
            --planes id -o p.ppm
        corner="-left 460 -top 0 -width 130 -height 590"
        [ $side = right ] || corner="-left 0 -top 500 -width 590 -height 90"
        # shellcheck disable=SC2086
        pnmcut $corner p.id.ppm | ppmhist -noheader 2>/dev/null >colors
        [ "$(wc -l <colors)" = 1 ] || fail "expected no vessel where the legend is, at the $side"
        # shellcheck disable=SC2086
        pnmcut $corner p.ppm | ppmhist -noheader 2>/dev/null >colors
        [ "$(wc -l <colors)" -gt 50 ] || fail "expected the legend at the $side"
    done
}

# With a field and the default look, for trees with many values and with one value.
test_nine_tenths_of_a_vessel_have_the_color_of_the_legend() {
    local model turn
    run_ok corcast grow --terminals 150 --domain ball:30 --seed 4 --quiet -o tree.swc
    awk '/^[0-9]/ { print $1 "," ($1 * 7) % 41 + 0.5 }' tree.swc >many
    awk '/^[0-9]/ { print $1 ",2.5" }' tree.swc >one
    for model in rounded isosurface; do
        for turn in 0,0 70,-35; do
            for values in "many 0.5 40.5" "one 2.5 2.5"; do
                sed '1i id,load' "${values%% *}" >load.csv
                # shellcheck disable=SC2086
                run_ok corcast render tree.swc --quiet --model $model --turn $turn --color-by load.csv:load --legend \
                    --antialias 1 --size 700x700 --planes color,id -o p.ppm
                # shellcheck disable=SC2086
                run_ok "$REPO/tests/oracle/legend_distance.py" p.ppm p.id.ppm $values
                awk '{ exit !($1 >= 0.9 && $3 > 20000) }' stdout || fail "expected 0.9 as $model, got $(cat stdout)"
            done
        done
    done
}

# shows OPTION... -- LINE...: the texts of the page, from top to bottom, are the lines.
shows() {
    local options=()
    while [ "$1" != -- ]; do
        options+=("$1")
        shift
    done
    shift
    run_ok corcast render tree.swc --quiet --legend "${options[@]}" -o page.svg
    xmllint --xpath '//*[local-name()="text"]/text()' page.svg | tr '\n' ' ' >texts
    [ "$(cat texts)" = "$* " ] || fail "expected the texts '$*', got '$(cat texts)', from: $command_line"
}

test_few_whole_numbers_have_swatches_and_logarithms_have_their_ends() {
    run_ok corcast grow --domain ball:30 --terminals 300 --seed 4 --quiet -o tree.swc
    shows --size 60mm --color-by strahler -- 1 2 3 4 5 6 Strahler order
    [ "$(grep -c linearGradient page.svg)" = 0 ] || fail "expected no bar of orders"
    shows --size 60mm --color-by strahler --classes 3 -- 1.00 2.67 4.33 6.00 Strahler order
    shows --size 60mm --color-by level --range 0,30 -- 0 10 20 30 bifurcation level
    shows --size 60mm --color-by flow --log -- 1.67 10 100 500 'flow (ml/min)'
}

test_the_legend_of_an_upright_picture_is_below_it() {
    local size
    grow
    for size in 45mmx60mm 60mmx45mm 60mm; do
        run_ok corcast render tree.swc --quiet --legend --color-by strahler --size $size -o auto.png
        run_ok corcast render tree.swc --quiet --legend --color-by strahler --size $size \
            --legend-at "$([ $size = 45mmx60mm ] && echo bottom || echo right)" -o side.png
        cmp <(pngtopnm auto.png) <(pngtopnm side.png) || fail "expected another side at $size"
    done
    run_ok corcast render tree.swc --quiet --legend --color-by strahler --size 45mmx60mm --legend-at right -o right.png
    run_ok corcast render tree.swc --quiet --legend --color-by strahler --size 45mmx60mm -o auto.png
    ! cmp -s <(pngtopnm auto.png) <(pngtopnm right.png) || fail "expected --legend-at to be heeded"
}

test_a_scale_bar_is_as_long_as_it_says() {
    grow
    run_ok corcast render tree.swc --quiet --size 600x500 --height 100 --scale-bar 25mm --background white -o bar.png
    pngtopnm bar.png >bar.ppm
    # A bar of 25 mm in a picture of 120 mm and 600 pixels has 125 pixels: the longest run of black
    # in the lowest rows.
    longest=$(pnmcut -left 0 -top 450 -width 300 -height 50 bar.ppm | pnmtoplainpnm | tail -n +4 | tr -s ' \n' '\n\n' |
        awk 'NF { v[n++] = $1 } END { for (i = 0; i + 2 < n; i += 3) { if (i % 900 == 0) run = 0
            run = v[i] == 0 ? run + 1 : 0; if (run > most) most = run } print most }')
    [ "$longest" = 125 ] || fail "expected a bar of 125 pixels, got $longest"
}

# corner_of SVG: prints the corner of a page of 60 x 60 mm that contains the text "5 mm".
corner_of() {
    sed -n '/aria-hidden/d; s/^<text x="\([0-9.]*\)" y="\([0-9.]*\)".*>5 mm<.*/\1 \2/p' "$1" |
        awk '{ print ($2 > 30 ? "bottom" : "top") "-" ($1 > 30 ? "right" : "left") }'
}

test_a_scale_bar_is_in_the_emptiest_corner_or_where_it_is_told() {
    local corner
    printf '1 1 0 0 0 2 -1\n2 1 40 40 0 2 1\n' >up.swc
    printf '1 1 0 40 0 2 -1\n2 1 40 0 0 2 1\n' >down.swc
    for model in rounded cylinders isosurface; do
        run_ok corcast render up.swc --quiet --model $model --size 60mm --scale-bar 5 -o up.svg
        [ "$(corner_of up.svg)" = bottom-right ] || fail "$model: expected bottom-right, got $(corner_of up.svg)"
    done
    run_ok corcast render down.swc --quiet --size 60mm --scale-bar 5 -o down.svg
    [ "$(corner_of down.svg)" = bottom-left ] || fail "expected bottom-left, got $(corner_of down.svg)"
    for corner in bottom-left bottom-right top-left top-right; do
        run_ok corcast render up.swc --quiet --size 60mm --scale-bar 5 --scale-bar-at $corner -o at.svg
        [ "$(corner_of at.svg)" = $corner ] || fail "expected $corner, got $(corner_of at.svg)"
    done
    ! grep -q aria-hidden down.svg || fail "expected no halo where there is no vessel"
}

# The vessel fills the picture, so only the halo of bar and text is white, in all formats.
test_what_lies_on_vessels_has_a_halo() {
    local white
    printf '1 1 0 0 0 90 -1\n2 1 40 40 0 90 1\n' >wide.swc
    for form in png pdf svg; do
        run_ok corcast render wide.swc --quiet --look data --background white --height 20 --size 30mm \
            --scale-bar 5 --letter a --dpi 150 -o wide.$form
    done
    pdftoppm -r 150 wide.pdf page
    rsvg-convert -d 150 -p 150 wide.svg | pngtopnm >svg.ppm
    pngtopnm wide.png >png.ppm
    for picture in page-1 svg png; do
        white=$(pnmtoplainpnm $picture.ppm | tail -n +4 | tr -s ' \n' '\n\n' |
            awk 'NF { n++; low = n % 3 == 1 || $1 < low ? $1 : low; if (n % 3 == 0 && low > 250) w++ } END { print w + 0 }')
        # The frame of the bar has 54 x 2 x 2 pixels; that of the letters has slightly fewer.
        [ "$white" -gt 200 ] && [ "$white" -lt 900 ] || fail "$picture: $white white pixels"
    done
    pdftotext wide.pdf wide.txt
    [ "$(grep -c '5 mm' wide.txt)" = 1 ] || fail "expected the label once, got $(cat wide.txt)"
}

test_what_cannot_be_drawn_is_refused_in_one_sentence_and_nothing_is_written() {
    grow
    refused() {
        run corcast render tree.swc --quiet "${@:2}"
        expect_status 2
        expect_sentence "$1"
    }
    refused '\-\-legend needs --color-by' --legend -o x.png
    refused 'scale-bar needs an orthographic picture' --scale-bar 10 --projection perspective -o x.png
    refused 'scale-bar.*0.*not a number from' --scale-bar 0 -o x.png
    refused '700 mm is longer than the width of the picture' --scale-bar 700 -o x.png
    refused '\-\-legend-at needs --legend' --legend-at bottom -o x.png
    refused '\-\-scale-bar-at needs --scale-bar' --scale-bar-at top-left -o x.png
    refused 'needs --legend, --scale-bar or --letter' --text-size 6 -o x.png
    refused '\-\-legend needs .* mm, but the picture has 9 mm' --color-by flow --legend --size 9mm -o x.png
    refused '\.pfm stores measured values' --scale-bar 10 -o x.pfm
    refused 'stores its image with 8 bits' --bits 16 -o x.svg
    expect_only tree.swc
}

test_a_missing_font_is_named() {
    grow
    cp -R "$REPO/templates" templates
    rm templates/fonts/LiberationSans-Bold.ttf
    CORCAST_TEMPLATES=$PWD/templates run corcast render tree.swc --quiet --letter b -o x.png
    expect_status 3
    expect_sentence 'LiberationSans-Bold\.ttf: the font is missing'
    [ ! -e x.png ] || fail "expected no picture"
}

run_tests "$@"
