#!/usr/bin/env bash
# The statements of docs/POVRAY.md, tested on POV-Ray itself with pictures of a few pixels.
. "$(dirname "$0")/../lib.sh"

command -v "${CORCAST_POVRAY:-povray}" >/dev/null || {
    echo "povray is not installed: run make deps" >&2
    exit 3
}

# An orthographic camera over W x H mm at one pixel per mm. It looks along -z from z = 10 mm.
camera='camera { orthographic location <0, 0, 10> right W * x up H * y direction -z }'

# draw WxH [SWITCH ...]: POV-Ray draws the scene on standard input, by default linear with 16 bits.
# Sets $codes to the red codes of the pixels, row by row. In the scene, W and H are the sides of the
# picture, and Glow(V) is a texture with the color V in any light.
draw() {
    local size=$1
    shift
    {
        echo "#version 3.7; global_settings { assumed_gamma 1.0 } #declare W = ${size%x*}; #declare H = ${size#*x};"
        echo '#macro Glow(V) texture { pigment { rgb V } finish { ambient 0 diffuse 0 emission 1 } } #end'
        cat
    } >scene.pov
    run povray +Iscene.pov +Oscene.png "+W${size%x*}" "+H${size#*x}" -D +FN16 File_Gamma=1.0 "$@"
    [ "$status" -eq 0 ] || return 0
    codes=$(pngtopnm -plain scene.png 2>/dev/null | tail -n +4 | tr -s ' ' '\n' | grep . | awk 'NR % 3 == 1' | tr '\n' ' ')
}

# expect_codes CODE ...: the codes of the last picture are these.
expect_codes() {
    [ "$codes" = "$* " ] || fail "expected the codes $*, got $codes"
}

test_pixels_are_sampled_at_their_centres_from_the_top_left_on() {
    draw 4x2 <<END
$camera
plane { z, 0 pigment { function { (x + 2) / 8 + (1 - y) / 4 } color_map { [0 rgb 0] [1 rgb 1] } }
    finish { ambient 0 diffuse 0 emission 1 } }
END
    # (i + 1/2) / 8 + (j + 1/2) / 4 of 65535, rounded
    expect_codes 12288 20480 28672 36863 28672 36863 45055 53247
}

# Values just below and just above those at which the code changes.
test_codes_are_rounded_to_nearest_in_either_encoding() {
    local gamma
    for gamma in srgb 1.0; do
        awk -v gamma=$gamma -v camera="$camera" 'BEGIN {
            print camera
            for (i = 0; i < 32; i++) {
                e = (int(i / 2) * 16 + 3.5) / 255
                v = gamma != "srgb" ? e : e <= 0.04045 ? e / 12.92 : exp(2.4 * log((e + 0.055) / 1.055))
                printf "box { <%d, -1, 0>, <%d, 1, 1> Glow(%.12g) }\n", i - 16, i - 15, v * (1 + (i % 2 ? 3e-6 : -3e-6))
            }
        }' >steps.pov
        draw 32x1 +FN8 File_Gamma=$gamma <steps.pov
        # shellcheck disable=SC2046
        expect_codes $(seq 0 31 | awk '{ print int($1 / 2) * 16 + 3 + $1 % 2 }')
    done
}

test_samples_lie_at_the_centre_and_on_a_grid_and_are_averaged_before_they_are_encoded() {
    local slab='#macro Slab(I, C, V) box { <I + C, -1, 0>, <I + 0.499, 1, 1> Glow(V) } #end'
    # Samples at -1/4 and 1/4 in two rows, and at the centre. 5, 3, 2 and 0 of the 5 samples hit;
    # and 3 samples of twice 0.75.
    draw 5x1 +A0.0 +AM1 +R2 -J <<END
$camera $slab
Slab(-2, -0.251, 1) Slab(-1, -0.249, 1) Slab(0, 0.249, 1) Slab(1, 0.251, 1) Slab(2, -0.249, 1.5)
END
    expect_codes 65535 39321 26214 0 58982
    # Samples at -1/3, 0 and 1/3. 10, 7, 3 and 0 of the 10 samples hit.
    draw 4x1 +A0.0 +AM1 +R3 -J <<END
$camera $slab
Slab(-1.5, -0.334, 1) Slab(-0.5, -0.332, 1) Slab(0.5, 0.332, 1) Slab(1.5, 0.334, 1)
END
    expect_codes 65535 45875 19661 0
}

