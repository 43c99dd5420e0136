#!/usr/bin/env bash
# `render` and the image formats. netpbm, which shares no code with corcast, reads the pictures.
. "$(dirname "$0")/../lib.sh"

MODELS=$(corcast models | cut -f 1)

# colors FILE.ppm: prints the number of different colors.
colors() {
    pnmtoplainpnm "$1" 2>/dev/null | tail -n +4 | tr -s ' \n' '\n' | grep -v '^$' | paste - - - | sort -u | wc -l
}

# pixels FILE: prints the pixels of a PPM, PNG or TIFF, decoded by netpbm, without comments.
pixels() {
    case $1 in
    *.png) pngtopnm "$1" ;;
    *.tif) tifftopnm "$1" 2>/dev/null ;;
    *) cat "$1" ;;
    esac | pnmtoplainpnm
}

colors_of_png() {
    pngtopnm "$1" >colors.ppm
    colors colors.ppm
}

expect_same_pixels() {
    pixels "$1" >"$1.pixels"
    pixels "$2" >"$2.pixels"
    expect_same "$1.pixels" "$2.pixels"
}

test_every_model_gives_a_picture_of_the_size_asked_for() {
    local model
    grow_tree 20
    for model in $MODELS; do
        run_ok corcast render --exact tree.swc --model $model --size 83x41 -o $model.ppm
        pnmfile $model.ppm | grep -q 'PPM raw, 83 by 41  maxval 255' ||
            fail "expected a P6 of 83 x 41, got $(pnmfile $model.ppm)"
        [ "$(colors $model.ppm)" -gt 20 ] || fail "expected a shaded picture of $model"
    done
}

test_the_number_of_threads_does_not_change_the_picture() {
    local model threads
    grow_tree 60
    for model in $MODELS; do
        run_ok corcast render --exact tree.swc --model $model --size 150x90 --threads 1 -o picture.ppm
        mv picture.ppm one.ppm
        for threads in 2 5; do
            run_ok corcast render --exact tree.swc --model $model --size 150x90 --threads $threads -o picture.ppm
            expect_same one.ppm picture.ppm
        done
    done
}

test_png_and_ppm_hold_the_same_pixels() {
    grow_tree 20
    run_ok corcast render --exact tree.swc --size 60x45 -o picture.ppm
    run_ok corcast render --exact tree.swc --size 60x45 -o picture.png
    expect_same_pixels picture.ppm picture.png
}

test_a_png_says_where_it_comes_from_and_neither_when_nor_where() {
    grow_tree 5
    run_ok corcast render --exact tree.swc --size 30x30 -o picture.png
    LC_ALL=C grep -qa 'tEXt' picture.png || fail "expected provenance in a tEXt chunk"
    LC_ALL=C grep -qa 'sRGB' picture.png || fail "expected an sRGB chunk"
    LC_ALL=C grep -qa 'corcast' picture.png || fail "expected the program's name"
    ! LC_ALL=C grep -qa -e 'tIME' -e "$PWD" picture.png || fail "expected neither a date nor a path"
    mkdir elsewhere
    run_ok corcast render --exact tree.swc --size 30x30 -o elsewhere/picture.png
    expect_same picture.png elsewhere/picture.png
}

test_the_planes_stand_beside_the_picture() {
    grow_tree 20
    run_ok corcast render --exact tree.swc --size 50x30 --planes color,depth,normal,id -o picture.png
    expect_only tree.swc picture.png picture.{color,depth,normal}.pfm picture.id.ppm
    [ "$(head -c 8 picture.depth.pfm | head -1)" = Pf ] || fail "expected a grey PFM"
    [ "$(head -c 8 picture.normal.pfm | head -1)" = PF ] || fail "expected a color PFM"
    [ "$(sed -n 2p picture.depth.pfm | head -c 5)" = "50 30" ] || fail "expected 50 30 in the PFM"
    pfmtopam picture.normal.pfm >normal.pam 2>stderr || fail "expected netpbm to read the PFM$(said)"
    pnmfile picture.id.ppm | grep -q 'PPM raw, 50 by 30  maxval 255' || fail "expected a P6 of ids"
}

# Every id in the plane belongs to a segment, and most segments of a small tree are visible.
test_the_id_plane_holds_ids_of_segments() {
    local model
    grow_tree 12
    grep -v '^#' tree.swc | awk '$7 != -1 { print $1 }' | sort >segments
    for model in $MODELS; do
        run_ok corcast render --exact tree.swc --model $model --size 200x200 --planes id -o picture.ppm
        pnmtoplainpnm picture.id.ppm | tail -n +4 | tr -s ' \n' '\n' | grep -v '^$' | paste - - - |
            awk '{ id = $1 * 65536 + $2 * 256 + $3 } id { print id }' | sort -u >seen
        [ -z "$(comm -13 segments seen)" ] || fail "ids that are no segment: $(comm -13 segments seen | tr '\n' ' ')"
        [ "$(wc -l <seen)" -ge 18 ] || fail "expected at least 18 of 23 segments to be seen, got $(wc -l <seen)"
    done
}

