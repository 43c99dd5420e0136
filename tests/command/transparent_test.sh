#!/usr/bin/env bash
# --background: colors by name and by code, and none. Transparent pictures composited over a color
# are compared with pictures drawn on that color.
. "$(dirname "$0")/../lib.sh"

# rgba FILE.png: prints red, green, blue and alpha, one line per pixel.
rgba() {
    pngtopam -alphapam "$1" | sed '1,/^ENDHDR/d' | od -A n -v -t u1 -w4
}

# over R G B: composites the pixels on standard input over a color in linear light, and prints sRGB
# codes.
over() {
    awk -v ground="$*" '
        function linear(c) { c /= 255; return c < 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ^ 2.4 }
        function code(v) { return int(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ^ (1 / 2.4) - 0.055) + 0.5) }
        BEGIN { split(ground, b); for (i = 0; i < 256; i++) l[i] = linear(i) }
        { a = $4 / 255; print code(a * l[$1] + (1 - a) * l[b[1]]), code(a * l[$2] + (1 - a) * l[b[2]]),
              code(a * l[$3] + (1 - a) * l[b[3]]) }'
}

expect_corner() {
    [ "$(pngtopnm "$1" | tail -c 3 | od -A n -t u1 | xargs)" = "$2" ] ||
        fail "expected a corner of $2 from: $command_line"
}

test_a_transparent_picture_over_a_color_is_the_picture_on_it() {
    local how
    run_ok corcast grow --terminals 60 --domain ball:20 -o tree.swc
    local even="--look $REPO/tests/golden/red.ini" # a look that fades is transparent in part all over
    for how in "--model joined --shadows on $even" "--model isosurface $even" "--model blob --exact --antialias 2 $even" \
        '--look journal' '--look depth'; do
        run_ok corcast render tree.swc --quiet $how --size 70x60 --background none -o none.png
        rgba none.png >none
        awk '{ seen[$4 == 0 ? 0 : $4 == 255 ? 2 : 1]++ } END { exit !(seen[0] > 999 && seen[1] > 99) }' none ||
            fail "expected pixels that are transparent and others that are so in part, from: $how"
        while read -r name ground; do
            run_ok corcast render tree.swc --quiet $how --size 70x60 --background $name -o solid.png
            paste -d ' ' <(over $ground <none) <(rgba solid.png) | awk '
                { for (c = 1; c <= 3; c++) { d = ($c - $(c + 3)) ^ 2; if (d > 1) far++; if (d > 9) exit 1 } }
                END { exit far > 20 }' || fail "expected the picture over $name, of: $how"
        done <<'END'
white 255 255 255
navy 0 0 128
END
    done
}

# A pixel has ten samples, so alpha is a multiple of 25.5. Half codes are rounded up, as POV-Ray
# does.
test_alpha_of_ten_samples_is_rounded_as_povray_rounds_it() {
    run_ok corcast render "$DATA/coronary.swc" --quiet --look "$REPO/tests/golden/red.ini" --size 120x120 --background none --antialias 3 -o none.png
    rgba none.png | awk '{ print $4 }' | sort -nu | xargs >alphas
    [ "$(cat alphas)" = '0 26 51 77 102 128 153 179 204 230 255' ] || fail "expected tenths of 255, got $(cat alphas)"
}

test_sixteen_bits_and_tiff_hold_the_same() {
    cp "$DATA/bifurcation.swc" tree.swc
    run_ok corcast render tree.swc --size 40x30 --background none -o eight.png
    run_ok corcast render tree.swc --size 40x30 --background none --memory 0.001 -o eight.tif
    tifftopnm -byrow -alphaout=alpha.pgm eight.tif >color.ppm 2>stderr || fail "expected a TIFF with alpha$(said)"
    paste -d ' ' <(tail -c 3600 color.ppm | od -A n -v -t u1 -w3) <(tail -c 1200 alpha.pgm | od -A n -v -t u1 -w1) |
        awk '{ print $1, $2, $3, $4 }' >tiff
    rgba eight.png | awk '{ print $1, $2, $3, $4 }' | diff -q - tiff >difference || fail "expected the pixels of the PNG"
    run_ok corcast render tree.swc --size 40x30 --background none --bits 16 -o sixteen.png
    [ "$(pngtopam -alphapam sixteen.png | sed '/^ENDHDR/,$d' | grep -a MAXVAL)" = "MAXVAL 65535" ] || fail "expected 16 bits"
}

