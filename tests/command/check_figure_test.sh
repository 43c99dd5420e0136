#!/bin/bash
# `check-figure`: figures that publishers would refuse. The files come from corcast, and other
# programs plant faults in them.
. "$(dirname "$0")/../lib.sh"

# taken PRESET FILE [OPTION...]: the file meets the preset.
taken() {
    run corcast check-figure "$2" --preset "$1" "${@:3}"
    expect_status 0
    expect_stdout "^$2: meets the preset $1. Not checked: "
    [ "$(wc -l <stdout)" = 1 ] || fail "expected one line, got: $(cat stdout)"
}

# refused PRESET FILE REGEX [OPTION...]: the only finding about the file matches REGEX.
refused() {
    run corcast check-figure "$2" --preset "$1" "${@:4}"
    expect_status 1
    expect_stdout "^$2: $3\$"
    [ "$(wc -l <stdout)" = 1 ] || fail "expected one line, got: $(cat stdout)"
    [ ! -s stderr ] || fail "expected no error$(said)"
}

# refused_twice PRESET FILE REGEX REGEX: there are exactly two findings, which match the patterns.
refused_twice() {
    run corcast check-figure "$2" --preset "$1"
    expect_status 1
    expect_stdout "^$2: $3\$"
    expect_stdout "^$2: $4\$"
    [ "$(wc -l <stdout)" = 2 ] || fail "expected two lines, got: $(cat stdout)"
}

# A small picture can replace a large one, because only the properties that the file states are
# checked.
test_each_preset_takes_what_render_draws_by_it() {
    local preset file
    grow_tree 3
    while read -r preset pixels formats; do
        for file in $formats; do
            run_ok corcast render tree.swc --antialias 1 --preset "$preset" --json "$file.json" -o "$file"
            expect_json "$file.json" ".width == $pixels"
            taken "$preset" "$file"
        done
    done <<'END'
nature 1577 n.tif n.png n.jpg n.pdf
elsevier 1772 e.tif e.jpg
plos 1559 p.tif
springer 1984 s.tif
END
    run_ok corcast render tree.swc --preset poster-a0 --dpi 3 -o a.tif
    refused poster-a0 a.tif 'resolution: 3 dpi; the minimum for halftone is 150'
}

test_a_preset_says_what_nobody_else_does() {
    grow_tree 3
    run_ok corcast render tree.swc --preset plos --preset-width double --dpi 30 -o p.tif
    oiiotool --info p.tif | grep -q ' 225 x  *225,' || fail "expected 190.5 mm at 30 dpi: $(oiiotool --info p.tif)"
    run_ok corcast render tree.swc --preset nature --preset-width double --dpi 30 -o n.tif
    oiiotool --info n.tif | grep -q ' 216 x  *201,' || fail "expected the height of a page: $(oiiotool --info n.tif)"
    printf 'size = 30x20\n' >r.ini
    run_ok corcast render tree.swc --preset nature --recipe r.ini -o r.png
    oiiotool --info -v r.png | grep -q 'XResolution: 450' || fail "expected 450 dpi"
    oiiotool --info r.png | grep -q ' 30 x  *20,' || fail "expected the recipe's size"
    run corcast render tree.swc --preset-width double -o x.png
    expect_status 2
    expect_sentence '--preset-width needs --preset'
    run corcast render tree.swc --preset sience -o x.png
    expect_status 2
    expect_sentence "--preset: 'sience' is unknown; available: elsevier, nature, plos, poster-a0 or springer"
}

test_figures_and_pages_of_several_parts_go_by_presets() {
    grow_tree 3
    run_ok corcast render tree.swc --preset nature --legend --color-by radius --scale-bar 10 --letter a -o legend.pdf
    taken nature legend.pdf --kind combination
    printf '[panel a]\ntree = tree.swc\n' >two.ini
    run_ok corcast figure two.ini --preset nature -o two.pdf
    taken nature two.pdf
    run_ok corcast figure two.ini --preset springer --dpi 300 -o two.tif
    taken springer two.tif
}

# drawn PIXELS LINES [OPTION...]: a figure whose section [figure] has the lines has the size PIXELS.
drawn() {
    printf "[figure]\n$2\n[panel a]\ntree = tree.swc\nantialias = 1\n" >given.ini
    run_ok corcast figure given.ini "${@:3}" -o given.png
    pngtopnm given.png | pnmfile | grep -q " $1 " ||
        fail "expected $1 pixels of '$2' ${*:3}, got $(pngtopnm given.png | pnmfile)"
}

