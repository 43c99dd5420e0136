#!/usr/bin/env bash
# `compare`: measures of small pictures written by hand, whose correct numbers are known.
. "$(dirname "$0")/../lib.sh"

# picture CODE: prints a grey PPM of 5 x 4 pixels of code 100, in which pixel 7 (counted from 0) has
# the code CODE.
picture() {
    local i
    printf 'P6\n5 4\n255\n'
    for i in $(seq 0 19); do
        if [ "$i" = 7 ]; then
            printf "\\$(printf %o "$1")%.0s" 1 2 3
        else
            printf 'ddd'
        fi
    done
}

test_a_picture_agrees_with_itself() {
    picture 100 >a.ppm
    cp a.ppm b.ppm
    run_ok corcast compare a.ppm b.ppm --json
    expect_json stdout '.verdict == "agree" and .pixels == 20 and .max_abs == 0 and .mean_abs == 0 and .rmse == 0'
}

test_json_has_every_key_of_the_contract() {
    local key
    picture 100 >a.ppm
    picture 90 >b.ppm
    run corcast compare a.ppm b.ppm --json
    for key in verdict pixels max_abs mean_abs rmse psnr_db flip_mean ssim interior_max_abs \
        edge_mismatch_fraction missing_pixels extra_pixels; do
        expect_json stdout "has(\"$key\")"
    done
}

test_a_difference_is_measured_and_gives_exit_status_1() {
    picture 100 >a.ppm
    picture 155 >b.ppm
    run corcast compare a.ppm b.ppm --json
    expect_status 1
    expect_json stdout '.verdict == "differ" and .max_abs == 55'
    expect_json stdout '(.mean_abs - 55 / 20 | fabs) < 1e-9'
    expect_json stdout '(.rmse - (55 * 55 / 20 | sqrt) | fabs) < 1e-9'
    expect_json stdout '(.psnr_db - 20 * (255 / (55 * 55 / 20 | sqrt) | log10) | fabs) < 1e-6'
}

# One pixel of 20 differs. Weighted by error, most of the other 19 do not count.
test_flip_is_summed_up_with_and_without_weights() {
    picture 100 >a.ppm
    picture 155 >b.ppm
    run corcast compare a.ppm b.ppm --json
    expect_json stdout '.flip_mean > 0 and .flip_p95 <= .flip_max + 1e-5 and .flip_mean < .flip_weighted_mean'
    expect_json stdout '.flip_weighted_mean <= .flip_max and .flip_weighted_median <= .flip_weighted_p95'
    run_ok corcast compare a.ppm a.ppm --json
    expect_json stdout '[.flip_p95, .flip_weighted_mean, .flip_weighted_median, .flip_weighted_p95] == [0, 0, 0, 0]'
    run corcast compare a.ppm b.ppm --metrics on
    expect_stdout 'FLIP, 95th percentile weighted by error'
}

test_the_order_of_the_pictures_does_not_matter() {
    picture 100 >a.ppm
    picture 155 >b.ppm
    run corcast compare a.ppm b.ppm --json
    jq '{max_abs, mean_abs, rmse, psnr_db, verdict}' stdout >forth
    run corcast compare b.ppm a.ppm --json
    jq '{max_abs, mean_abs, rmse, psnr_db, verdict}' stdout >back
    expect_same forth back
}

test_formats_do_not_matter_only_pixels_do() {
    picture 37 >a.ppm
    run_ok corcast convert a.ppm b.png
    run_ok corcast compare a.ppm b.png
}

test_pictures_of_different_size_are_refused() {
    picture 100 >a.ppm
    printf 'P6\n4 5\n255\n' >b.ppm
    tail -c 60 a.ppm >>b.ppm
    run corcast compare a.ppm b.ppm
    expect_status 2
    expect_sentence '5 ?x ?4.*4 ?x ?5'
}

test_a_missing_picture_is_refused_by_name() {
    picture 100 >a.ppm
    run corcast compare a.ppm nowhere.png
    expect_status 2
    expect_sentence 'nowhere\.png'
}

test_a_file_that_is_no_picture_is_refused_by_name() {
    picture 100 >a.ppm
    echo 'hello' >b.ppm
    run corcast compare a.ppm b.ppm
    expect_status 2
    expect_sentence 'b\.ppm'
}