# The cosine of the angle to the light is 0.8, also for the mirrored ray; that of the half angle is
# 0.9487.
test_shading_is_the_sum_that_is_written_down() {
    draw 2x1 <<END
$camera
light_source { <30, 0, 40>, rgb 1 parallel point_at 0 }
plane { z, 0 pigment { rgb <0.5, 0, 0> } finish { ambient 0.1 emission 0.05 diffuse 0.2 brilliance 2 phong 0.25
    phong_size 3 specular 0.125 roughness 0.25 } }
END
    # 65535 (0.5 (0.1 + 0.05 + 0.2 0.8^2) + 0.25 0.8^3 + 0.125 0.9^2), the same everywhere
    expect_codes 24133 24133
}

test_a_shadowless_light_gives_no_highlight() {
    local kind
    for kind in '' shadowless; do
        draw 1x1 <<END
$camera
light_source { 50 * z, rgb 1 parallel point_at 0 $kind }
plane { z, 0 pigment { rgb 0.5 } finish { ambient 0 diffuse 0.5 phong 0.25 phong_size 10 } }
END
        # shellcheck disable=SC2046
        expect_codes $([ "$kind" ] && echo 16384 || echo 32768)
    done
}

# A light with a cosine of 10^-10 above the horizon, reflected directly towards the camera.
test_a_light_counts_from_a_least_cosine_on() {
    local part
    for part in 0.9 1.1; do
        draw 1x1 <<END
camera { orthographic location <-1, 0, 1e-9> right 1e-12 * y up 1e-12 * z direction <1, 0, -1e-9> }
light_source { <5e8, 0, ${part}e-10 * 5e8>, rgb 1 parallel point_at 0 }
plane { z, 0 pigment { rgb 1 } finish { ambient 0 diffuse 0 phong 0.5 phong_size 1 } no_shadow }
END
        # shellcheck disable=SC2046
        expect_codes $([ $part = 0.9 ] && echo 0 || echo 32768)
    done
}

# A wall half way to the light hides two of four columns of light points, and two of five. Of five
# columns, the outer ones have half the weight.
test_points_of_a_soft_light_reach_its_edges_and_weigh_alike_where_they_are_a_power_of_two() {
    local n
    for n in 4 5; do
        draw 1x1 <<END
$camera
light_source { 8 * z, rgb 1 area_light 4 * x, 4 * y, $n, $n }
plane { z, 0 pigment { rgb 1 } finish { ambient 0 diffuse 1 } }
box { <-3, -9, 4>, <-0.3, 9, 4.1> no_image }
END
        # shellcheck disable=SC2046
        expect_codes $([ $n = 4 ] && echo 32768 || echo 40959) # 2 / 4, 2.5 / 4
    done
    draw 2x1 <<END
$camera
light_source { 8 * z, rgb 1 area_light 4 * x, 4 * y, 2, 2 }
plane { z, 0 pigment { rgb 1 } finish { ambient 0 diffuse 1 } }
box { <-1.24, -9, 4>, <-1.26, 9, 4.1> no_image } // between the first pixel and -2
END
    [ "${codes%% *}" -lt 40000 ] || fail "expected a point of the light at its edge, got $codes"
}

test_what_is_within_a_thousandth_of_the_point_or_of_the_light_casts_no_shadow() {
    draw 6x1 <<END
$camera
light_source { 50 * z, rgb 1 parallel point_at 0 }
plane { z, 0 pigment { rgb 1 } finish { ambient 0 diffuse 0.5 } }
#macro Leaf(X, Z) box { <X - 0.4, -1, Z>, <X + 0.4, 1, Z + 1e-5> no_image } #end
Leaf(-2.5, 0.9e-3) Leaf(-1.5, 0.98e-3) Leaf(-0.5, 1.01e-3) Leaf(0.5, 1.1e-3) Leaf(1.5, 50 - 0.98e-3)
Leaf(2.5, 50 - 1.02e-3)
END
    expect_codes 32768 32768 0 0 32768 0
}

# Each strip is 0.005 mm above one pixel and 0.0005 mm above the other. The minimum distance is
# smaller for the object that blocked the light at the previous pixel.
test_the_object_that_was_last_in_the_way_of_the_light_counts_from_nearer_on() {
    draw 4x1 +WT1 <<END
$camera
light_source { 50 * z, rgb 1 parallel point_at 0 }
plane { z, 0 pigment { rgb 1 } finish { ambient 0 diffuse 0.5 } }
#macro Strip(X, Z0, Z1)
  mesh {
    triangle { <X - 1, -1, Z0>, <X - 1, 1, Z0>, <X + 1, -1, Z1> }
    triangle { <X + 1, 1, Z1>, <X - 1, 1, Z0>, <X + 1, -1, Z1> }
    no_image
  }
#end
Strip(-1, 7.25e-3, -1.75e-3) Strip(1, -1.75e-3, 7.25e-3)
END
    expect_codes 0 0 32768 0
}