test_what_is_given_wins_over_a_preset_in_every_order() {
    grow_tree 3
    drawn '72 by 35' 'size = 183mmx90mm\npreset = nature\ndpi = 10'
    drawn '72 by 35' 'preset = nature\ndpi = 10\nsize = 183mmx90mm'
    drawn '72 by 35' 'column = double\npreset = plos\nsize = 183mmx90mm' --dpi 10
    drawn '72 by 35' 'size = 183mmx90mm\ndpi = 10' --preset nature
    drawn '72 by 35' 'preset = nature' --size 183mmx90mm --dpi 10
    drawn '72 by 35' 'preset = nature\nsize = 20mmx20mm\ndpi = 90' --size 183mmx90mm --dpi 10
    drawn '35 by 35' 'preset = nature\ndpi = 10' --quiet
    drawn '72 by 67' 'preset = nature\ndpi = 10' --preset-width double
    drawn '72 by 67' 'column = double\ndpi = 10' --preset nature
    drawn '72 by 35' 'size = 183mmx90mm\npreset = plos\ndpi = 10\ncompression = none'
    run_ok corcast figure given.ini -o given.tif
    oiiotool --info -v given.tif | grep -q 'ompression.*none' || fail "expected what the recipe compresses by"
    run_ok corcast figure given.ini --preset nature --size 90mmx30mm --dpi 10 --dump-recipe -o a.tif
    mkdir again
    cp tree.swc again
    mv stdout again/given.ini
    run_ok corcast figure again/given.ini -o b.tif
    expect_same a.tif b.tif
}

test_a_text_size_of_all_panels_wins_over_the_page() {
    grow_tree 3
    printf '[panels]\ntree = tree.swc\nscale-bar = 9\ntext-size = 11\n[panel a]\n' >sized.ini
    run_ok corcast figure sized.ini -o sized.svg
    grep '>9 mm<' sized.svg | grep -q '3\.881' || fail "expected 11 points: $(grep '>9 mm<' sized.svg)"
    printf '[panel a]\ntree = tree.swc\npreset = plos\n' >panel.ini
    run corcast figure panel.ini -o panel.svg
    expect_status 2
    expect_sentence "panel.ini:3: unknown key 'preset' in"
}

# Makes a picture of 80 x 60 mm at 300 dpi that meets every preset.
fine() {
    ppmmake rgb:80/20/20 945 709 >fine.ppm
    run_ok corcast convert fine.ppm fine.tif --dpi 300
}

test_faults_of_pictures_are_named_one_each() {
    fine
    taken nature fine.tif
    taken plos fine.tif
    refused springer fine.tif 'resolution: 300 dpi; the minimum for combination is 600' --kind combination
    refused elsevier fine.tif 'resolution: 300 dpi; the minimum for line is 1000' --kind line
    run_ok corcast convert fine.ppm low.tif --dpi 250
    refused nature low.tif 'resolution: 250 dpi; the minimum for halftone is 300'
    run_ok corcast convert fine.ppm dense.tif --dpi 601
    refused plos dense.tif 'width: 39.9 mm; the minimum is 66.8 mm'
    run_ok corcast convert fine.ppm denser.tif --dpi 610
    refused_twice plos denser.tif 'resolution: 610 dpi; the maximum is 600' 'width: 39.3 mm; the minimum is 66.8 mm'
    run_ok corcast convert fine.ppm none.jpg
    refused_twice nature none.jpg 'resolution: the file states none; 945 pixels are 270 dpi across a column of 89 mm' \
        'pixels: 945 across; a column needs 1051 pixels \(89 mm at 300 dpi\)'
    run_ok corcast convert fine.ppm deep.tif --dpi 300 --bits 16
    refused plos deep.tif 'bits: 16 per channel; the maximum is 8'
    run_ok corcast convert fine.ppm zip.tif --dpi 300 --compression deflate
    refused plos zip.tif 'compression: deflate; the preset accepts lzw'
    run_ok corcast convert fine.ppm inks.tif --dpi 300 --cmyk-profile "$CMYK"
    refused nature inks.tif 'color mode: the figure is cmyk; the preset accepts rgb grey'
    taken elsevier inks.tif
    oiiotool fine.tif --ch R,G,B,A=0.5 --compression lzw -o glassy.tif
    refused plos glassy.tif 'alpha: the figure has an alpha channel; flatten the image'
    run_ok corcast convert fine.ppm fine.png --dpi 300
    refused springer fine.png 'format: png; the preset accepts eps tif'
    ppmmake black 2204 709 >wide.ppm
    run_ok corcast convert wide.ppm wide.tif --dpi 300
    refused nature wide.tif 'width: 186.6 mm; the maximum is 183 mm'
    ppmmake black 945 2100 >high.ppm
    run_ok corcast convert high.ppm high.tif --dpi 300
    refused nature high.tif 'height: 177.8 mm; the maximum is 170 mm'
    ppmmake black 2240 1600 >large.ppm
    run_ok corcast convert large.ppm large.tif --dpi 300 --compression none
    refused_twice plos large.tif 'file size: 10.8 MB; it must be below 10 MB' 'compression: none; the preset accepts lzw'
    run corcast check-figure "$DATA/images/pages.tif" --preset nature
    expect_stdout 'pages: 2; a figure must have one page'
    run corcast check-figure "$DATA/images/wide-profile.tif" --preset nature
    expect_stdout 'profile: "Wide built-in"; the preset accepts sRGB'
}