test_one_operand_is_bad_usage() {
    picture 100 >a.ppm
    run corcast compare a.ppm
    expect_status 2
}

test_depth_planes_are_compared() {
    printf '1 1 -10 0 0 2 -1\n2 3 10 0 0 2 1\n' >thick.swc
    printf '1 1 -10 0 0 1.5 -1\n2 3 10 0 0 1.5 1\n' >thin.swc
    local tree
    for tree in thick thin; do
        run_ok corcast render --exact $tree.swc --size 40x40 --location 0,0,30 --look-at 0,0,0 --height 20 \
            --planes depth -o $tree.ppm
    done
    run_ok corcast compare thick.depth.pfm thick.depth.pfm
    run corcast compare thick.depth.pfm thin.depth.pfm
    expect_status 1
}

test_the_verdict_names_its_tier() {
    picture 100 >a.ppm
    picture 101 >b.ppm
    run corcast compare a.ppm b.ppm
    expect_stdout 'of the pixels are off by more than 0 levels'
    run_ok corcast compare a.ppm a.ppm --tier B
    expect_stdout '^agree \(tier B\): 0 of 20 pixels differ$'
    run_ok corcast compare a.ppm b.ppm --levels 1
    expect_stdout '^agree \(tier given\): 1 of 20'
}

# grey WIDTH HEIGHT LEVEL...: prints a grey PPM of code 100 whose first pixels have the given
# levels.
grey() {
    awk -v n=$(($1 * $2)) -v levels="${*:3}" 'BEGIN {
        split(levels, level); for (i = 1; i <= n; i++) { v = i in level ? level[i] : 100; print v, v, v } }' |
        cat <(printf 'P3 %d %d 255\n' "$1" "$2") - | pnmtopnm -plain
}

test_tier_a_spares_one_pixel_by_one_level_in_a_picture_that_is_not_tiny() {
    local case
    for case in 'a 40 25' 'one 40 25 101' 'down 40 25 99' 'two 40 25 101 101' 'far 40 25 102' 'tiny 37 26' 'tinier 37 26 101'; do
        set -- $case
        grey "${@:2}" >"$1.ppm"
    done
    run_ok corcast compare a.ppm one.ppm
    expect_stdout '^agree \(tier A\): 1 of 1000 pixels differ$'
    run_ok corcast compare a.ppm down.ppm
    for case in 'a two' 'a far' 'tiny tinier'; do
        set -- $case
        run corcast compare "$1.ppm" "$2.ppm"
        expect_status 1
    done
    for case in '--ppm 2' '--levels 0' '--tolerance own.ini'; do
        printf 'color_ppm = 2\n' >own.ini
        run corcast compare a.ppm one.ppm $case
        expect_status 1
    done
    oiiotool a.ppm -d uint16 -o a16.png
    oiiotool one.ppm -d uint16 -o one16.png
    run_ok corcast compare a16.png one16.png
    oiiotool one.ppm -d uint16 --addc 0.00002 -o off16.png
    run corcast compare a16.png off16.png
    expect_status 1
}

test_parts_and_layers_of_openexr_are_read_by_name() {
    picture 100 >a.ppm
    picture 155 >b.ppm
    oiiotool a.ppm -d float --attrib oiio:subimagename beauty -o a.exr
    oiiotool b.ppm -d float --attrib oiio:subimagename diffuse -o b.exr
    oiiotool a.exr b.exr --siappend -o parts.exr
    oiiotool b.exr --chnames diffuse.R,diffuse.G,diffuse.B a.exr --chappend -o layers.exr
    run_ok corcast compare a.exr parts.exr --layer beauty
    run corcast compare a.exr parts.exr
    expect_status 2
    expect_sentence "parts\.exr: has 2 parts, 'beauty', 'diffuse'; select one by its name"
    run corcast compare parts.exr layers.exr --layer diffuse
    expect_status 0
    run_ok corcast compare layers.exr a.exr
    run corcast compare layers.exr parts.exr --layer shadow
    expect_status 2
    expect_sentence "layers\.exr: has no layer 'shadow'"
    run corcast compare parts.exr parts.exr --layer shadow
    expect_sentence "parts\.exr: has 2 parts, 'beauty', 'diffuse'; none has the name or the layer 'shadow'"
    run corcast compare a.ppm b.ppm --layer beauty
    expect_sentence "a\.ppm: has no layer 'beauty': only OpenEXR files have layers"
}