# One tube along x, seen from the front: its depth in the middle row is location z minus radius.
test_ids_that_an_id_plane_cannot_hold_are_refused_for_it_alone() {
    sed 's/^4 /16777216 /' "$DATA/bifurcation.swc" >tree.swc
    for command in "render --planes id -o tree.png" "verify -o report"; do
        # shellcheck disable=SC2086
        run corcast $command tree.swc --size 40x30
        expect_status 2
        expect_sentence 'tree.swc: the id 16777216 is too large for an id plane \(maximum 16777215\)'
    done
    expect_only tree.swc
    run_ok corcast render tree.swc --planes depth --size 40x30 -o tree.png
    corcast scene tree.swc -o tree.pov 2>said || fail "expected a scene"
    grep -q 'the id 16777216 is too large for an id plane' said || fail "expected it to be said of the scene"
}

test_depth_and_normal_of_one_tube_are_what_geometry_says() {
    local model how
    printf '1 1 -10 0 0 2 -1\n2 3 10 0 0 2 1\n' >tube.swc
    for model in $MODELS; do
        [ $model = mesh ] && how='--mesh-tolerance 0.002' || how=''
        run_ok corcast render --exact tube.swc --model $model $how --size 11x11 --location 0,0,30 --look-at 0,0,0 \
            --height 11 --planes depth,normal -o picture.ppm
        pfm_value picture.depth.pfm 60 1 >value
        awk '{ exit !($1 > 27.998 && $1 < 28.002) }' value ||
            fail "expected depth 28 at the centre of $model, got $(cat value)"
        pfm_value picture.depth.pfm 5 1 >value
        grep -qi inf value || fail "expected inf below the tube, got $(cat value)"
        pfm_value picture.normal.pfm 60 3 >value
        awk '{ exit !($1 * $1 < 1e-5 && $2 * $2 < 1e-5 && $3 > 0.9999) }' value ||
            fail "expected the normal 0 0 1 at the centre of $model, got $(cat value)"
    done
}

# pfm_value FILE PIXEL CHANNELS: prints the floats of a pixel, counted in file order.
pfm_value() {
    local size
    size=$(stat -c %s "$1")
    tail -c $((121 * $3 * 4)) "$1" | od -A n -t f4 -w$(($3 * 4)) -v | sed -n "$(($2 + 1))p"
    [ "$size" -gt 0 ]
}

test_a_picture_goes_to_standard_output() {
    grow_tree 8
    run_ok corcast render --exact tree.swc --size 40x30 -o picture.ppm
    run_ok corcast render --exact tree.swc --size 40x30 -o -
    expect_same_pixels stdout picture.ppm
}

test_a_tree_comes_from_standard_input() {
    grow_tree 8
    run_ok corcast render --exact tree.swc --size 40x30 -o from_file.ppm
    corcast render --exact - --size 40x30 -o from_pipe.ppm <tree.swc 2>stderr || fail "render - failed$(said)"
    expect_same_pixels from_file.ppm from_pipe.ppm
}

test_convert_changes_the_format_and_not_the_pixels() {
    grow_tree 8
    run_ok corcast render --exact tree.swc --size 40x30 -o picture.ppm
    run_ok corcast convert picture.ppm picture.png
    run_ok corcast convert picture.png again.ppm
    expect_same_pixels picture.ppm again.ppm
}

test_antialiasing_gives_colors_in_between() {
    grow_tree 20
    run_ok corcast render --exact tree.swc --size 80x80 -o sharp.ppm
    run_ok corcast render --exact tree.swc --size 80x80 --antialias 3 -o smooth.ppm
    [ "$(colors smooth.ppm)" -gt "$(colors sharp.ppm)" ] || fail "expected more colors with antialiasing"
}

test_perspective_and_shadows_change_the_picture() {
    run_ok corcast grow --terminals 40 --domain ball:20 -o tree.swc
    run_ok corcast render --exact tree.swc --look "$REPO/tests/golden/red.ini" --size 80x80 -o flat.ppm
    run_ok corcast render --exact tree.swc --look "$REPO/tests/golden/red.ini" --size 80x80 --shadows on -o shadows.ppm
    run_ok corcast render --exact tree.swc --look "$REPO/tests/golden/red.ini" --size 80x80 --projection perspective -o perspective.ppm
    expect_differing 118 118 flat.ppm shadows.ppm
    expect_differing 954 954 flat.ppm perspective.ppm
}

test_pruning_drops_thin_segments_from_the_picture() {
    grow_tree 60
    run_ok corcast render --exact tree.swc --size 200x200 --planes id -o all.ppm
    run_ok corcast render --exact tree.swc --size 200x200 --planes id --prune-radius 1 -o thick.ppm
    [ "$(colors thick.id.ppm)" -lt "$(colors all.id.ppm)" ] || fail "expected fewer segments"
}

