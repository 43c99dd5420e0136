#!/usr/bin/env bash
# Requirements of journals on a figure: its size, and formats other than PDF.
. "$(dirname "$0")/../lib.sh"

# expect_paper FILE WIDTH HEIGHT: the page has this size in mm, to within 0.5 mm.
expect_paper() {
    pdfinfo "$1" | awk -v w="$2" -v h="$3" '/^Page size/ { x = $3 * 25.4 / 72 - w; y = $5 * 25.4 / 72 - h
        exit !(x * x < 0.25 && y * y < 0.25) }' || fail "expected $2 x $3 mm, got: $(pdfinfo "$1" | grep size)"
}

# A size that is specified anywhere takes precedence over preset and column.
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

# The EPS and the PDF of a page show the same picture and contain the same text, as ghostscript
# reads them.
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
            # The size of an EPS is rounded to points, from its lower left corner.
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
# One tree is drawn in a high panel and in a flat panel with a legend. The two trees are equally
# wide, and the legend covers neither.
test_panels_of_one_scale_show_a_tree_in_one_size() {
    run_ok corcast grow --terminals 30 --seed 3 --quiet -o t.swc
    printf '[figure]\nsize = 120mmx60mm\ndpi = 100\ncolumns = 2\nletters = none\n[panels]\ntree = t.swc\n' >f.ini
    printf 'look = data\nbackground = white\ncolor-by = radius\n[panel a]\n[panel b]\nlegend = on\nlegend-at = right\n' >>f.ini
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
    expect_sentence '\[panel b\]: height has no effect with same-scale = on'
}

# Writes graph.svg, as another program might: with a gradient, a marker that is used twice, and
# translucent disks.
write_graph() {
    cat >graph.svg <<'END'
<?xml version="1.0"?>
<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="80mm" height="60mm" viewBox="0 0 80 60">
<style>* { stroke-linecap: round }</style>
<defs><linearGradient id="ramp1"><stop offset="0" stop-color="#00f"/><stop offset="1" stop-color="#f80"/></linearGradient>
<g id="m"><circle r="1.5" fill="none" stroke="black" stroke-width=".3"/></g></defs>
<rect x="10" y="5" width="66" height="45" fill="none" stroke="black" stroke-width=".3"/>
<path d="M10 50 C 30 0 50 60 76 10" fill="none" stroke="url(#ramp1)" stroke-width="1"/>
<use xlink:href="#m" x="30" y="27"/><use xlink:href="#m" x="50" y="33"/>
<circle cx="60" cy="40" r="7" fill="#0a0" fill-opacity="0.4"/><circle cx="65" cy="38" r="7" fill="#a00" fill-opacity="0.4"/>
<text x="43" y="57" font-size="4" text-anchor="middle" font-family="Liberation Sans">distance</text></svg>
END
    rsvg-convert -f pdf -o graph.pdf graph.svg
    rsvg-convert -w 640 -o graph.png graph.svg
    pngtopnm -mix -background white graph.png | pnmtotiff >graph.tif 2>/dev/null
    pngtopnm -mix -background white graph.png | pnmtojpeg -quality 95 >graph.jpg
}

# expect_alike A B: two PNG pictures of equal size are similar, apart from letters and edges.
expect_alike() {
    pngtopnm "$1" | pamscale -reduce 3 >a.ppm 2>/dev/null
    pngtopnm "$2" | pamscale -reduce 3 >b.ppm 2>/dev/null
    pnmpsnr -machine a.ppm b.ppm | awk '{ exit !($1 == "nomatch" || $1 > 20) }' ||
        fail "expected $1 to look like $2, got $(pnmpsnr -machine a.ppm b.ppm) dB"
}