test_files_of_unlike_depth_are_compared_at_the_depth_that_is_asked_for() {
    picture 100 >a.ppm
    oiiotool a.ppm -d uint16 --mulc 1.0009 -o b.png
    oiiotool a.ppm --iscolorspace sRGB --tocolorspace linear -d float -o c.exr
    run corcast compare a.ppm b.png
    expect_status 1
    run_ok corcast compare a.ppm b.png --bits 8
    run corcast compare a.ppm c.exr
    expect_status 2
    expect_sentence 'or use --bits to convert both to 8 or 16 bits'
    run_ok corcast compare a.ppm c.exr --bits 8
}

test_jpeg_and_webp_are_read_and_called_lossy() {
    run_ok corcast grow --terminals 12 --seed 3 -o tree.swc
    run_ok corcast render --exact tree.swc --size 87x65 -o a.png
    run_ok corcast convert a.png b.jpg --quality 91
    run corcast compare a.png b.jpg --tier none --json
    expect_status 0
    grep -q 'b\.jpg is lossy (JPEG)' stderr || fail "expected the loss to be said: $(cat stderr)"
    expect_json stdout '.max_abs > 2 and .psnr_db > 30'
    jpegtopnm -dct int b.jpg >b.ppm 2>said
    run_ok corcast compare b.ppm b.jpg
    oiiotool a.png -o c.webp
    run corcast compare a.png c.webp --tier none --json
    grep -q 'c\.webp is lossy (WebP)' stderr || fail "expected the loss to be said: $(cat stderr)"
    expect_json stdout '.psnr_db > 25'
    head -c 900 b.jpg >cut.jpg
    run corcast compare a.png cut.jpg
    expect_status 2
    expect_sentence 'cut\.jpg: is not a valid JPEG file'
    head -c 300 c.webp >cut.webp
    run corcast compare a.png cut.webp
    expect_status 2
    expect_sentence 'cut\.webp: is not a valid WebP file'
}

test_a_tolerance_file_sets_the_limits() {
    picture 100 >a.ppm
    picture 104 >b.ppm
    printf 'tier = mine\ncolor_levels = 3\ncolor_ppm = 60000\n' >mine.ini
    run_ok corcast compare a.ppm b.ppm --tolerance mine.ini
    expect_stdout '^agree \(tier mine\)'
    printf 'color_levels = 3\ncolor_ppm = 40000\n' >mine.ini
    run corcast compare a.ppm b.ppm --tolerance mine.ini
    expect_status 1
    printf 'color_level = 3\n' >mine.ini
    run corcast compare a.ppm b.ppm --tolerance mine.ini
    expect_status 2
    expect_sentence "mine\.ini:1: unknown limit 'color_level' in a tolerance file; it has region_pixels, "
}

test_metrics_are_printed_when_they_are_asked_for() {
    picture 100 >a.ppm
    picture 155 >b.ppm
    run corcast compare a.ppm b.ppm
    [ "$(wc -l <stdout)" -eq 1 ] || fail "expected one line, got $(cat stdout)"
    run corcast compare a.ppm b.ppm --metrics on
    expect_stdout 'FLIP, mean +0\.'
    expect_stdout 'CIEDE2000, largest +[1-9]'
    expect_stdout 'identical +19$'
}

test_pictures_of_the_difference_are_written() {
    picture 100 >a.ppm
    picture 104 >b.ppm
    run corcast compare a.ppm b.ppm -o heat.png --difference signed.png --flicker flicker.png
    expect_status 1
    [ "$(pngtopnm signed.png | tail -c 60 | od -An -tu1 -v | tr -s ' \n' '\n' | grep -c '^160$')" -eq 3 ] ||
        fail "expected one pixel of 128 + 8 * 4"
    [ "$(pngtopnm signed.png | tail -c 60 | od -An -tu1 -v | tr -s ' \n' '\n' | grep -c '^128$')" -eq 57 ] ||
        fail "expected the rest to be grey"
    grep -aq acTL flicker.png || fail "expected an animation"
    pngtopnm flicker.png >first.ppm
    cmp -s a.ppm first.ppm || fail "expected viewers without animation to show A"
}