test_fields_color_the_segments() {
    local field
    grow_tree 30
    run_ok corcast render --exact tree.swc --size 80x80 --look data -o plain.ppm
    for field in radius flow velocity pressure wss reynolds level strahler branch; do
        run_ok corcast render --exact tree.swc --size 80x80 --color-by $field -o $field.ppm
        expect_differing 293 293 plain.ppm $field.ppm
    done
    run_ok corcast render --exact tree.swc --size 80x80 --color-by radius --log --range 0.5,3 --colormap magma \
        -o log.ppm
    run corcast render tree.swc --size 80x80 --color-by loudness -o no.ppm
    expect_status 2
    expect_sentence 'loudness'
}

test_a_field_is_named_in_capitals_too() {
    grow_tree 5
    run_ok corcast render --exact tree.swc --size 40x40 --color-by wss -o small.ppm
    run_ok corcast render --exact tree.swc --size 40x40 --color-by WSS -o capital.ppm
    expect_same small.ppm capital.ppm
}

test_a_field_that_needs_flow_is_refused_where_nothing_is_known_of_it() {
    printf '1 1 0 0 0 1 -1\n2 3 3 0 0 1 1\n' >tree.swc
    run corcast render tree.swc --size 20x20 --color-by flow -o picture.ppm
    expect_status 2
    expect_sentence 'q[-_]perf'
    run_ok corcast render --exact tree.swc --size 20x20 --color-by flow --q-perf 312.5 -o picture.ppm
}

test_the_background_is_the_color_asked_for() {
    grow_tree 5
    run_ok corcast render --exact tree.swc --size 40x40 --background 0,0,0 -o black.ppm
    [ "$(tail -c 3 black.ppm | od -A n -t u1 | tr -s ' ')" = " 0 0 0" ] ||
        fail "expected a black corner, got $(tail -c 3 black.ppm | od -A n -t u1)"
}

test_the_report_says_what_drew_the_picture() {
    grow_tree 7
    local engine options
    while read -r engine options; do
        run_ok corcast render tree.swc $options --size 21x17 --json report.json -o picture.ppm
        expect_json report.json ".engine == \"$engine\""
    done <<'END'
raster --model rounded --shadows on
raster --model cylinders --method fastest
raster --model joined --method raster --shadows on
trace --model rounded --method trace
trace --model rounded --exact --shadows on
raster --model rounded --ao 2
raster --model joined --look print --shadows on
trace --model rounded --method trace --ao 2
zbuffer --model rounded --method zbuffer
field --model blob --shadows on
field --model blob --method raster
trace --model blob --exact
field --model isosurface
trace --model isosurface --hits povray
END
}

test_places_without_joints_are_counted_and_said() {
    run_ok corcast grow --terminals 600 --seed 3 --lambda 0 -o tree.swc
    run_ok corcast render --exact tree.swc --model joined --size 60x60 --json report.json -o picture.png
    expect_sentence '[0-9]+ joints could not be built because vessels are too short, [0-9]+ because vessels turn too sharply; they are replaced by spheres'
    expect_json report.json '.joints > 1000 and .places_short > 0 and .places_sharp > 0'
    expect_json report.json '.joints == 1198 - 2 * (.places_short + .places_sharp)'
    run_ok corcast render --exact tree.swc --model joined --joints paper --size 60x60 --json report.json -o paper.png
    expect_sentence 'built nevertheless'
    expect_json report.json '.joints == 1198'
    expect_differing 18 18 picture.png paper.png
    run corcast render tree.swc --model rounded --joints paper -o picture.png
    expect_status 2
    expect_sentence '--joints is for --model joined'
}

test_ambient_occlusion_darkens_every_model_alike_for_any_number_of_threads() {
    local model threads
    run_ok corcast grow --terminals 40 --domain ball:20 -o tree.swc
    for model in $MODELS; do
        run_ok corcast render --exact tree.swc --model $model --look print --size 90x70 --antialias 2 -o none.ppm
        for threads in 1 3; do
            run_ok corcast render --exact tree.swc --model $model --look print --size 90x70 --ao 9 --antialias 2 \
                --threads $threads -o ao$threads.ppm
        done
        expect_same ao1.ppm ao3.ppm
        [ "$(brightness ao1.ppm)" -lt "$(brightness none.ppm)" ] || fail "expected a darker picture of $model"
    done
}

# brightness FILE.ppm: prints the sum of all codes.
brightness() {
    pnmtoplainpnm "$1" | tail -n +4 | awk '{ for (i = 1; i <= NF; i++) sum += $i } END { print sum }'
}