# page_with_font FONT FILE: writes a PDF page whose only font is the dictionary FONT.
page_with_font() {
    {
        printf '%%PDF-1.4\n1 0 obj<</Type/Catalog/Pages 2 0 R>>endobj\n2 0 obj<</Type/Pages/Kids[3 0 R]/Count 1>>endobj\n'
        printf '3 0 obj<</Type/Page/Parent 2 0 R/MediaBox[0 0 200 100]/Contents 5 0 R/Resources<</Font<</F 4 0 R>>>>>>endobj\n'
        printf '4 0 obj<</Type/Font%s>>endobj\n5 0 obj<</Length 30>>stream\n' "$1"
        printf 'BT /F 12 Tf 9 9 Td (mm) Tj ET \nendstream endobj\n6 0 obj<</Length 26>>stream\n'
        printf '1000 0 d0 0 0 750 750 re f\nendstream endobj\ntrailer<</Root 1 0 R>>\n'
    } >"$2"
}

test_faults_of_pages_are_named() {
    grow_tree 3
    run_ok corcast render tree.swc --size 80mmx50mm --dpi 300 --scale-bar 10 -o fine.pdf
    taken nature fine.pdf
    refused elsevier fine.pdf 'resolution: 300 dpi in image 1; the minimum for combination is 500' --kind combination
    run_ok corcast render tree.swc --size 80mmx50mm --dpi 200 -o low.pdf
    refused nature low.pdf 'resolution: 200 dpi in image 1; the minimum for halftone is 300'
    run_ok corcast render tree.swc --size 200mmx50mm --dpi 300 --antialias 1 -o wide.pdf
    refused nature wide.pdf 'width: 200.0 mm; the maximum is 183 mm'
    page_with_font '/Subtype/Type1/BaseFont/Helvetica' bare.pdf
    refused nature bare.pdf 'fonts: Helvetica is not embedded'
    local drawn='/Subtype/Type3/FontBBox[0 0 750 750]/FontMatrix[.001 0 0 .001 0 0]/CharProcs<</m 6 0 R>>'
    drawn+='/Encoding<</Type/Encoding/Differences[109/m]>>/FirstChar 109/LastChar 109/Widths[1000]'
    page_with_font "$drawn" drawn.pdf
    refused nature drawn.pdf 'fonts: a font without a name is a Type 3 font; the accepted kinds are TrueType, OpenType and Type 1'
    page_with_font "$drawn/BaseFont/Dots" named.pdf
    refused nature named.pdf 'fonts: Dots is a Type 3 font; .*'
    head -c 900 fine.pdf >cut.pdf
    run corcast check-figure cut.pdf --preset nature
    expect_status 2
    expect_sentence 'cut.pdf: is not a valid PDF according to pdfinfo'
    PATH=/nowhere "$CORCAST" check-figure fine.pdf --preset nature >stdout 2>stderr
    [ $? = 3 ] || fail "expected status 3 without poppler"
    expect_sentence 'pdfinfo is not installed; it is part of poppler-utils'
}

# The exponents of 7-point text have 4.9 points, and those of 6-point text 4.2.
test_text_that_is_too_small_is_named_except_superscripts() {
    local size
    grow_tree 3
    for size in 5.2 6 7; do
        run_ok corcast render tree.swc --size 80mmx50mm --dpi 300 --color-by wss --legend --text-size $size \
            --legend-title 'τ_{w} 10^{-12} Pa' -o fine.pdf
        taken nature fine.pdf
    done
    run_ok corcast render tree.swc --size 80mmx50mm --dpi 300 --scale-bar 10 --text-size 4.5 -o small.pdf
    refused nature small.pdf 'text: "10 mm" has a size of 4.7 pt; the minimum is 5 pt'
    run_ok corcast render tree.swc --size 80mmx50mm --dpi 500 --scale-bar 10 --text-size 5.5 -o small.pdf
    taken nature small.pdf
    refused elsevier small.pdf 'text: "10 mm" has a size of 5.7 pt; the minimum is 6 pt'
}