test_junit_has_a_case_for_each_rule() {
    picture 100 >a.ppm
    picture 155 >b.ppm
    run corcast compare a.ppm b.ppm --tier B --junit out.xml
    expect_status 1
    [ "$(grep -c '<testcase ' out.xml)" -ge 4 ] || fail "expected a case for each rule"
    [ "$(grep -c '<failure ' out.xml)" -ge 2 ] || fail "expected several rules to be broken"
    # "edge pixels off by more than 2 levels" -> "75 % of the edge pixels are off by more than 2 levels (allowed: ..."
    awk -F '"' '/<testcase / { name = $4; sub(/pixels off/, "pixels are off", name) }
        /<failure / && index($2, name) == 0 { print name }' out.xml >strange
    [ ! -s strange ] || fail "expected each failure to say its own rule, not so: $(cat strange)"
    [ "$(grep -cE '<test(suite|case) .* time="[0-9.]*">' out.xml)" -ge 5 ] || fail "expected the time it took"
}

test_quiet_leaves_it_to_the_exit_status() {
    picture 100 >a.ppm
    picture 155 >b.ppm
    run corcast compare a.ppm b.ppm --quiet --metrics on
    expect_status 1
    [ ! -s stdout ] && [ ! -s stderr ] || fail "expected silence, got $(cat stdout stderr)"
    run corcast compare a.ppm b.ppm --quiet --json
    expect_json stdout '.verdict == "differ"'
}

test_help_says_what_the_tiers_are() {
    local tier
    run_ok corcast compare --help
    for tier in A B surface none; do
        expect_stdout "^  $tier +[a-z]+"
    done
    expect_stdout 'default: 2 in tier A'
}

# expect_cause SENTENCE: `compare a.png b.png` names this cause. Another program has made b.png.
expect_cause() {
    run corcast compare a.png b.png
    expect_status 1
    expect_stdout "^differ \(tier A\): (likely cause: )?$1"
}

test_the_cause_is_said_where_it_is_certain() {
    run_ok corcast grow --terminals 30 --seed 3 -o tree.swc
    run_ok corcast render --exact tree.swc --size 121x93 --background white -o a.png
    pngtopnm a.png >a.ppm
    pnmflip -lr a.ppm | pnmtopng >b.png
    expect_cause 'B is A mirrored left to right'
    pnmflip -tb a.ppm | pnmtopng >b.png
    expect_cause 'B is A flipped top to bottom'
    pnmflip -r180 a.ppm | pnmtopng >b.png
    expect_cause 'B is A rotated by 180 degrees'
    pamchannel -infile a.ppm -tupletype RGB 2 1 0 | pamtopnm | pnmtopng >b.png
    expect_cause 'B is A with red and blue exchanged'
    pnmcut -left 0 -top 2 -width 118 a.ppm | pnmpad -white -left 3 -bottom 2 | pnmtopng >b.png
    expect_cause 'B is A moved by \(3, -2\) pixels \(right and down are positive\)'
    oiiotool a.png --iscolorspace sRGB --tocolorspace linear --mulc 0.731 --tocolorspace sRGB -d uint8 -o b.png
    expect_cause 'B is A made darker: its linear colors are 0\.73[01][0-9]* times those of A'
    oiiotool a.png --iscolorspace sRGB --tocolorspace linear -d float -o a.exr
    oiiotool a.exr --mulc 0.731 -d float -o b.exr
    run corcast compare a.exr b.exr --html page.html
    expect_stdout 'likely cause: B is A made darker: its linear colors are 0\.731 times those of A; '
    grep -q 'Likely cause: B is A made darker' page.html || fail "expected the cause in the page"
    mkdir before && cp a.exr before/b.exr
    run corcast compare before/b.exr b.exr --html page.html
    grep -q '<h1>before/b.exr and b.exr ' page.html || fail "expected names that differ, got $(grep '<h1>' page.html)"
}