test_smooth_vessels_are_curves_whose_distance_is_said() {
    local model
    grow_tree 20
    for model in $MODELS; do
        run_ok corcast render tree.swc --model $model --size 83x61 -o straight.png --json straight.json
        run_ok corcast render tree.swc --model $model --size 83x61 --smooth off -o off.png
        run_ok corcast render tree.swc --model $model --size 83x61 --smooth --planes id -o smooth.png \
            --json smooth.json
        grep -qE 'smooth: 39 segments are drawn as [0-9]+ pieces, at most [0-9.]+ mm \([0-9.]+ radii\) from' stderr ||
            fail "expected the distance from the straight segments of $model"
        expect_same_pixels straight.png off.png
        expect_json straight.json '.smooth == null'
        expect_json smooth.json '.smooth.segments == 39 and .smooth.pieces > 200 and .smooth.distance_mm > 0.1'
        cmp -s straight.png smooth.png && fail "expected another picture of $model"
    done
    run_ok corcast render tree.swc --size 83x61 --smooth --threads 1 -o one.png
    run_ok corcast render tree.swc --size 83x61 --smooth --threads 5 -o five.png
    expect_same_pixels one.png five.png
}

# The notes of --model joined about nodes without a joint. odd_trees_test.sh draws such trees with
# every model.
test_places_of_odd_trees_that_have_no_joints_are_counted() {
    run_ok corcast render --exact "$DATA/star.swc" --model joined --size 100x100 --json report.json -o picture.png
    expect_json report.json '.places_short + .places_sharp == 1'
    run_ok corcast render --exact "$DATA/collinear.swc" --model joined --size 80x100 --json report.json -o picture.png
    expect_json report.json '.joints == 0'
    run_ok corcast render --exact "$DATA/stout.swc" --model joined --size 80x100 --json report.json -o picture.png
    expect_json report.json '.joints == 1 and .places_short == 19'
}

test_a_picture_beyond_the_disk_is_refused_and_the_old_one_stays() {
    grow_tree 3
    echo precious >picture.ppm
    cp picture.ppm before
    run corcast render tree.swc --size 1000000x1000000 -o picture.ppm
    expect_status 3
    expect_sentence 'picture\.ppm: needs at least 3\.0 TB, and its disk has [0-9.]+ .?B left'
    expect_same picture.ppm before
    expect_only before picture.ppm tree.swc
}

# The disk has 1 MB. The picture cannot fit even with the best compression.
test_a_compressed_picture_beyond_the_disk_is_refused_before_it_is_drawn() {
    local extension
    grow_tree 3
    mkdir disk
    unshare -rm mount -t tmpfs -o size=1m tmpfs disk 2>/dev/null || skip "no disk of 1 MB can be made here"
    for extension in png tif exr; do
        run unshare -rm sh -c 'mount -t tmpfs -o size=1m tmpfs disk && "$@"' - \
            "$CORCAST" render tree.swc --size 100000x100000 -o disk/picture.$extension
        expect_status 3
        expect_sentence "picture\.$extension: needs at least [0-9.]+ MB, and its disk has 1\.[0-9]+ MB left"
    done
}

# If pixels share light, a band cannot have fewer rows than a block, even if --memory is too small.
test_a_band_beyond_memory_is_refused() {
    grow_tree 3
    run corcast render tree.swc --size 1000000x1000000 --ao 4 --memory 1e9 -o picture.png
    expect_status 3
    expect_sentence "out of memory"
    expect_only tree.swc
}

test_bands_give_the_bytes_of_the_whole() {
    local model extension
    grow_tree 60
    for model in $MODELS; do
        for extension in ppm png pfm tif; do
            run_ok corcast render --exact tree.swc --model $model --size 90x70 --antialias 2 --antialias-threshold 0.05 \
                --planes color,depth,normal,id --memory 1000 -o picture.$extension
            for file in picture.*; do mv "$file" "whole.${file#picture.}"; done
            run_ok corcast render --exact tree.swc --model $model --size 90x70 --antialias 2 --antialias-threshold 0.05 \
                --planes color,depth,normal,id --memory 0.001 -o picture.$extension
            for file in picture.*; do
                case $file in
                *.png | *.tif) expect_same_pixels "$file" "whole.${file#picture.}" ;;
                *) expect_same "$file" "whole.${file#picture.}" ;;
                esac
            done
            rm -f picture.* whole.*
        done
    done
}

# The floats of the whole picture would take 192 MB.
test_a_large_picture_needs_the_memory_of_a_band() {
    grow_tree 60
    (ulimit -v 150000 && "$CORCAST" render --exact tree.swc --size 4000x4000 --memory 20 --quiet \
        -o picture.ppm) 2>stderr ||
        fail "expected 16 megapixels in 150 MB of addresses$(said)"
    pnmfile picture.ppm | grep -q 'PPM raw, 4000 by 4000' || fail "expected 4000 x 4000, got $(pnmfile picture.ppm)"
    run_ok corcast render --exact tree.swc --size 4000x4000 --memory 1000 -o whole.ppm
    expect_same picture.ppm whole.ppm
}