test_a_panel_shows_the_picture_of_another_program() {
    local file form
    write_graph
    for file in graph.svg graph.pdf graph.png graph.tif graph.jpg; do
        printf '[figure]\nsize = 80mmx60mm\ndpi = 203.2\nletters = none\n[panel a]\nimage = %s\n' $file >f.ini
        for form in png pdf svg eps; do
            run_ok corcast figure f.ini --quiet -o f.$form
            cp f.$form again.$form
            run_ok corcast figure f.ini --quiet -o f.$form
            expect_same f.$form again.$form
        done
        pngtopnm -mix -background white graph.png | pnmtopng >graph.white.png
        expect_alike f.png graph.white.png
        rsvg-convert -w 640 -o f.svg.png f.svg
        expect_alike f.svg.png graph.white.png
        pdftoppm -r 203.2 -png -singlefile f.pdf f.pdf
        expect_alike f.pdf.png graph.white.png
        gs -q -dSAFER -dEPSCrop -dBATCH -dNOPAUSE -sDEVICE=png16m -r812.8 -dTextAlphaBits=4 \
            -dGraphicsAlphaBits=4 -sOutputFile=eps.png f.eps
        pngtopnm eps.png | pamflip -tb | pamcut -width 2560 -height 1920 | pamflip -tb | pamscale -reduce 4 | pnmtopng >f.eps.png
        expect_alike f.eps.png graph.white.png
        case $file in
        graph.svg | graph.pdf) # lines stay lines, and letters letters
            [ "$(pdfimages -list f.pdf | wc -l)" = 2 ] || fail "expected no pixels, got $(pdfimages -list f.pdf)"
            pdftotext f.pdf - | grep -q distance || fail "expected text in f.pdf"
            ! grep -q '<image' f.svg || fail "expected no pixels in f.svg"
            xmllint --noout f.svg || fail "xmllint refuses f.svg"
            run corcast figure f.ini -o f.eps
            expect_sentence 'an .eps has no transparency: translucent parts of images become pixels of 203.2 dpi'
            ;;
        *)  pdfimages -list f.pdf | awk 'NR > 2 && $4 == 640 && $5 == 480 { n++ } END { exit n != 1 }' ||
                fail "expected the pixels of $file, got $(pdfimages -list f.pdf)" ;;
        esac
    done
}

