#!/bin/bash
# Pictures for paper: sizes in lengths, resolution, the formats that journals accept.
. "$(dirname "$0")/../lib.sh"

# expect_says FILE WORD...: the output of oiiotool about FILE contains each word.
expect_says() {
    local file=$1 word
    oiiotool --info -v "$file" >said 2>&1 || fail "expected oiiotool to read $file: $(head -1 said)"
    for word in "${@:2}"; do
        grep -q -- "$word" said || fail "expected $file to be '$word': $(cat said)"
    done
    rm said
}

test_a_size_on_paper_has_its_pixels_and_keeps_its_resolution() {
    local size width height
    grow_tree 4
    while read -r size width height; do
        run_ok corcast render tree.swc --size "$size" --dpi 72 -o p.png
        expect_says p.png " $width x  *$height," 'XResolution: 72' 'ResolutionUnit: "inch"'
    done <<'END'
89mm 252 252
89mmx60mm 252 170
3.5inx2.5cm 252 71
84ptx30.5pt 84 31
END
    run_ok corcast render tree.swc --size 12.5mmx9mm -o p.tif
    expect_says p.tif ' 148 x  *106,' 'XResolution: 300$' 'YResolution: 300$' 'ResolutionUnit: "in"'
}

test_dpi_of_a_size_in_pixels_is_kept_and_changes_nothing_else() {
    grow_tree 4
    run_ok corcast render tree.swc --size 31x23 -o plain.png
    run_ok corcast render tree.swc --size 31x23 --dpi 450 -o dense.png
    expect_says dense.png 'XResolution: 450'
    expect_differing 0 0 plain.png dense.png
    rm ./*.decoded
    run corcast render tree.swc --size 31x23 --dpi 450 -o p.ppm
    expect_status 2
    expect_sentence '--dpi needs a --size on paper, such as 89mm, or a file that keeps it'
    run corcast scene tree.swc --size 31x23 --dpi 450 -o p.pov
    expect_status 2
    expect_sentence '--dpi needs a --size on paper'
    expect_only tree.swc plain.png dense.png
}

test_the_command_in_a_picture_makes_it_again() {
    grow_tree 4
    run_ok corcast render tree.swc --size 3.5cmx1in --dpi 97.5 -o p.png
    command=$(oiiotool --info -v p.png | sed -n 's/.*Comment: "corcast \(.*\) -o .*/\1/p')
    # The words of the command.
    # shellcheck disable=SC2086
    run_ok corcast $command -o q.png
    expect_same p.png q.png
}

test_scenes_recipes_diagrams_and_reports_take_sizes_on_paper() {
    grow_tree 4
    run_ok corcast scene tree.swc --size 10mmx8mm --dpi 127 -o s.pov
    grep -q '^// Size: 50x40$' s.pov || fail "expected a scene of 50 x 40: $(grep Size: s.pov)"
    printf 'dpi = 254\nsize = 4mm\n' >r.ini
    run_ok corcast render tree.swc --recipe r.ini -o p.png
    expect_says p.png ' 40 x  *40,' 'XResolution: 254'
    run_ok corcast diagram tree.swc --size 5mmx4mm --dpi 254 -o d.png
    expect_says d.png ' 50 x  *40,' 'XResolution: 254'
}

test_bad_sizes_are_refused_in_a_sentence() {
    local size
    grow_tree 4
    for size in 0mm 0mmx5mm 5mmx0mm -3mm 5kmx5km mm 5mmx7 7x5mm 1e999mm nanmm 5mmx5mmx5mm 89 ''; do
        run corcast render tree.swc --size "$size" -o p.png
        expect_status 2
        expect_sentence "^corcast render: --size: '$size' is not a size on paper, such as 89mm or 89mmx60mm"
    done
    run corcast render tree.swc --size 40000inx1mm -o p.png
    expect_status 2
    expect_sentence '--size: 1.016e\+06 mm at 300 dpi are 12000000 pixels, not from 1 to 1048576'
    run corcast render tree.swc --size 0.01mm -o p.png
    expect_status 2
    expect_sentence '--size: 0.01 mm at 300 dpi are 0 pixels, not from 1'
    run corcast render tree.swc --size 9mm --dpi 0 -o p.png
    expect_status 2
    expect_sentence "--dpi: '0' is not a number from 1 to 100000"
    expect_only tree.swc
}