test_a_side_beyond_the_largest_picture_is_refused() {
    grow_tree 3
    run corcast render tree.swc --size 99999999999x10 -o picture.ppm
    expect_status 2
    expect_sentence "size.*99999999999x10"
}

test_an_extension_that_is_no_picture_is_refused() {
    grow_tree 3
    run corcast render tree.swc --size 10x10 -o picture.gif
    expect_status 2
    expect_sentence "picture\.gif|gif"
    expect_only tree.swc
}

test_a_picture_on_a_full_disk_is_refused() {
    [ -w /dev/full ] || skip "there is no /dev/full"
    grow_tree 3
    ln -s /dev/full full.ppm
    run corcast render tree.swc --size 200x200 -o full.ppm
    expect_status 3
    expect_sentence "full"
}

test_a_truncated_picture_is_refused() {
    printf 'P6\n4 3\n255\nabc' >short.ppm
    run corcast convert short.ppm out.png
    expect_status 2
    expect_sentence "short\.ppm"
    grow_tree 3
    run_ok corcast render --exact tree.swc --size 40x40 -o picture.png
    head -c 150 picture.png >short.png
    run corcast convert short.png out.ppm
    expect_status 2
    expect_sentence "short\.png"
    [ ! -e out.png ] && [ ! -e out.ppm ] || fail "expected no output"
}

# rows ROW ...: writes tree.swc with the SWC rows.
rows() {
    printf '%s\n' "$@" >tree.swc
}

test_adaptive_antialiasing_needs_antialiasing() {
    grow_tree 20
    run corcast render tree.swc --exact --antialias-threshold 0.1 -o picture.ppm
    expect_status 2
    expect_sentence 'antialias-threshold needs --antialias N'
    run_ok corcast render --exact tree.swc --model isosurface --size 90x60 --antialias 3 -o all.ppm
    run_ok corcast render --exact tree.swc --model isosurface --size 90x60 --antialias 3 --antialias-threshold 0.02 -o edges.ppm
    run_ok corcast render --exact tree.swc --model isosurface --size 90x60 -o none.ppm
    expect_differing 30 45 all.ppm edges.ppm
    expect_differing 320 345 edges.ppm none.ppm
}

# The floor: because of single precision, at most one or two of 160,000 pixels differ.
test_tiles_agree_with_rays_to_tier_b_and_to_the_measured_floor() {
    local model projection tree method
    for tree in disc200 disc200-lambda0 ball60; do
        for model in $(corcast models --of primitives | cut -f 1) blob; do
            for projection in orthographic perspective; do
                for method in trace raster; do
                    run_ok corcast render "$REPO/tests/golden/$tree.swc" --look "$REPO/tests/golden/red.ini" --model $model --projection $projection \
                        --view iso --shadows on --antialias 2 --size 400x400 --method $method \
                        --planes color,depth,normal,id -o $method.png
                done
                run_ok corcast compare trace.png raster.png --ids-a trace.id.ppm --ids-b raster.id.ppm --tier B --json
                expect_json stdout '.differing_pixels <= 6'
                run_ok corcast compare trace.depth.pfm raster.depth.pfm --depth-mm 0.0001
                run_ok corcast compare trace.normal.pfm raster.normal.pfm --tier B
            done
        done
    done
}

# shows FILE.pfm: prints the first and last column and row with a finite depth, in a plane of 60 x
# 50 pixels.
shows() {
    tail -c 12000 "$1" | od -A n -t f4 -w240 -v | awk '{ for (i = 1; i <= NF; i++) if ($i != "inf") {
        if (!some++ || i < low) low = i; if (i > high) high = i; if (!first) first = NR; last = NR } }
        END { print low, high, first, last }'
}

test_pictures_of_all_models_lie_on_each_other() {
    local model
    cp "$DATA/bifurcation.swc" tree.swc
    run_ok corcast render tree.swc --exact --model rounded --size 60x50 --margin 0 --planes depth -o p.ppm
    shows p.depth.pfm >rounded
    [ "$(cut -d ' ' -f 3,4 rounded)" = "1 50" ] || fail "expected a framed tree, got $(cat rounded)"
    for model in $MODELS; do
        run_ok corcast render tree.swc --exact --model $model --size 60x50 --margin 0 --planes depth -o p.ppm
        paste -d ' ' rounded <(shows p.depth.pfm) |
            awk '{ for (i = 1; i <= 4; i++) if (($i - $(i + 4)) ^ 2 > 9) exit 1 }' ||
            fail "expected $model at $(cat rounded), got $(shows p.depth.pfm)"
    done
    run_ok corcast render tree.swc --exact --model isosurface --frame drawing --size 60x50 --margin 0 --planes depth -o p.ppm
    shows p.depth.pfm | awk '{ exit !($3 > 2 && $4 < 49) }' || fail "expected a smaller tree, got $(shows p.depth.pfm)"
}