test_what_is_nearer_than_a_ten_thousandth_is_not_seen_nor_a_sphere_or_plane_beyond_10_million() {
    local far
    draw 4x1 <<END
$camera
#macro Leaf(X, T) box { <X - 0.4, -1, 10 - T - 1e-6>, <X + 0.4, 1, 10 - T> Glow(1) } #end
Leaf(-1.5, 0.98e-4) Leaf(-0.5, 1.02e-4)
sphere { <0.5, 0, 8 - 0.99e7>, 2 Glow(1) clipped_by { plane { x, 1 } } }
sphere { <2.5, 0, 8 - 1.01e7>, 2 Glow(1) clipped_by { plane { -x, -1 } } }
END
    expect_codes 0 65535 65535 0
    for far in 0.99e7 1.01e7; do
        draw 1x1 <<END
$camera
plane { z, 10 - $far Glow(1) }
END
        # shellcheck disable=SC2046
        expect_codes $([ $far = 0.99e7 ] && echo 65535 || echo 0)
    done
}

test_a_sphere_is_missed_where_it_is_grazed_and_a_plane_along_itself() {
    local slope
    draw 2x1 <<END
$camera
sphere { <-0.5, 0, 0>, 0.99e-5 Glow(1) }
sphere { <0.5, 0, 0>, 1.01e-5 Glow(1) }
END
    expect_codes 0 65535
    for slope in 0.99e-10 1.01e-10; do
        draw 1x1 <<END
camera { orthographic location <0, 0, 5e-4> right 1e-9 * x up 1e-9 * z direction <0, 1, -$slope> }
plane { z, 0 Glow(1) }
END
        # shellcheck disable=SC2046
        expect_codes $([ $slope = 0.99e-10 ] && echo 0 || echo 65535)
    done
}

test_a_cylinder_without_length_is_a_fatal_error() {
    draw 1x1 <<<"$camera cylinder { 0, 1.1e-10 * x, 1 Glow(1) }"
    expect_status 0
    draw 1x1 <<<"$camera cylinder { 0, 0.9e-10 * x, 1 Glow(1) }"
    expect_status 1
    grep -q 'Degenerate cylinder' stderr || fail "expected the reason$(said)"
}

# Rays hit only the far side of each sphere, 0.0098 and 0.0102 mm from the camera.
test_a_root_of_a_blob_nearer_than_a_hundredth_is_ignored() {
    draw 2x1 <<END
$camera
#macro Bead(X, T) blob { threshold 0.5 sphere { <X, 0, 10 - T + 4e-4 * sqrt(1 - sqrt(0.5))>, 4e-4, 1 } Glow(1) } #end
Bead(-0.5, 0.0098) Bead(0.5, 0.0102)
END
    expect_codes 0 65535
}

# (1 - d^2 / R^2)^2 is 1/4 at d = R sqrt(1/2). Two components of half the strength equal one.
test_a_component_of_a_blob_falls_off_as_a_quartic() {
    draw 4x1 <<END
camera { orthographic location <0, 0, 10> right 0.04 * x up 0.01 * y direction -z }
#declare R = sqrt(0.5);
blob { threshold 0.25 sphere { <-R, 0, 0>, 1, 0.5 } sphere { <-R, 0, 0>, 1, 0.5 } Glow(1) }
END
    expect_codes 65535 65535 0 0
}

# f is the height above z = 0. The hit is the far end of an interval whose length is between
# accuracy / 2 and accuracy.
test_an_isosurface_is_hit_behind_its_root_by_less_than_its_accuracy() {
    draw 64x1 <<END
$camera
isosurface {
  function { z - 0.003 * x } contained_by { box { <-32, -1, -1>, <32, 1, 1> } } max_gradient 1.1 accuracy 0.05
  pigment { function { (0.003 * x - z) * 10 } color_map { [0 rgb 0] [1 rgb 1] } }
  finish { ambient 0 diffuse 0 emission 1 }
}
END
    echo "$codes" | tr ' ' '\n' | grep . | awk '{ if ($1 > 0.5 * 65535) far = 1; if ($1 > most) most = $1 }
        END { exit far || most < 0.2 * 65535 || NR != 64 }' || fail "expected hits up to 0.05 behind, got $codes"
}