# icc_of FILE: prints the name of the ICC profile in FILE.
icc_of() {
    oiiotool --info -v "$1" | sed -n 's/.*ICCProfile:profile_description: "\(.*\)"/\1/p'
}

test_a_tiff_is_compressed_as_asked_for_and_carries_its_profile() {
    local how compression
    grow_tree 9
    run_ok corcast render tree.swc --size 40x30 --bits 16 -o p.png
    for how in lzw deflate:zip none; do
        compression=${how#*:}
        run_ok corcast render tree.swc --size 40x30 --bits 16 --compression "${how%:*}" -o "$compression.tif"
        expect_says "$compression.tif" "compression: \"$compression\"" uint16 'profile_description: "sRGB built-in"'
        idiff -q "$compression.tif" p.png >/dev/null || fail "expected $compression.tif to show what p.png does"
    done
    run_ok corcast render tree.swc --size 40x30 --bits 16 -o usual.tif
    expect_says usual.tif 'compression: "lzw"'
    run_ok corcast render tree.swc --size 40x30 --bits 16 -o again.tif
    expect_same usual.tif again.tif
    run_ok corcast render tree.swc --size 40x30 --background none -o clear.tif
    [ "$(icc_of clear.tif)" = "sRGB built-in" ] || fail "expected the profile of sRGB beside alpha: $(icc_of clear.tif)"
}

test_a_jpeg_is_near_the_picture_and_keeps_its_resolution() {
    grow_tree 9
    run_ok corcast render tree.swc --size 20mm --dpi 100 -o p.png
    run_ok corcast render tree.swc --size 20mm --dpi 100 -o p.jpg
    run_ok corcast render tree.swc --size 20mm --dpi 100 --quality 20 -o worse.jpeg
    expect_says p.jpg ' 79 x  *79,' 'XResolution: 100' 'subsampling: "4:4:4"' 'corcast render tree.swc --size 20mmx20mm'
    idiff -fail 0.2 p.jpg p.png >/dev/null || fail "expected a JPEG near the picture: $(idiff -fail 0.2 p.jpg p.png)"
    [ "$(stat -c %s p.jpg)" -gt "$(stat -c %s worse.jpeg)" ] || fail "expected quality 20 to be smaller than 95"
    jpegtopnm p.jpg >p.ppm 2>said || fail "expected netpbm to read p.jpg: $(cat said)"
    run_ok corcast render tree.swc --size 20mm --dpi 100 -o again.jpg
    expect_same p.jpg again.jpg
}

# expect_inks TIFF X REGEX: cyan, magenta, yellow and black of pixel X of the first row match the
# pattern.
expect_inks() {
    oiiotool --iconfig oiio:RawColor 1 "$1" --cut "1x1+$2+0" --printstats | grep -qE "Avg: $3 " ||
        fail "expected inks $3 at $2: $(oiiotool --iconfig oiio:RawColor 1 "$1" --cut "1x1+$2+0" --printstats)"
}

test_a_grey_picture_has_no_inks() {
    printf 'P2 2 1 255 9 200\n' >grey.pgm
    run corcast convert grey.pgm grey.tif --cmyk-profile "$CMYK"
    expect_status 2
    expect_sentence 'grey.tif: an output profile \(CMYK\) needs an opaque picture in color'
    expect_only grey.pgm
}

test_inks_are_those_of_the_profile_and_go_with_it() {
    local file
    grow_tree 9
    printf 'P3 3 1 255 255 255 255  0 0 0  200 20 30\n' >three.ppm
    for file in c.tif c.jpg; do
        run_ok corcast convert three.ppm "$file" --dpi 600 --cmyk-profile "$CMYK"
        expect_says "$file" 'ColorSpace: "CMYK"' 'XResolution: 600'
        [ "$(icc_of "$file")" = "Artifex CMYK SWOP Profile" ] || fail "expected the press's profile in $file: $(icc_of "$file")"
    done
    run_ok corcast convert three.ppm relative.tif --cmyk-profile "$CMYK"
    expect_inks c.tif 0 '0.000000 0.000000 0.000000 0.000000'
    expect_inks c.tif 1 '0\.7[0-9]* 0\.6[0-9]* 0\.6[0-9]* 0\.8[0-9]*'
    expect_inks c.tif 2 '0\.1[0-9]* 1\.000000 1\.000000 0\.0[0-9]*'
    run_ok corcast convert three.ppm perceptual.tif --cmyk-profile "$CMYK" --cmyk-intent perceptual
    idiff -q relative.tif perceptual.tif >/dev/null && fail "expected the intent to change the inks"
    idiff -fail 0.1 c.jpg c.tif >said || fail "expected both formats to show the same: $(cat said)"
    run_ok corcast render tree.swc --size 30x20 --bits 16 --cmyk-profile "$CMYK" -o deep.tif
    expect_says deep.tif uint16 'ColorSpace: "CMYK"'
    run_ok corcast render tree.swc --size 30x20 --bits 16 --cmyk-profile "$CMYK" -o again.tif
    expect_same deep.tif again.tif
}

test_bad_profiles_are_refused_and_nothing_is_written() {
    grow_tree 4
    head -c 5000 "$CMYK" >cut.icc
    while IFS='|' read -r profile sentence; do
        run corcast render tree.swc --size 30x20 --cmyk-profile "$profile" -o p.tif
        expect_status 2
        expect_sentence "$sentence"
    done <<END
missing.icc|missing.icc: cannot be read: No such file
tree.swc|tree.swc: is not an ICC profile
cut.icc|cut.icc: cannot convert colors to inks
${CMYK%/*}/srgb.icc|srgb.icc: is not a CMYK profile
END
    run corcast render tree.swc --size 30x20 --cmyk-profile "$CMYK" -o p.png
    expect_status 2
    expect_sentence '--cmyk-profile is for .tif, .jpg, .pdf and .eps'
    run corcast render tree.swc --size 30x20 --quality 80 -o p.tif
    expect_status 2
    expect_sentence '--quality is for .jpg'
    run corcast render tree.swc --size 30x20 --compression lzw -o p.png
    expect_status 2
    expect_sentence '--compression is for .tif'
    run corcast render tree.swc --size 30x20 --cmyk-intent perceptual -o p.tif
    expect_status 2
    expect_sentence '--cmyk-intent needs --cmyk-profile'
    run corcast render tree.swc --size 30x20 --bits 16 -o p.jpg
    expect_status 2
    expect_sentence "--bits: '16': a .jpg stores 8 bits"
    run corcast convert tree.swc other.csv --quality 3
    expect_status 2
    expect_sentence '--quality is for pictures'
    expect_only tree.swc cut.icc
}

# OpenImageIO reads OpenEXR with another library than corcast uses to write it.
test_an_exr_holds_the_planes_exactly() {
    local of plane channels names
    grow_tree 9
    run_ok corcast render tree.swc --size 45x37 --planes color,depth,normal,id --memory 0.001 -o p.png
    run_ok corcast render tree.swc --size 45x37 --planes color,depth,normal,id --dpi 254 -o p.exr
    expect_says p.exr '8 channel, float openexr' 'R, G, B, Z, id, N.X, N.Y, N.Z' 'XResolution: 254' 'compression: "zip"'
    for of in color:R,G,B:R,G,B depth:Z:Z normal:N.X,N.Y,N.Z:R,G,B; do
        IFS=: read -r plane channels names <<<"$of"
        oiiotool p.exr --ch "$channels" --chnames "$names" -o part.exr
        run_ok corcast convert part.exr part.pfm
        expect_same part.pfm "p.$plane.pfm"
    done
    oiiotool p.exr --ch id -o id.exr
    run_ok corcast convert id.exr id.pfm
    tail -c +15 id.pfm | od -An -v -t f4 -w4 | sort -n | uniq -c >ids
    tail -c +14 p.id.ppm | od -An -v -t u1 -w3 | awk '{ print $1 * 65536 + $2 * 256 + $3 }' | sort -n | uniq -c >others
    diff -b ids others >said || fail "expected the ids of the plane: $(head -3 said)"
    run_ok corcast render tree.swc --size 45x37 --planes color,depth,normal,id --dpi 254 --memory 0.001 -o bands.exr
    idiff p.exr bands.exr >said || fail "expected bands to give what the whole gives: $(cat said)"
    run_ok corcast render tree.swc --size 45x37 --bits 16 -o half.exr
    expect_says half.exr '3 channel, half openexr'
    idiff -fail 0.001 half.exr p.color.pfm >said || fail "expected halves within 0.001: $(cat said)"
}

run_tests "$@"