test_the_domain_is_framed_where_the_tree_tells_it() {
    run_ok corcast grow --terminals 20 --domain box:80,40,30 --inlet 0,20,15 -o tree.swc
    run_ok corcast render tree.swc --exact --frame domain --size 80x40 --margin 0 -o domain.ppm
    run_ok corcast render tree.swc --exact --location 0,0,200 --look-at 0,0,0 --height 40 --size 80x40 -o same.ppm
    expect_same domain.ppm same.ppm
    run corcast render "$DATA/coronary.swc" --frame domain -o no.ppm
    expect_status 2
    expect_sentence 'coronary\.swc: --frame domain: the tree does not state the domain'
    [ ! -e no.ppm ] || fail "expected no picture"
}

test_views_and_turns_are_one_camera() {
    local same
    cp "$DATA/coronary.swc" tree.swc
    while IFS='|' read -r one same; do
        run_ok corcast render tree.swc --exact --size 60x50 $one -o one.ppm
        run_ok corcast render tree.swc --exact --size 60x50 $same -o same.ppm
        run_ok corcast compare one.ppm same.ppm
    done <<'END'
--view right|--turn 90
--view back|--turn 180,0
--view bottom|--turn 0,-90
--view iso|--turn 45,35.264389682754654
--view top --turn 90|--turn 90,90
--up-axis z|--view bottom --turn 180 --up 0,0,1
--up-axis z --view right|--view right --up 0,0,1
END
}

test_cameras_that_fight_are_refused() {
    local options sentence
    cp "$DATA/bifurcation.swc" tree.swc
    while IFS='|' read -r options sentence; do
        run corcast render tree.swc $options -o p.ppm
        expect_status 2
        expect_sentence "$sentence"
        expect_only tree.swc
    done <<'END'
--turn 30 --location 0,0,50|--turn and --location exclude each other
--view left --location 0,0,50|--view and --location exclude each other
--turn 30,20,10|--turn takes AZ,EL or AZ in degrees, such as 30,15
--turn 30,x|--turn: '30,x' is not a list of numbers
--view under|--view: 'under' is not one of front, back, left, right, top, bottom, iso
--frame picture|--frame: 'picture' is not one of tree, domain, drawing
--up-axis x|--up-axis: 'x' is not one of y, z
END
}

test_pictures_are_by_default_antialiased_and_within_tier_b_of_exact_ones() {
    local model tree=$REPO/tests/golden/ball60.swc
    for model in $MODELS; do
        run_ok corcast render "$tree" --look "$REPO/tests/golden/red.ini" --model $model --view iso --shadows on --size 240x180 --planes id -o plain.png
        run_ok corcast render "$tree" --look "$REPO/tests/golden/red.ini" --model $model --view iso --shadows on --size 240x180 --planes id \
            --exact --antialias 3 -o exact.png
        run_ok corcast compare exact.png plain.png --ids-a exact.id.ppm --ids-b plain.id.ppm --tier B
    done
}

test_an_exact_picture_has_one_ray_a_pixel_unless_more_are_asked_for() {
    grow_tree 20
    run_ok corcast render tree.swc --size 80x60 --exact -o exact.ppm
    run_ok corcast render tree.swc --size 80x60 --method trace --antialias 1 -o one.ppm
    expect_same exact.ppm one.ppm
    run_ok corcast render tree.swc --size 80x60 --exact --antialias 3 -o smooth.ppm
    run_ok corcast render tree.swc --size 80x60 --method trace -o traced.ppm
    expect_same smooth.ppm traced.ppm
    run corcast render tree.swc --size 80x60 --exact --method raster -o raster.ppm
    expect_status 2
    expect_sentence '--exact uses --method trace; do not give --method raster'
}

test_a_picture_wider_than_tiles_go_is_traced() {
    grow_tree 3
    run_ok corcast render tree.swc --antialias 1 --size 524296x1 --json report.json -o picture.ppm
    expect_json report.json '.engine == "trace"'
    run corcast render tree.swc --antialias 1 --size 524296x1 --method raster -o raster.ppm
    expect_status 2
    expect_sentence 'draws pictures of up to 524280 pixels a side'
}

test_joints_to_the_letter_are_the_same_by_every_method() {
    local method
    for method in trace raster; do
        run_ok corcast render --antialias 1 "$REPO/tests/golden/disc200-lambda0.swc" --model joined --joints paper --size 500x500 \
            --method $method -o $method.ppm
    done
    run_ok corcast compare trace.ppm raster.ppm --json --tier none
    expect_json stdout '.differing_pixels <= 6'
}