# page_of_ink OPERATOR: prints a PDF page of 80 x 60 mm whose upper half has the color of an
# operator, such as "1 1 1 0.4 k".
page_of_ink() {
    local drawing="$1 0 85 227 85 re f"
    printf '%%PDF-1.4\n1 0 obj<</Type/Catalog/Pages 2 0 R>>endobj\n2 0 obj<</Type/Pages/Kids[3 0 R]/Count 1>>endobj\n'
    printf '3 0 obj<</Type/Page/Parent 2 0 R/MediaBox[0 0 227 170]/Contents 4 0 R>>endobj\n'
    printf '4 0 obj<</Length %d>>stream\n%s\nendstream endobj\ntrailer<</Root 1 0 R>>\n' ${#drawing} "$drawing"
}

# The expected sums of the pixels were computed by OpenImageIO.
test_the_total_ink_of_pixels_and_pages_is_checked() {
    local ink
    ppmmake rgb:05/05/14 945 709 >dark.ppm
    run_ok corcast convert dark.ppm dark.tif --dpi 500 --cmyk-profile "$CMYK"
    run_ok corcast convert dark.ppm dark.jpg --dpi 500 --cmyk-profile "$CMYK"
    ink=$(oiiotool --iconfig oiio:RawColor 1 dark.tif --chsum --printstats | awk '/Stats Max/ { printf "%.0f", 100 * $3 }')
    [ "$ink" -gt 200 ] || fail "expected a dark picture, got $ink %"
    taken elsevier dark.tif
    refused elsevier dark.tif "total ink: $ink %; the maximum is 180 %" --ink 180
    refused elsevier dark.jpg "total ink: $ink %; the maximum is 180 %" --ink 180
    taken elsevier dark.tif --ink "$ink"
    page_of_ink '1 1 1 0.4 k' >rich.pdf
    refused elsevier rich.pdf 'total ink: 340 %; the maximum is 320 %'
    page_of_ink '0.8 0.8 0.8 0.4 k' >poor.pdf
    taken elsevier poor.pdf
    page_of_ink '0.1 0 0.2 rg' >rgb.pdf
    taken elsevier rgb.pdf --ink 201
    run corcast check-figure rich.pdf --preset elsevier --ink 401
    expect_status 2
    expect_sentence '--ink: .*401.*'
}

test_what_nobody_can_check_is_said() {
    printf '%%!PS-Adobe-3.0 EPSF-3.0\n' >f.eps
    run corcast check-figure f.eps --preset plos
    expect_status 0
    expect_stdout '^f.eps: meets the preset plos. Not checked: everything in a .eps except its format and size$'
}

test_the_verdict_is_json_too() {
    fine
    run corcast check-figure fine.tif --preset nature --json
    expect_status 0
    expect_json stdout '.accepted and .refused == [] and (.not_checked | length) == 1 and .file == "fine.tif"'
    run corcast check-figure fine.tif --preset springer --kind combination --json
    expect_status 1
    expect_json stdout '(.accepted | not) and .preset == "springer" and (.refused | length) == 1'
}

test_bad_input_is_refused_in_a_sentence() {
    fine
    run_ok corcast convert fine.ppm fine.png
    run_ok corcast convert fine.ppm fine.jpg
    while read -r bytes name format; do
        head -c "$bytes" "fine.$name" >"cut.$name"
        run corcast check-figure "cut.$name" --preset nature
        expect_status 2
        expect_sentence "cut.$name: is not a valid $format file: "
    done <<'END'
30 png PNG
200 jpg JPEG
50 tif TIFF
END
    echo words >words.txt
    run corcast check-figure words.txt --preset nature
    expect_status 2
    expect_sentence 'words.txt: is not a picture or a page'
    run corcast check-figure none.tif --preset nature
    expect_status 2
    expect_sentence 'none.tif: cannot be read: No such file'
    run corcast check-figure fine.tif
    expect_status 2
    expect_sentence '--preset is missing; run `corcast presets` for a list'
    while IFS='|' read -r change sentence; do
        sed "$change" "$REPO/templates/presets/nature.ini" >mine.ini
        run corcast check-figure fine.tif --preset ./mine.ini
        expect_status 2
        expect_sentence "mine.ini:.*$sentence"
    done <<'END'
s/single = 89/single = -1/|'-1' of .width. is not a number of at least 0
s/double = 183/single = 3/|'single' occurs twice in .width.
/^bits/d|'bits' of .file. is missing
END
    printf '[width]\nhalf = 3\n' >mine.ini
    run corcast check-figure fine.tif --preset ./mine.ini
    expect_status 2
    expect_sentence "mine.ini:2: a preset has no 'half' in \[width\]"
}

run_tests "$@"
