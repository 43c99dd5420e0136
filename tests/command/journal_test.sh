#!/usr/bin/env bash
# What journals ask of a figure: its size, and files other than PDF.
. "$(dirname "$0")/../lib.sh"

# expect_paper FILE WIDTH HEIGHT: the page has this size in mm, to half a millimetre.
expect_paper() {
    pdfinfo "$1" | awk -v w="$2" -v h="$3" '/^Page size/ { x = $3 * 25.4 / 72 - w; y = $5 * 25.4 / 72 - h
        exit !(x * x < 0.25 && y * y < 0.25) }' || fail "expected $2 x $3 mm, got: $(pdfinfo "$1" | grep size)"
}

# A size that is given anywhere is the size of the page, whatever preset and column say.
test_a_preset_never_overrides_a_size() {
    local size preset column option options
    run_ok corcast grow --terminals 3 --quiet -o t.swc
    for size in '' 'size = 60mmx30mm'; do
        for preset in '' 'preset = nature'; do
            for column in '' 'column = double'; do
                printf '[figure]\ndpi = 50\n%s\n%s\n%s\n[panel a]\ntree = t.swc\n' "$size" "$preset" "$column" >f.ini
                for option in '' '--preset nature' '--preset plos --column double'; do
                    options=($option)
                    run_ok corcast figure f.ini --quiet "${options[@]}" -o f.pdf
                    if [ -n "$size" ]; then
                        expect_paper f.pdf 60 30
                    else
                        case "$option$preset/$column" in
                        *plos*) expect_paper f.pdf 190.5 190.5 ;;
                        *nature*/?*) expect_paper f.pdf 183 170 ;;
                        *) expect_paper f.pdf 89 89 ;;
                        esac
                    fi
                    run_ok corcast figure f.ini --quiet "${options[@]}" --size 40mmx50mm -o f.pdf
                    expect_paper f.pdf 40 50
                done
            done
        done
    done
    printf 'size = 60mmx30mm\ndpi = 50\n' >r.ini
    for option in '' '--column double'; do
        options=($option)
        run_ok corcast render t.swc --quiet --recipe r.ini --preset nature "${options[@]}" -o r.pdf
        expect_paper r.pdf 60 30
        run_ok corcast render t.swc --quiet --preset nature "${options[@]}" --size 60mmx30mm --dpi 50 -o r.pdf
        expect_paper r.pdf 60 30
    done
}

# The EPS of a page is the PDF of the page: ghostscript draws both, and reads the text of both.
test_an_eps_shows_what_the_pdf_shows() {
    local page
    run_ok corcast grow --terminals 20 --quiet -o t.swc
    printf '[figure]\nsize = 63.5mmx31.75mm\ndpi = 288\ncolumns = 2\n[panels]\ntree = t.swc\nantialias = 1\n[panel a]\n' >f.ini
    printf 'color-by = radius\nlegend = on\nscale-bar = 8\n[panel b]\nink = 0.2\ntitle = lines\n' >>f.ini
    run_ok corcast figure f.ini --quiet -o f.eps
    cp f.eps again.eps
    run_ok corcast figure f.ini --quiet --threads 1 -o f.eps
    expect_same f.eps again.eps
    run_ok corcast figure f.ini --quiet -o f.pdf
    run_ok corcast render t.swc --quiet --size 38.1mm --dpi 288 --ink 0.2 -o ink.eps
    run_ok corcast render t.swc --quiet --size 38.1mm --dpi 288 --ink 0.2 -o ink.pdf
    run_ok corcast diagram t.swc --quiet --color-by radius -o diagram.eps
    run_ok corcast diagram t.swc --quiet --color-by radius -o diagram.pdf
    for page in f ink diagram; do
        head -1 $page.eps | grep -q '^%!PS-Adobe-3.0 EPSF-3.0' || fail "expected an EPS, got $(head -1 $page.eps)"
        for form in eps pdf; do
            gs -q -dSAFER -dEPSCrop -dBATCH -dNOPAUSE -sDEVICE=ppmraw -r100 -dTextAlphaBits=4 -dGraphicsAlphaBits=4 \
                -sOutputFile=whole.ppm $page.$form || fail "ghostscript cannot read $page.$form"
            # An EPS has whole points, from its lower left corner.
            pamflip -tb whole.ppm | pamcut -width 150 -height 120 >$form.ppm
        done
        pnmpsnr -machine eps.ppm pdf.ppm | awk '{ exit !($1 == "nomatch" || $1 > 16) }' ||
            fail "expected $page.eps to look like $page.pdf, got $(pnmpsnr -machine eps.ppm pdf.ppm) dB"
    done
    gs -q -dSAFER -dEPSCrop -dBATCH -dNOPAUSE -sDEVICE=txtwrite -sOutputFile=text f.eps
    grep -q 'lines' text || fail "expected the title as text, got $(cat text)"
    run_ok corcast render t.swc --quiet --preset springer --dpi 20 -o s.eps
    run_ok corcast check-figure s.eps --preset springer
}
# One tree in a high panel and in a flat one with a legend: the trees are equally wide, and neither
# lies under the legend.
test_panels_of_one_scale_show_a_tree_in_one_size() {
    run_ok corcast grow --terminals 30 --seed 3 --quiet -o t.swc
    printf '[figure]\nsize = 120mmx60mm\ndpi = 100\ncolumns = 2\nletters = none\n[panels]\ntree = t.swc\n' >f.ini
    printf 'look = data\ncolor-by = radius\n[panel a]\n[panel b]\nlegend = on\n' >>f.ini
    for scale in off on; do
        run_ok corcast figure f.ini --quiet --same-scale $scale -o $scale.png
        for column in 0 236; do
            pngtopnm $scale.png | pamcut -left $column -width $((column ? 168 : 236)) |
                pnmcrop -white 2>/dev/null | pnmfile | sed 's/.* \([0-9]*\) by.*/\1/'
        done >$scale.widths
    done
    awk '{ w[NR] = $1 } END { exit !(w[1] > 1.2 * w[2]) }' off.widths || fail "expected two scales, got $(xargs <off.widths)"
    awk '{ w[NR] = $1 } END { exit !((w[1] - w[2]) ^ 2 <= 4) }' on.widths || fail "expected one scale, got $(xargs <on.widths)"
    printf 'height = 90\n' >>f.ini
    run corcast figure f.ini --same-scale on -o x.png
    expect_status 2
    expect_sentence '\[panel b\]: height has no effect beside same-scale'
}

run_tests "$@"