test_other_shades_within_the_same_outlines_are_told_from_other_shapes() {
    run_ok corcast grow --terminals 30 --seed 3 -o tree.swc
    sed 's/^phong = 0.32/phong = 0.39/' "$REPO/tests/golden/red.ini" >shiny.ini
    run_ok corcast render --exact tree.swc --size 121x93 --planes id --look "$REPO/tests/golden/red.ini" -o a.png
    run_ok corcast render --exact tree.swc --size 121x93 --planes id --look ./shiny.ini -o b.png
    expect_cause 'only highlights differ, by up to [0-9.]+ levels on [0-9.]+ % of the pixels \(B is brighter\); the outlines against the background are equal'
    run corcast compare a.png b.png --ids-a a.id.ppm --ids-b b.id.ppm
    expect_stdout 'the outlines of all segments are equal; '
    run corcast compare b.png a.png --json
    expect_json stdout '.cause | test("B is darker")'
    awk '/^#/ { print; next } $1 == 5 { $6 *= 1.3 } { print }' tree.swc >thick.swc
    run_ok corcast render --exact thick.swc --size 121x93 --look "$REPO/tests/golden/red.ini" -o b.png
    run corcast compare a.png b.png --json
    expect_json stdout '.verdict == "differ" and .cause == null'
    expect_cause 'cause unknown'
}

test_every_segment_has_its_line_in_the_ledger() {
    run_ok corcast grow --terminals 12 --seed 3 -o tree.swc
    run_ok corcast render --exact tree.swc --size 160x120 --planes id -o a.ppm
    awk '/^#/ { print; next } $1 == 5 { $6 *= 1.3 } { print }' tree.swc >thick.swc
    run_ok corcast render --exact thick.swc --size 160x120 --planes id --view front -o b.ppm
    run corcast compare a.ppm b.ppm --ids-a a.id.ppm --ids-b b.id.ppm --tier B --ledger ledger.csv --json
    expect_status 1
    head -1 ledger.csv | grep -q '^id,area_a,area_b,' || fail "expected a header"
    awk -F, '$1 == 5 && $7 > 0.15 { found = 1 } END { exit !found }' ledger.csv ||
        fail "expected segment 5's outline to have moved outwards: $(grep '^5,' ledger.csv)"
    expect_json stdout '.worst_segments[0].id == 5 and .tier == "B" and .segment_px > 0.15'
}

test_formats_of_every_kind_are_compared() {
    local f=$DATA/images
    printf 'P6\n7 5\n255\n' >a.ppm
    awk 'BEGIN { for (y = 0; y < 5; y++) for (x = 0; x < 7; x++) printf "%c%c%c", 1, 1, 1 }' >>a.ppm
    run corcast compare "$f/rgb8-lzw.tif" a.ppm
    expect_status 1
    run_ok corcast compare "$f/float-piz.exr" "$f/half-zip.exr"
    run_ok corcast compare "$f/float.tif" "$f/half-zip.exr"
    run_ok corcast compare "$f/rgb8-lzw.tif" "$f/rgb16-zip.tif"
    run corcast compare "$f/rgb8-lzw.tif" "$f/float.tif"
    expect_status 2
    expect_sentence 'rgb8-lzw\.tif holds integers and .*float\.tif floats'
    run corcast compare "$f/depth.exr" "$f/depth.exr"
    expect_status 1
    expect_stdout 'depth: values that are not a number: 2 pixels'
}

test_the_same_codes_under_another_gamma_are_another_picture() {
    local f=$DATA/images
    run_ok corcast compare "$f/gamma-0.45455.png" "$f/rgb8-lzw.tif"
    run_ok corcast compare "$f/gamma-1.png" "$f/gamma-1.png" -o heat.png
    run corcast compare "$f/gamma-1.png" "$f/rgb8-lzw.tif"
    expect_status 1
    run corcast compare "$f/gamma-1.png" "$f/gamma-0.5.png"
    expect_status 1
    run_ok corcast convert "$f/gamma-0.5.png" srgb.png
    run_ok corcast compare "$f/gamma-0.5.png" srgb.png --levels 0.51
}

test_convert_reads_the_floats_that_compare_reads() {
    local f=$DATA/images
    run_ok corcast convert "$f/half-zip.exr" half.pfm
    run_ok corcast compare "$f/half-zip.exr" half.pfm
    run_ok corcast convert "$f/float.tif" float.pfm
    expect_same half.pfm float.pfm
    run_ok corcast convert half.pfm half.exr
    run_ok corcast compare half.pfm half.exr
    run corcast convert "$f/half-zip.exr" half.png
    expect_status 2
    expect_sentence 'half-zip\.exr: holds floats; a picture of 8 or 16 bits is needed'
}