# looked_into X Y CODE: a ray along -z at (X, Y) into the box of an isosurface, whose sides are at
# 20 and 20.5, gives the code.
looked_into() {
    draw 1x1 <<END
camera { orthographic location <$1, $2, 10> right x up y direction -z }
isosurface { function { z } contained_by { box { <20, 20, -1>, <20.5, 20.5, 1> } }
    max_gradient 1.1 accuracy 0.05 open Glow(1) }
END
    expect_codes "$3"
}

# In single precision, 20.4999999 is rounded to 20.5, but 20.499998 is not.
test_an_isosurface_is_not_seen_by_a_ray_whose_rounded_start_is_in_a_side_of_its_box_in_x() {
    looked_into 20.4999999 20.25 0
    looked_into 20.499998 20.25 65535
    looked_into 20.0000001 20.25 0
    looked_into 20.000002 20.25 65535
    looked_into 20.25 20.4999999 65535
    looked_into 20.25 20.0000001 65535
}

test_a_max_gradient_that_is_too_small_gives_holes() {
    local gradient
    for gradient in 4 0.4; do
        draw 1x1 <<END
$camera
isosurface { function { 0.3 - 4 * max(0, 0.1 - abs(z)) } contained_by { box { <-1, -1, -1>, <1, 1, 1> } }
    max_gradient $gradient accuracy 1e-4 open Glow(1) }
END
        # shellcheck disable=SC2046
        expect_codes $([ $gradient = 4 ] && echo 65535 || echo 0)
    done
}

test_a_pigment_averages_equally_and_a_pattern_wraps_above_1() {
    draw 3x1 <<END
$camera
plane { z, 0
  pigment {
    average pigment_map {
      [1 function { 0.5 + 0.3 * (x + 1) } color_map { [0 rgb 0] [1 rgb 3 * <1, 0, 0>] }]
      [1 rgb 0] [1 rgb 0]
    }
  }
  finish { ambient 0 diffuse 0 emission 1 } }
END
    expect_codes 32768 52428 6554 # 0.5, 0.8, and 1.1 less 1
}

test_a_picture_depends_neither_on_threads_nor_on_the_block_size() {
    local switches first=
    grow_tree 30
    run_ok corcast scene tree.swc --size 96x72 --model rounded -o tree.pov
    for switches in '+BS8 +WT1' '+BS32 +WT2' '+BS8 +WT1 +A0.0 +AM1 +R2 -J' '+BS32 +WT2 +A0.0 +AM1 +R2 -J'; do
        # shellcheck disable=SC2086
        run_ok povray +Itree.pov +Otree.png +W96 +H72 -D $switches
        pngtopnm tree.png >tree.ppm
        [ -z "$first" ] || expect_same tree.ppm first.ppm
        mv tree.ppm first.ppm
        [ -n "$first" ] && first= || first=drawn
    done
}

test_povray_speaks_on_standard_error_and_exits_with_1_for_a_bad_scene() {
    draw 4x4 <<<"$camera sphere { 0, 1 Glow(1) }"
    expect_status 0
    [ ! -s stdout ] || fail "expected nothing on standard output"
    grep -q "$(printf '\r')" stderr || fail "expected progress lines that end in carriage returns"
    draw 4x4 <<<'sphere { 0, 1 pigmnt { rgb 1 } }'
    expect_status 1
}

# A density file of 3 x 2 x 2 voxels with codes 10 to 120 of 255, x varying fastest. Its light is
# collected over 4 mm along z, 2 mm per voxel.
test_media_sum_up_density_files_by_method_2_and_more_by_method_3() {
    local method
    printf '\0\3\0\2\0\2\12\24\36\50\62\74\106\120\132\144\156\170' >d.df3
    for method in 2 3; do
        draw 3x2 <<END
$camera
box { <-1.5, -1, -4>, <1.5, 1, 0> hollow pigment { rgbt 1 } interior { media {
    emission 0.25 method $method intervals 1 samples 8
    density { density_file df3 "d.df3" interpolate 0 scale <3, 2, 4> translate <-1.5, -1, -4> } } } }
END
        # Rows from the top: y = 1, then y = 0; 0.5 (below + above) / 255 of 65535.
        [ $method = 3 ] || expect_codes 17990 20560 23130 10280 12850 15420
    done
    echo "$codes" | awk '{ exit !($1 > 17990 * 1.02 && $6 > 15420 * 1.02) }' || fail "expected more of method 3: $codes"
}

run_tests "$@"