test_methods_say_what_they_do_not_draw() {
    grow_tree 20
    run corcast render tree.swc --method raster --model isosurface -o picture.ppm
    expect_status 2
    expect_sentence 'raster needs cylinders, joined, rounded and blob, not isosurface'
    run corcast render tree.swc --method zbuffer --model blob -o picture.ppm
    expect_status 2
    expect_sentence 'zbuffer needs cylinders, joined and rounded, not blob'
    run corcast render tree.swc --method zbuffer --shadows on -o picture.ppm
    expect_status 2
    expect_sentence 'zbuffer draws no shadows, no antialiased pictures'
    run corcast render tree.swc --method zbuffer --antialias 2 -o picture.ppm
    expect_status 2
    run corcast render tree.swc --method zbuffer --ao 8 -o picture.ppm
    expect_status 2
    run_ok corcast render tree.swc --method zbuffer --size 90x60 -o picture.ppm
    [ "$(colors picture.ppm)" -gt 20 ] || fail "expected a shaded picture"
}

test_the_potential_of_the_graph_keeps_strangers_apart() {
    rows '1 3 -9 1.1 0 1 -1' '2 3 9 1.1 0 1 1' '3 3 -9 -1.1 0 1 -1' '4 3 9 -1.1 0 1 3'
    run_ok corcast render --exact tree.swc --look "$REPO/tests/golden/red.ini" --model isosurface --size 90x60 -o paper.ppm
    run_ok corcast render --exact tree.swc --look "$REPO/tests/golden/red.ini" --model isosurface --size 90x60 --potential graph -o graph.ppm
    expect_differing 420 440 paper.ppm graph.ppm
    run_ok corcast scene tree.swc --model isosurface --potential graph --color-by radius --ids on -o tree.pov
    grep -qF 'Fn_Max(Fm[0](x,y,z),Fm[1](x,y,z))' tree.inc || fail "expected the larger of two potentials in a cell"
    run corcast render tree.swc --model rounded --potential graph -o picture.ppm
    expect_status 2
    expect_sentence 'potential is for --model isosurface'
}

test_segments_that_vanish_are_counted() {
    rows '1 3 0 0 0 1 -1' '2 3 0.1 0 0 1 1' '3 3 50 0 0 1 -1' '4 3 60 0 0 1 3' '5 3 60 9 0 0.05 4'
    run_ok corcast render --exact tree.swc --model isosurface --size 20x20 --prune-radius 0.06 -o picture.ppm
    grep -q '1 of 3 segments are pruned' stderr || fail "expected the number of pruned segments$(said)"
    grep -q '1 of 2 segments are too short for their radius' stderr || fail "expected the number that vanish$(said)"
    run_ok corcast render --exact tree.swc --model isosurface --size 20x20 --quiet -o picture.ppm
    [ ! -s stderr ] || fail "expected silence$(said)"
    run corcast render tree.swc --prune-radius 1.25 -o none.ppm
    expect_status 2
    expect_sentence 'tree\.swc: all 3 segments are thinner than --prune-radius 1\.25'
}

test_vessels_thinner_than_a_pixel_are_drawn_by_their_area() {
    run_ok corcast grow --terminals 700 --seed 5 -o tree.swc
    run_ok corcast render tree.swc --size 90x90 --planes id --quiet -o covered.pfm
    run_ok corcast render tree.swc --size 90x90 --planes id --method trace --quiet -o sampled.pfm
    run_ok corcast render tree.swc --size 1440x1440 --method raster --quiet -o fine.pfm
    cmp covered.id.ppm sampled.id.ppm || fail "expected the same ids"
    oiiotool fine.pfm --resize:filter=box 90x90 -d float -o mean.tif || fail "oiiotool failed"
    local covered sampled
    covered=$(idiff covered.pfm mean.tif | awk '/RMS error/ { print $4 }')
    sampled=$(idiff sampled.pfm mean.tif | awk '/RMS error/ { print $4 }')
    awk "BEGIN { exit !($covered < 0.5 * $sampled) }" || fail "expected less than half of $sampled, got $covered"
}

test_a_least_width_needs_a_picture_that_can_have_it() {
    rows '1 3 0 0 0 1 -1' '2 3 50 0 0 1 1' '3 3 60 9 0 0.05 2'
    run_ok corcast render tree.swc --size 60x60 --min-width 1.5 --quiet -o wide.png
    run corcast render tree.swc --min-width 1.5 --exact -o wide.png
    expect_status 2
    expect_sentence 'min-width needs --method fastest'
    run corcast render tree.swc --min-width 1.5 --look journal -o wide.png
    expect_status 2
    expect_sentence 'min-width has no effect with --look journal'
    run corcast render tree.swc --min-width 65 -o wide.png
    expect_status 2
    expect_sentence 'min-width.*from 0 to 64'
}

# survives OPTION...: `render` draws planes without NaN, or exits with status 2 and one sentence. It
# neither crashes nor hangs.
survives() {
    run timeout 300 "$CORCAST" render --exact tree.swc --size 40x40 --planes depth,normal -o picture.ppm "$@"
    if [ "$status" -eq 2 ]; then
        expect_sentence '[a-z]'
    else
        expect_status 0
        ! pfmtopam picture.normal.pfm | pamtopnm -plain 2>/dev/null | grep -qi nan || fail "expected numbers"
    fi
}