test_an_openexr_file_has_alpha_among_its_channels() {
    cp "$DATA/bifurcation.swc" tree.swc
    run_ok corcast render tree.swc --size 40x30 --background none -o p.exr
    head -c 400 p.exr | strings -n 1 | tr -d '\n' | grep -q 'chlist.ABGR' || fail "expected the channels A, B, G and R"
    run_ok corcast render tree.swc --size 40x30 -o p.exr
    ! head -c 400 p.exr | strings -n 1 | tr -d '\n' | grep -q 'ABGR' || fail "expected no alpha"
}

test_what_cannot_be_transparent_is_refused() {
    local options sentence
    cp "$DATA/bifurcation.swc" tree.swc
    while IFS='|' read -r options sentence; do
        run corcast render tree.swc --size 40x30 --background none $options
        expect_status 2
        expect_sentence "$sentence"
        expect_only tree.swc
    done <<'END'
-o p.ppm|'p\.ppm' cannot be transparent; --background none needs \.png, \.tif or \.exr
-o p.pfm|'p\.pfm' cannot be transparent
-o p.pdf|'p\.pdf' cannot be transparent
-o p.jpg|'p\.jpg' cannot be transparent
-o -|'-' cannot be transparent
--scale-bar 2 -o p.png|needs a background
--antialias-threshold 0.1 -o p.png|--antialias-threshold needs a background
END
    run corcast diagram tree.swc --background none -o p.svg
    expect_status 2
    expect_sentence "--background: 'none' is not R,G,B"
}

test_convert_keeps_alpha_or_lays_it_on_a_color() {
    cp "$DATA/bifurcation.swc" tree.swc
    run_ok corcast render tree.swc --size 40x30 --background none --quiet -o none.png
    rgba none.png >none
    run_ok corcast convert none.png none.tif
    run_ok corcast convert none.tif back.png
    rgba back.png | diff -q - none >difference || fail "expected the pixels of the PNG"
    run_ok corcast convert none.png deep.png --bits 16
    run_ok corcast convert deep.png --bits 8 back.png
    rgba back.png | diff -q - none >difference || fail "expected the pixels of the PNG"
    run_ok corcast convert none.png solid.ppm --background teal
    paste -d ' ' <(over 0 128 128 <none) <(tail -c 3600 solid.ppm | od -A n -v -t u1 -w3) | awk '
        { for (c = 1; c <= 3; c++) if (($c - $(c + 3)) ^ 2 > 1) exit 1 }' || fail "expected the picture over teal"
    run corcast convert none.png no.jpg
    expect_status 2
    expect_sentence "none\.png: is transparent, which 'no\.jpg' cannot store; use --background"
    run_ok corcast render tree.swc --size 40x30 --background none --quiet -o none.exr
    run corcast convert none.exr no.pfm
    expect_status 2
    expect_sentence 'none\.exr: is transparent at column 0, row 0'
    run_ok corcast convert none.exr solid.pfm --background teal
    run_ok corcast compare none.exr solid.pfm --background teal
}

test_compare_lays_what_is_transparent_on_a_background() {
    cp "$DATA/bifurcation.swc" tree.swc
    run_ok corcast render tree.swc --size 40x30 --background none --quiet -o none.png
    run_ok corcast convert none.png white.ppm --background white
    run_ok corcast compare none.png white.ppm
    run corcast compare none.png white.ppm --background black
    expect_status 1
    pngtopnm -alpha none.png >alpha.pgm 2>error
    pngtopnm none.png 2>error | ppmtopgm >grey.pgm
    pnmtopng -alpha=alpha.pgm grey.pgm >grey.png 2>error
    run_ok corcast convert grey.png grey.ppm --background '#808080'
    run_ok corcast compare grey.png grey.ppm --background '#808080'
    paste -d ' ' <(tail -c 1200 grey.pgm | od -A n -v -t u1 -w1) <(tail -c 1200 alpha.pgm | od -A n -v -t u1 -w1) |
        awk '{ print $1, $1, $1, $2 }' | over 128 128 128 >expected
    tail -c 3600 grey.ppm | od -A n -v -t u1 -w3 | paste -d ' ' expected - | awk '
        { for (c = 1; c <= 3; c++) if (($c - $(c + 3)) ^ 2 > 1) exit 1 }' || fail "expected the grey picture over grey"
    run corcast compare none.png none.png --kind depth --background black
    expect_status 2
    expect_sentence 'background is for two pictures'
}