test_two_pictures_have_a_page() {
    picture 100 >'a"<b>.ppm'
    picture 155 >b.ppm
    run corcast compare 'a"<b>.ppm' b.ppm --html page.html
    expect_status 1
    grep -q '<h1>a&quot;&lt;b&gt;.ppm and b.ppm <span class="bad">differ</span></h1>' page.html ||
        fail "expected the names in the heading, got $(grep '<h1>' page.html)"
    [ "$(grep -o 'data:image/png;base64,' page.html | wc -l)" -ge 5 ] || fail "expected the pictures in the page"
    grep -q 'FLIP, mean</td><td class="number">0\.' page.html || fail "expected what was measured"
    ! grep -oE '(src|href)="?(https?:|//)' page.html || fail "expected no network"
    run_ok corcast compare "$DATA/images/half-zip.exr" "$DATA/images/float.tif" --html floats.html
    expect_file floats.html
    run corcast compare "$DATA/images/depth.exr" "$DATA/images/depth.exr" --kind depth --html depth.html
    expect_status 2
    expect_sentence '--html and --report need two pictures, not two depth planes'
}

test_a_page_states_the_date_of_SOURCE_DATE_EPOCH() {
    printf 'P3 1 1 255 1 2 3\n' >a.ppm
    run_ok env SOURCE_DATE_EPOCH=1764320461 "$CORCAST" compare a.ppm a.ppm --report page
    grep -q 'Compared on 2025-11-28 09:01 UTC by' page/report.html || fail "expected the date of 1764320461"
    cp page/report.html first.html
    run_ok env SOURCE_DATE_EPOCH=1764320461 "$CORCAST" compare a.ppm a.ppm --report page
    expect_same page/report.html first.html
    run env SOURCE_DATE_EPOCH=today "$CORCAST" compare a.ppm a.ppm
    expect_status 2
    expect_sentence "SOURCE_DATE_EPOCH is 'today'; it must be"
}

test_reports_of_compared_pictures_are_merged() {
    picture 100 >a.ppm
    picture 131 >b.ppm
    run corcast compare a.ppm b.ppm --report wrong
    expect_status 1
    run_ok corcast compare a.ppm a.ppm --report right
    expect_json wrong/report.json '.verdict == "differ" and .planes.color.max_abs == 31'
    run corcast report right wrong -o all.html
    expect_status 1
    grep -q 'a\.ppm and b\.ppm' all.html || fail "expected the case that differs"
    grep -q 'a\.ppm and a\.ppm' all.html || fail "expected the case that agrees"
}

test_noisy_pictures_are_tested_at_a_rate_of_false_alarms() {
    local i
    for i in 1 2 3 4 5; do
        oiiotool --create 64x48 3 --addc 0.4 --noise:type=gaussian:mean=0:stddev=0.03:seed=$i -d float -o r$i.exr
    done
    oiiotool r5.exr --mulc 1.012 -d float -o biased.exr
    run_ok corcast compare r4.exr r5.exr --noise r1.exr,r2.exr,r3.exr
    expect_stdout '^agree \(noise test, false alarm rate 0\.01\): '
    run corcast compare r4.exr biased.exr --noise r1.exr,r2.exr,r3.exr --json
    expect_status 1
    expect_json stdout '.verdict == "differ" and .gain > 1.006 and .gain < 1.018 and .alarm_rate == 0.01'
    oiiotool --create 64x48 3 --addc 0.0009 -d float -o v.exr
    run_ok corcast compare r4.exr r5.exr --variance v.exr --alarms 0.001
    run corcast compare r4.exr biased.exr --variance v.exr
    expect_status 1
    run corcast compare r4.exr r5.exr --alarms 0.001
    expect_status 2
    expect_sentence '--alarms needs --noise or --variance'
}