test_implicit_surfaces_of_odd_trees_are_drawn_or_refused() {
    local how
    for how in {isosurface,blob}\ --projection\ {orthographic,perspective}; do
        rows '1 3 0 0 0 1 -1' '2 3 0 0 0 1 1' '3 3 5 0 0 1 2'
        survives --model $how
        expect_status 0
        rows '1 3 0 0 0 1 -1' '2 3 5 0 0 1e-9 1' '3 3 5 5 0 1 2'
        survives --model $how
        expect_status 0
        rows '1 3 0 0 0 1e9 -1' '2 3 5 0 0 1e9 1'
        survives --model $how
        expect_status 2
        rows '1 3 0 0 0 1 -1' $(seq -f '%g:3:5:1:2:1:1' 2 200)
        tr : ' ' <tree.swc >coincident.swc && mv coincident.swc tree.swc
        survives --model $how
        expect_status 0
        rows '1 3 1e6 1e6 -1e6 1 -1' '2 3 1000005 1e6 -1e6 1 1'
        survives --model $how
        expect_status 0
        rows '1 3 0 0 0 1 -1'
        survives --model $how
        expect_status 2
    done
    rows '1 3 0 0 0 1 -1' '2 3 5 0 0 1 1' '3 3 8 3 0 .5 2' '4 3 8 -3 0 .5 2'
    for how in $(corcast models --of field | cut -f 1); do
        survives --model $how --projection perspective --location 2.5,0,0 --look-at 8,0,0
        expect_status 0
    done
}

test_a_pfm_that_fits_into_memory_goes_to_a_pipe() {
    mkfifo pipe.pfm
    cat pipe.pfm >got.pfm &
    run_ok corcast render "$DATA/bifurcation.swc" --size 31x613 -o pipe.pfm
    wait
    run_ok corcast render "$DATA/bifurcation.swc" --size 31x613 -o file.pfm
    expect_same file.pfm got.pfm
}

test_a_picture_that_shows_nothing_is_warned_of() {
    local options away='--location 0,0,-5 --look-at 0,0,-9 --up 0,1,0 --height 10'
    printf '1 1 0 0 0 1 -1\n2 3 0 4 0 1 1\n' >tree.swc
    for options in '' '--antialias 1' --exact '--background none' '--bits 16' '--planes id' '--look wax' '--look atlas --smooth off'; do
        run_ok corcast render tree.swc --size 20x20 $away $options -o a.png
        expect_sentence '^corcast: a\.png shows no vessel: the camera misses the tree, or the vessels are too small'
        run_ok corcast render tree.swc --size 20x20 $options -o a.png
        [ ! -s stderr ] || fail "expected no warning from $command_line$(said)"
    done
    run_ok corcast render tree.swc --size 20x20 $away --quiet -o a.png
    [ ! -s stderr ] || fail "expected no warning with --quiet$(said)"
    run_ok corcast render tree.swc --size 20x64 --tile 1/2 -o a.tif
    [ ! -s stderr ] || fail "expected no warning of a tile$(said)"
}

test_thin_vessels_behind_an_orthographic_camera_are_not_drawn() {
    local how
    rows '1 3 0 0 0 .05 -1' '2 3 4 3 0 .05 1' '3 3 0 -3 -8 2 -1' '4 3 1 -3 -8 2 3'
    for how in "" --ao=16 --shadows; do
        run_ok corcast render tree.swc --location 0,0,-4 --look-at 0,0,-8 --up 0,1,0 --height 12 --size 64x64 $how -o drawn.ppm
        run_ok corcast render tree.swc --location 0,0,-4 --look-at 0,0,-8 --up 0,1,0 --height 12 --size 64x64 $how \
            --method raster -o sampled.ppm
        expect_differing 0 0 drawn.ppm sampled.ppm
    done
}

test_a_vessel_outside_the_picture_does_not_change_it() {
    local radius
    for radius in .8 .015625; do
        rows "1 3 -40 -10 0 $radius -1" "2 3 30 20 0 $radius 1"
        run_ok corcast render tree.swc --look "$REPO/tests/golden/red.ini" --location 0,0,300 --look-at 0,0,0 --up 0,1,0 --height 128 --size 64x64 -o alone.ppm
        rows "1 3 -40 -10 0 $radius -1" "2 3 30 20 0 $radius 1" '3 3 500 0 0 2 -1' '4 3 501 0 0 2 3'
        run_ok corcast render tree.swc --look "$REPO/tests/golden/red.ini" --location 0,0,300 --look-at 0,0,0 --up 0,1,0 --height 128 --size 64x64 -o with.ppm
        expect_same alone.ppm with.ppm
    done
}

run_tests "$@"