# half_transparent ALPHA: prints a PNG of 40 x 30 white pixels, half of them transparent. The first
# three have the given alpha.
half_transparent() {
    awk -v first="$1" 'BEGIN { print "P2 40 30 255"; for (i = 0; i < 1200; i++) print i < 3 ? first : i % 2 ? 255 : 0 }' >alpha.pgm
    pnmtopng -alpha=alpha.pgm <(awk 'BEGIN { print "P3 40 30 255"; for (i = 0; i < 3600; i++) print 255 }') 2>error
}

test_compare_judges_alpha_of_two_transparent_pictures() {
    local ext
    half_transparent 0 >a.png
    half_transparent 128 >b.png
    half_transparent 1 >c.png
    run_ok corcast compare a.png a.png
    run corcast compare a.png b.png
    expect_status 1
    expect_stdout '^differ \(tier A\): likely cause: only alpha differs, on 3 pixels; alpha: .* of the pixels are off by more than'
    run corcast compare a.png b.png --tier B --html page.html
    expect_status 1
    grep -q '<span class="bad">differ</span>' page.html || fail "expected the page to differ, too"
    run corcast compare a.png c.png
    expect_status 1
    run_ok corcast compare a.png c.png --levels 1
    run_ok corcast compare a.png b.png --tier none
    for ext in exr tif; do
        oiiotool a.png -d float -o a.$ext
        oiiotool b.png -d float -o b.$ext
        run corcast compare a.$ext b.$ext
        expect_status 1
        expect_stdout 'only alpha differs, on 3 pixels(;|$)'
    done
    mkdir stored drawn
    cp a.png stored/v.png
    cp b.png drawn/v.png
    run corcast compare --reference stored drawn
    expect_status 1
    expect_stdout '^changed v\.png: .*only alpha differs, on 3 pixels(;|$)'
    pnmtopng <<<"P2 40 30 255 $(printf '9 9 9 %s' "$(printf '0 %.0s' {1..1197})")" >stored/v.mask.png
    run_ok corcast compare --reference stored drawn
}

test_colors_have_the_names_of_css_and_codes() {
    local color codes
    cp "$DATA/bifurcation.swc" tree.swc
    while read -r color codes; do
        run_ok corcast render tree.swc --size 20x20 --background "$color" -o p.png
        expect_corner p.png "$codes"
    done <<'END'
rebeccapurple 102 51 153
SteelBlue 70 130 180
aliceblue 240 248 255
yellowgreen 154 205 50
#fa8 255 170 136
#12ABef 18 171 239
0.5,1,0 128 255 0
END
    for color in '#12' '#1234' '#ggg' 'blu' '0.5,1' '#'; do
        run corcast render tree.swc --background "$color" -o no.png
        expect_status 2
        expect_sentence "--background: '$color' is not none, R,G,B"
    done
}

test_a_scene_is_transparent_for_povray() {
    cp "$DATA/bifurcation.swc" tree.swc
    run_ok corcast scene tree.swc --background none --ini on -o none.pov
    grep -q '#declare Background_Transmit = 1;' none.pov || fail "expected a transparent background"
    grep -qx 'Output_Alpha=on' none.ini || fail "expected alpha"
    run_ok corcast scene tree.swc --ini on -o plain.pov
    grep -q '#declare Background_Transmit = 0;' plain.pov || fail "expected a background"
    ! grep -q Output_Alpha plain.ini || fail "expected no alpha"
}

run_tests "$@"