test_a_rendering_is_not_taken_for_a_variance() {
    local i name
    for i in 1 2 3 4 5; do
        oiiotool --create 64x48 3 --addc 0.4 --noise:type=gaussian:mean=0:stddev=0.03:seed=$i -d uint8 -o r$i.png
    done
    oiiotool r5.png --mulc 1.05 -d uint8 -o biased.png
    oiiotool r1.png -d float -o r1.exr
    for name in r1.png r1.exr r1.png, ,r1.png ''; do
        run corcast compare r4.png biased.png --noise "$name"
        expect_status 2
        expect_sentence '--noise is .* must name at least 2 more renderings'
    done
    run corcast compare r4.png biased.png --variance r1.png
    expect_status 2
    expect_sentence 'r1\.png: holds integers of 8 bits; --variance needs floats'
    run corcast compare r4.png biased.png --variance r1.exr --noise r1.png,r2.png
    expect_status 2
    expect_sentence '--variance and --noise both state the variance'
    run corcast compare r4.png biased.png --noise r1.png,r2.png,r3.png
    expect_status 1
    run_ok corcast compare r4.png r5.png --noise r1.png,r2.png,r3.png
}

test_sides_beyond_all_bounds_are_refused() {
    printf 'P6\n99999999 3\n255\nabc' >a.ppm
    run corcast compare a.ppm a.ppm
    expect_status 2
    expect_sentence 'a\.ppm: the width is "99999999"'
    printf 'P6\n1000000 1000000\n255\nabc' >a.ppm
    run corcast compare a.ppm a.ppm
    expect_status 2
    expect_sentence 'announces 3000000000000 bytes of pixels, but 3 follow'
}

# Makes two noisy pictures of 61 x 47 pixels, for which other programs have computed the measures.
noisy_pair() {
    awk 'BEGIN {
        print "P3 61 47 255" > "a.txt"; print "P3 61 47 255" > "b.txt"; v = 12345
        for (i = 0; i < 61 * 47 * 3; i++) {
            v = (v * 1103 + 12347) % 65536; a = 40 + int(v / 400); d = v % 29 == 0 ? v % 23 : 0
            print a > "a.txt"; print a + d > "b.txt"
        } }'
    pnmtopng a.txt >a.png 2>pnm.log || fail "pnmtopng: $(cat pnm.log)"
    pnmtopng b.txt >b.png 2>pnm.log
    run corcast compare a.png b.png --json
}

test_scikit_image_measures_the_same() {
    /usr/bin/python3 -c 'import skimage' 2>import.log || skip "python3-skimage is not installed"
    noisy_pair
    /usr/bin/python3 - >skimage.json <<'END' || fail "scikit-image failed: $(cat stderr)"
import json
import numpy as np
from skimage import color, io, metrics
a, b = io.imread('a.png'), io.imread('b.png')
luma = lambda p: ((p.astype(int) @ [19595, 38470, 7471] + 32768) >> 16).astype(np.uint8)
_, s = metrics.structural_similarity(luma(a), luma(b), gaussian_weights=True, sigma=1.5,
    use_sample_covariance=False, data_range=255, full=True)
de = color.deltaE_ciede2000(color.rgb2lab(a), color.rgb2lab(b))
print(json.dumps({'ssim': s[5:-5, 5:-5].mean(), 'psnr': metrics.peak_signal_noise_ratio(a, b),
    'rmse': metrics.mean_squared_error(a, b) ** 0.5, 'mean': de.mean(), 'max': de.max()}))
END
    jq -s '.[0] + {other: .[1]}' stdout skimage.json >both.json
    expect_json both.json '(.ssim - .other.ssim | fabs) < 1e-6'
    expect_json both.json '(.psnr_db - .other.psnr | fabs) < 1e-6'
    expect_json both.json '(.rmse - .other.rmse | fabs) < 1e-9'
    expect_json both.json '(.de2000_mean - .other.mean | fabs) < 1e-4'
    expect_json both.json '(.de2000_max - .other.max | fabs) < 1e-3'
}

test_pixelmatch_counts_as_the_package_of_that_name_transparent_pictures_too() {
    local pair threshold count
    npm_module pixelmatch
    run_ok node "$REPO/tests/oracle/pixelmatch_pairs.mjs" "$NPM_MODULES"
    while read -r pair threshold count; do
        corcast compare "$pair.a.png" "$pair.b.png" --pixelmatch "$threshold" --json
    done <expected >all.json 2>stderr
    jq .pixelmatch_pixels all.json | paste -d ' ' expected - | awk '$3 != $4' >other
    [ ! -s other ] || fail "expected pixelmatch's counts, got (pair, threshold, pixelmatch, corcast): $(head -3 other)"
    awk '$3 > 0 { found++ } END { exit found < 50 }' expected || fail "expected pictures that differ"
}

