#!/usr/bin/env bash
# All kernels that this processor supports draw the same picture, within their bounds.
. "$(dirname "$0")/../lib.sh"

# find_usable: sets $usable to the kernels that this processor can run, the portable ones first.
find_usable() {
    local kernels
    usable=portable
    for kernels in avx2 avx512; do
        run corcast render "$DATA/bifurcation.swc" --size 8x8 --kernels $kernels -o usable.png
        if [ "$status" -eq 0 ]; then
            usable="$usable $kernels"
        else
            expect_status 2
            expect_sentence "this processor cannot run $kernels, at most"
        fi
    done
}

# draw KERNELS NAME OPTION...: draws all planes of a picture with the kernels.
draw() {
    run_ok corcast render --antialias 1 --quiet tree.swc --size 160x120 --planes color,depth,normal,id --kernels "$1" \
        -o "$2.png" "${@:3}"
}

# expect_drawn_alike OPTION...: all kernels draw the same picture as the portable kernels, to single
# precision.
expect_drawn_alike() {
    local kernels
    find_usable
    draw portable a "$@"
    for kernels in $usable; do
        draw "$kernels" b "$@"
        run_ok corcast compare a.png b.png --tier B --ids-a a.id.ppm --ids-b b.id.ppm
        run_ok corcast compare a.id.ppm b.id.ppm --tier B
        run_ok corcast compare a.depth.pfm b.depth.pfm --tier B --depth-mm 1e-4
        run_ok corcast compare a.normal.pfm b.normal.pfm --tier B
    done
}

test_isosurfaces_in_a_plane_seen_face_on() {
    grow_tree 60
    expect_drawn_alike --model isosurface
}

test_isosurfaces_in_perspective_with_shadows() {
    run_ok corcast grow --terminals 40 --domain ball:20 --seed 6 -o tree.swc
    expect_drawn_alike --model isosurface --projection perspective --view iso --shadows on --antialias 3
}

test_blobs_in_perspective_with_shadows() {
    run_ok corcast grow --terminals 40 --domain ball:20 --seed 6 -o tree.swc
    expect_drawn_alike --model blob --projection perspective --view iso --shadows on
}

test_rasterised_joints_with_shadows() {
    run_ok corcast grow --terminals 40 --domain ball:20 --seed 6 -o tree.swc
    expect_drawn_alike --method raster --model joined --projection perspective --view iso --shadows on
}

test_rasterised_spheres_and_cylinders_antialiased() {
    grow_tree 60
    expect_drawn_alike --method raster --model rounded --shadows on --antialias 3 --look print
}

# The kernels compared above are really different: the last digits of their results differ.
test_kernels_are_what_was_asked_for() {
    find_usable
    [ "$usable" != portable ] || skip "this processor runs the portable kernels alone"
    run_ok corcast grow --terminals 40 --domain ball:20 --seed 6 -o tree.swc
    draw portable a --model isosurface --view iso
    draw avx2 b --model isosurface --view iso
    run corcast compare a.depth.pfm b.depth.pfm --json
    expect_status 1
    expect_json stdout '.differing_pixels >= 5 and .differing_pixels <= 50 and .max_abs_mm < 1e-4'
}

test_verify_takes_kernels() {
    run corcast verify "$DATA/bifurcation.swc" --kernels avx1 -o v
    expect_status 2
    expect_sentence "'avx1' is not one of"
}

run_tests "$@"