test_two_drawings_in_one_svg_have_names_of_their_own() {
    write_graph
    sed 's/#00f/#fff/; s/#f80/#fff/' graph.svg >white.svg
    printf '[figure]\nsize = 80mmx60mm\ncolumns = 2\n[panel a]\nimage = white.svg\n[panel b]\nimage = graph.svg\n' >f.ini
    run_ok corcast figure f.ini --quiet -o f.svg
    [ -z "$(grep -o ' id="[^"]*"' f.svg | sort | uniq -d)" ] || fail "expected each id once"
    rsvg-convert -w 800 -o f.png f.svg
    run_ok corcast figure f.ini --quiet --size 800x600 --dpi 254 -o g.png
    expect_alike f.png g.png
}

# refuse_image IMAGE PATTERN: a panel with this image is refused with one sentence, and no file is
# written.
refuse_image() {
    printf '[panel a]\nimage = %s\n%s' "$1" "${3-}" >f.ini
    run corcast figure f.ini -o f.pdf
    expect_status 2
    expect_sentence "$2"
    [ ! -e f.pdf ] || fail "expected no file"
}

test_images_that_cannot_be_shown_are_named() {
    write_graph
    refuse_image none.pdf '\[panel a\]: none.pdf: .*'
    echo 'no picture' >words.pdf
    refuse_image words.pdf '\[panel a\]: words.pdf'
    head -c 300 graph.pdf >half.pdf
    refuse_image half.pdf 'half.pdf: is not a PDF that can be read'
    head -c 300 graph.svg >half.svg
    refuse_image half.svg 'half.svg: is not an SVG that can be read'
    truncate -s 101M huge.pdf
    printf '%%PDF-1.5' | dd of=huge.pdf conv=notrunc 2>/dev/null
    refuse_image huge.pdf 'huge.pdf: has 106 MB; a panel shows files of at most 100 MB'
    pdfunite graph.pdf graph.pdf two.pdf
    refuse_image two.pdf 'two.pdf: has 2 pages; a panel shows a PDF of one page'
    echo '<svg xmlns="http://www.w3.org/2000/svg" width="0" height="9"/>' >flat.svg
    refuse_image flat.svg 'flat.svg: its size is 0 x 9'
    printf '%%!PS\n' >page.eps
    refuse_image page.eps 'page.eps: is of the format eps; a panel shows a .pdf, .svg, .png, .tif or .jpg'
    refuse_image graph.svg '\[panel a\]: model has no effect on an image' 'model = joined'
    refuse_image graph.svg '\[panel a\] has both a tree and an image' 'tree = t.swc'
    run_ok corcast grow --terminals 3 --quiet -o t.swc
    refuse_image graph.svg '\[inset i\]: of: a shows an image' \
        $'[panel b]\ntree = t.swc\n[inset i]\nof = a\nat = 0,0\nplace = 1,1\n'
}

test_leaders_lie_on_paper_and_can_be_left_out() {
    local drawn
    run_ok corcast grow --terminals 300 --seed 4 --quiet -o t.swc
    for look in 'look = journal' 'model = isosurface'; do
        printf '[figure]\nsize = 600x600\n[panel a]\ntree = t.swc\nbackground = white\n%s\n[inset i]\nof = a\nat = 0.4,0.45\nplace = 0.85,0.85\nwidth = 12\n' "$look" >on.ini
        { cat on.ini; echo 'leaders = off'; } >off.ini
        run_ok corcast figure on.ini --quiet -o on.png
        run_ok corcast figure off.ini --quiet -o off.png
        pngtopnm on.png | ppmtopgm | pnmnoraw | tail -n +4 | tr -s ' ' '\n' | grep . >on.codes
        pngtopnm off.png | ppmtopgm | pnmnoraw | tail -n +4 | tr -s ' ' '\n' | grep . >off.codes
        drawn=$(paste -d' ' on.codes off.codes | awk '$1 != $2 { n++; over += $2 < 250 } END { print n + 0, over + 0 }')
        [ "${drawn% *}" -gt 300 ] && [ "${drawn#* }" -le 16 ] || # the corners of the two frames
             fail "expected leaders on paper alone, got $drawn pixels, and over vessels"
    done
}

# expect_inks PLANE MIN MAX: the codes of the lower left corner, which contains only a scale bar,
# range from MIN to MAX.
expect_inks() {
    pamcut -left 0 -top 196 -width 60 -height 40 "$1" | pnmnoraw | tail -n +4 | tr -s ' ' '\n' | grep . | sort -n >codes
    [ "$(head -1 codes) $(tail -1 codes)" = "$2 $3" ] ||
        fail "expected codes from $2 to $3 in $1, got $(head -1 codes) to $(tail -1 codes)"
}

# Ghostscript separates the PDF and the EPS into inks. Code 255 is no ink. The EPS has no RGB color.
test_black_type_is_black_ink_alone() {
    local ink page
    run_ok corcast grow --terminals 30 --seed 3 --quiet -o t.swc
    printf '[figure]\nsize = 60mmx40mm\ndpi = 150\n[panel a]\ntree = t.swc\nbackground = white\ncolor-by = radius\nlegend = on\nscale-bar = 10\n' >f.ini
    run_ok corcast figure f.ini --quiet --cmyk-profile $CMYK -o f.pdf
    cp f.pdf again.pdf
    run_ok corcast figure f.ini --quiet --threads 1 --cmyk-profile $CMYK -o f.pdf
    expect_same f.pdf again.pdf
    pdfimages -list f.pdf | awk 'NR > 2 && $6 != "cmyk" { exit 1 }' || fail "expected CMYK, got $(pdfimages -list f.pdf)"
    pdftotext f.pdf - | grep -q '10 mm' || fail "expected text, got $(pdftotext f.pdf -)"
    run_ok corcast figure f.ini --quiet --cmyk-profile $CMYK -o f.eps
    ! grep -aq -e '/DeviceRGB' -e '^[0-9. ]* rg' f.eps || fail "expected an EPS without RGB colors"
    for page in f.pdf f.eps; do
        gs -q -dSAFER -dBATCH -dNOPAUSE -dEPSCrop -sDEVICE=tiffsep -r150 -sOutputFile=f.%d.tif $page ||
            fail "ghostscript cannot read $page"
        for ink in Cyan Magenta Yellow Black; do
            tifftopnm "f.1($ink).tif" >$page.$ink.pgm 2>/dev/null
            expect_inks $page.$ink.pgm "$([ $ink = Black ] && echo 0 || echo 255)" 255
            [ "$(pnmnoraw $page.$ink.pgm | tail -n +4 | tr -s ' ' '\n' | sort -u | wc -l)" -gt 20 ] ||
                fail "expected shades of $ink in $page"
        done
    done
    # The EPS is two rows of white higher, to whole points.
    for ink in Cyan Magenta Yellow Black; do
        { pamsumm -mean -brief f.pdf.$ink.pgm && pamcut -top 2 f.eps.$ink.pgm | pamsumm -mean -brief; } | paste -s |
            awk '{ exit !($1 - $2 < 0.2 && $2 - $1 < 0.2) }' || fail "expected as much $ink in the EPS as in the PDF"
    done
    run_ok corcast figure f.ini --quiet --cmyk-profile $CMYK -o f.tif
    run_ok corcast render t.swc --quiet --size 60mmx40mm --dpi 150 --scale-bar 10 --background white --cmyk-profile $CMYK --bits 16 -o r.tif
    for file in f.tif r.tif; do
        for ink in 0 1 2 3; do
            oiiotool -iconfig oiio:RawColor 1 $file --ch $ink --invert -d uint8 -o plane.pgm
            expect_inks plane.pgm "$([ $ink = 3 ] && echo 0 || echo 255)" 255
        done
    done
    run corcast figure f.ini --cmyk-profile $CMYK -o f.svg
    expect_status 2
    expect_sentence 'is for .tif, .jpg, .pdf and .eps'
}

# page_of_jpeg FILE.jpg WIDTH HEIGHT: prints a PDF page that the JPEG fills.
page_of_jpeg() {
    printf '%%PDF-1.4\n1 0 obj<</Type/Catalog/Pages 2 0 R>>endobj\n2 0 obj<</Type/Pages/Kids[3 0 R]/Count 1>>endobj\n'
    printf '3 0 obj<</Type/Page/Parent 2 0 R/MediaBox[0 0 64 48]/Contents 4 0 R/Resources<</XObject<</I 5 0 R>>>>>>endobj\n'
    printf '4 0 obj<</Length 22>>stream\n64 0 0 48 0 0 cm /I Do\nendstream endobj\n5 0 obj<</Type/XObject/Subtype/Image/Width %d/Height %d' "$2" "$3"
    printf '/ColorSpace/DeviceRGB/BitsPerComponent 8/Filter/DCTDecode/Length %d>>stream\n' "$(stat -c %s "$1")"
    cat "$1"
    printf '\nendstream endobj\ntrailer<</Root 1 0 R>>\n'
}

# Ghostscript separates the panel and the TIFF of the same color into the same inks.
test_a_jpeg_of_a_panel_becomes_inks() {
    local ink
    ppmmake rgb:c8/28/1e 64 48 | pnmtojpeg -quality 100 >red.jpg
    page_of_jpeg red.jpg 64 48 >red.pdf
    printf '[figure]\nsize = 64mmx48mm\nmargin = 0\nletters = none\n[panel a]\nimage = red.pdf\n' >f.ini
    run_ok corcast figure f.ini --quiet --cmyk-profile $CMYK -o f.pdf
    pdfimages -list f.pdf | awk 'NR > 2 && $6 == "cmyk" { n++ } END { exit n != 1 }' ||
        fail "expected one CMYK image, got $(pdfimages -list f.pdf)"
    run_ok corcast convert red.jpg red.tif --cmyk-profile $CMYK
    gs -q -dSAFER -dBATCH -dNOPAUSE -sDEVICE=tiffsep -r20 -sOutputFile=f.%d.tif f.pdf || fail "ghostscript cannot read f.pdf"
    for ink in 0:Cyan 1:Magenta 2:Yellow 3:Black; do
        oiiotool -iconfig oiio:RawColor 1 red.tif --ch ${ink%:*} --invert -d uint8 -o plane.pgm
        tifftopnm "f.1(${ink#*:}).tif" 2>/dev/null | pnmcut -left 20 -top 15 -width 1 -height 1 | pnmnoraw | tail -1 >found
        pnmcut -left 20 -top 15 -width 1 -height 1 plane.pgm | pnmnoraw | tail -1 >expected
        [ "$(($(cat found) - $(cat expected)))" -ge -1 ] && [ "$(($(cat found) - $(cat expected)))" -le 1 ] ||
            fail "expected $(cat expected) of ${ink#*:}, got $(cat found)"
    done
}

run_tests "$@"