# The two pictures differ only in alpha: 0 and 255 at the eighth of 20 pixels.
test_pixelmatch_counts_alpha_in_folders_and_under_masks() {
    mkdir stored drawn
    printf 'P5\n5 4\n255\n%20s' | tr ' ' '\0' >clear.pgm
    { printf 'P5\n5 4\n255\n'; head -c 7 /dev/zero; printf '\377'; head -c 12 /dev/zero; } >dot.pgm
    printf 'P6\n5 4\n255\n%60s' | tr ' ' '\377' >white.ppm
    pnmtopng -alpha=clear.pgm white.ppm >stored/a.png 2>log
    pnmtopng -alpha=dot.pgm white.ppm >drawn/a.png 2>log
    run corcast compare stored/a.png drawn/a.png --pixelmatch 0.1 --json
    expect_json stdout '.pixelmatch_pixels == 1 and .differing_pixels == 0'
    run corcast compare --reference stored drawn --pixelmatch 0.1
    expect_status 1
    pnmtopng dot.pgm >stored/a.mask.png 2>log
    run_ok corcast compare --reference stored drawn --pixelmatch 0.1
}

# Slow: kinds of faults, two at once, in a part of the picture and in the colors too, in two pictures: a wrong cause fails.
test_no_cause_is_named_that_was_not_planted() {
    /usr/bin/python3 -c 'import scipy' 2>import.log || skip "python3-scipy is not installed"
    run_ok corcast render "$REPO/tests/golden/ball60.swc" --view iso --size 201x160 --antialias 2 --background black \
        --quiet -o black.ppm
    run_ok corcast render "$REPO/tests/golden/strangers.swc" --view iso --size 120x120 --quiet -o white.ppm
    run_ok /usr/bin/python3 "$REPO/tests/oracle/planted_causes.py" "$CORCAST" black.ppm white.ppm
    expect_stdout '^\| mirrored .* 2 \|  \|  \|$'
    expect_stdout '^\| gamma .* 4 \|'
    expect_stdout '^\| moved by whole pixels .* 4 \|'
    expect_stdout '^\| blurred \|  \|  \| 6 \|'
    expect_stdout '^96 kinds of faults, 23[0-9] pictures: 13[0-9] causes named rightly, 0 wrongly$'
    expect_stdout '^\| JPEG \| 6 \|'
}

test_idiff_measures_the_same() {
    command -v idiff >idiff.path || skip "openimageio-tools is not installed"
    noisy_pair
    idiff -fail 0 a.png b.png >idiff.txt
    awk '/Mean error/ { mean = $4 } /RMS error/ { rms = $4 } /Peak SNR/ { psnr = $4 }
        END { printf "{\"mean\": %s, \"rms\": %s, \"psnr\": %s}\n", mean, rms, psnr }' idiff.txt >idiff.json
    jq -s '.[0] + {other: .[1]}' stdout idiff.json >both.json
    expect_json both.json '(.mean_abs / 255 / .other.mean - 1 | fabs) < 1e-5'
    expect_json both.json '(.rmse / 255 / .other.rms - 1 | fabs) < 1e-5'
    expect_json both.json '(.psnr_db / .other.psnr - 1 | fabs) < 1e-5'
}

test_names_that_are_not_utf8_are_shown_with_replacement_characters() {
    local name file
    name=$(printf 'jos\351.ppm')
    printf 'P6 2 1 255 abcdef' >"$name"
    printf 'P6 2 1 255 abcdeg' >b.ppm
    run corcast compare "$name" b.ppm --junit o.xml --html o.html --json
    expect_status 1
    for file in o.xml o.html stdout; do
        iconv -f UTF-8 -t UTF-8 $file >copy || fail "expected $file to be UTF-8"
    done
    grep -q "$(printf 'jos\357\277\275.ppm')" o.xml || fail "expected a replacement character: $(cat o.xml)"
}

run_tests "$@"
