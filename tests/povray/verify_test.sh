#!/usr/bin/env bash
# `verify` with the real POV-Ray, on small pictures. matrix_test.sh covers models, projections,
# shadows and antialiasing. Besides the verdict of `verify`, netpbm decodes the 8-bit pictures and
# these tests count differing pixels, so that an error of corcast's own comparison is found.
. "$(dirname "$0")/../lib.sh"

command -v "${CORCAST_POVRAY:-povray}" >/dev/null || {
    echo "povray is not installed: run make deps" >&2
    exit 3
}

# differing A.png B.png [LEVELS]: prints the number of pixels that differ by more than LEVELS levels
# (default 0) in a channel.
differing() {
    cmp -l <(pngtopnm "$1") <(pngtopnm "$2") |
        awk -v limit="${3:-0}" '
            function level(octal) { return int(octal / 100) * 64 + int(octal / 10) % 10 * 8 + octal % 10 }
            { d = level($2) - level($3); if (d > limit || -d > limit) seen[int(($1 - 16) / 3)] = 1 }
            END { for (p in seen) n++; print n + 0 }'
}

tree_2d() {
    run_ok corcast grow --terminals "${1:-60}" --seed 5 --gamma 2.7 -o tree.swc
}

tree_3d() {
    run_ok corcast grow --terminals "${1:-60}" --seed 6 --domain ball:28.794 --relax 0 -o tree.swc
}

# Shadows of parallel lights, for which POV-Ray takes a fifth of the time of the default look's.
HARD=(--shadows on --look "$REPO/tests/golden/hard.ini")

# agrees MODEL OPTIONS ...: `verify` passes for tree.swc, and the pictures are as close as the
# documents state.
agrees() {
    local model=$1 pixels
    shift
    run_ok corcast verify tree.swc --model "$model" --size 160x120 -o report "$@"
    expect_json report/report.json ".verdict == \"agree\" and .model == \"$model\""
    pixels=$(differing report/povray.png report/native.png)
    [ "$pixels" -eq 0 ] || fail "expected the same pixels, got $pixels that differ"
    [ "$model" != isosurface ] ||
        expect_json report/report.json '.surface.verdict == "agree" and .surface.common_pixels > 100'
}

# The default camera frames these trees so that outlines, cuts and surfaces at equal depth are
# exactly at pixel centres. Sums of hundreds of quartics are rounded differently in the two
# programs: one pixel in 19,200 differs by one level.
test_smooth_vessels_agree_in_every_model() {
    local model pixels
    tree_3d 6
    for model in $(corcast models | cut -f 1) 'isosurface --potential graph'; do
        run_ok corcast verify tree.swc --smooth --color-by wss --model $model --size 120x90 -o report
        expect_json report/report.json '.verdict == "agree"'
        grep -q 'smooth: 11 segments are drawn as' stderr || fail "expected the pieces of $model"
        pixels=$(differing report/povray.png report/native.png 1)
        [ "$pixels" -eq 0 ] || fail "expected the same pixels of $model, got $pixels that differ"
    done
}

test_tubes_tees_and_crosses_on_integers_agree() {
    local case
    printf '1 1 0 0 0 1 -1\n2 3 0 10 0 1 1\n' >tube.swc
    printf '1 1 0 0 0 1 -1\n2 3 0 2 0 1 1\n3 3 -1 2 0 1 2\n4 3 1 2 0 1 2\n' >tee.swc
    printf '1 1 0 0 0 1 -1\n2 3 0 4 0 1 1\n3 3 -3 4 0 1 2\n4 3 3 4 0 1 2\n5 3 0 8 0 1 2\n' >cross.swc
    for case in 'tube cylinders 100x100' 'tube joined 100x100' 'tube rounded 100x100' 'tube blob 100x100' \
        'tube isosurface 100x100' 'tube mesh 100x100' 'tee cylinders 500x500' 'tee joined 100x100' 'tee rounded 300x300' \
        'tee blob 100x100' 'tee isosurface 100x100' 'cross cylinders 100x100 --view left' 'cross joined 50x50' \
        'cross rounded 200x100 --antialias 2' 'cross blob 50x50' 'cross cylinders 160x120 --projection perspective'; do
        set -- $case
        run corcast verify "$1.swc" --model "$2" --size "$3" "${@:4}" -o report
        [ "$status" -eq 0 ] || fail "expected agreement of $case, got: $(cat stdout)"
    done
}

test_a_picture_that_shows_nothing_is_no_agreement() {
    local model away='--location 0,0,-5 --look-at 0,0,-9 --up 0,1,0 --height 10'
    printf '1 1 0 0 0 1 -1\n2 3 0 4 0 1 1\n' >tree.swc
    for model in cylinders mesh; do
        run corcast verify tree.swc --model $model --size 20x20 $away -o report
        expect_status 2
        expect_sentence 'neither POV-Ray nor corcast shows a vessel of tree\.swc in this view, so nothing can be verified'
        [ ! -e report/report.json ] || fail "expected no verdict"
    done
}

test_alpha_of_a_transparent_picture_is_judged() {
    local antialias
    cp "$DATA/bifurcation.swc" tree.swc
    for antialias in 1 2; do
        run_ok corcast verify tree.swc --background none --size 60x50 --antialias $antialias -o report
        expect_stdout '^  alpha   agree  0 of 3000 pixels differ$'
        expect_json report/report.json '.alpha.verdict == "agree" and .alpha.max_abs == 0'
    done
    expect_file report/povray.alpha.png
    # Replaces POV-Ray by a script whose pictures are 2 % too transparent and otherwise correct.
    cat >povray.sh <<'END'
#!/bin/bash
for i; do
    case $i in
    +O*) picture=${i#+O} ;;
    +UA) alpha=1 ;;
    esac
done
povray "$@" || exit
[ -z "${alpha-}" ] || oiiotool "$picture" --mulc 1,1,1,0.98 -o "$picture"
END
    chmod +x povray.sh
    run env CORCAST_POVRAY="$PWD/povray.sh" "$CORCAST" verify tree.swc --background none --size 60x50 -o report
    expect_status 1
    expect_stdout '^  color   agree '
    expect_stdout '^  alpha   differ alpha: .* of the pixels are off by more than 0 levels .* the worst, 5 levels, is at '
    expect_json report/report.json '.verdict == "differ" and .alpha.verdict == "differ" and (.reason | startswith("alpha: "))'
    run_ok corcast verify tree.swc --size 60x50 -o report
    expect_json report/report.json 'has("alpha") | not'
    [ ! -e report/povray.alpha.png ] || fail "expected no alpha of an opaque picture"
}

test_joined_trees_of_least_length_agree() {
    run_ok corcast grow --terminals 150 --seed 3 --lambda 0 -o tree.swc
    agrees joined --view iso "${HARD[@]}"
}

test_joints_seen_close_up_agree() {
    tree_3d 30
    agrees joined --location 3,14,40 --look-at 2,12,1 --height 9
    rm -r report
    agrees joined --projection perspective --location 12,25,9 --look-at 1,16,2 --angle 30 "${HARD[@]}"
}

# The panels of templates/figures/fig3.ini without ambient occlusion, which POV-Ray lacks. `make
# figures` draws them large and antialiased.
test_bifurcations_of_three_angles_agree_in_three_models() {
    local angles model
    for angles in 20,30 35,50 60,70; do
        run_ok corcast bifurcation --radii 3.2,2.8,2.1 --lengths 13,13,13 --angles $angles -o tree.swc
        for model in cylinders joined isosurface; do
            agrees $model --look "$REPO/tests/golden/specular.ini" --shadows on --look-at 0,0,0 --height 33 --size 64x64
            rm -r report
        done
    done
}

# Two vessels at the two ends of a short segment, so close that the potential of the paper merges
# them.
test_the_potential_of_the_graph_agrees() {
    printf '%s\n' '1 3 -9 1.1 0 1 -1' '2 3 0 1.1 0 1 1' '3 3 9 1.1 0 1 2' '4 3 0 -1.1 0 0.6 2' '5 3 9 -1.1 0 1 4' \
        '6 3 -9 -1.1 0 1 4' >tree.swc
    agrees isosurface --potential graph --color-by radius --shadows on
    tree_3d
    agrees isosurface --potential graph --view iso --projection perspective
}

# With shadows, pixels where the surface is parallel to the light may depend on POV-Ray's shadow
# cache.
test_meshes_agree() {
    tree_3d 12
    agrees mesh --color-by radius --view iso --antialias 2
    rm -r report
    agrees mesh --mesh-tolerance 0.1 --projection perspective --location 12,25,9 --look-at 1,16,2 --angle 30
    run_ok corcast verify tree.swc --model mesh --color-by radius --view iso --shadows on --size 160x120 -o shadows
    expect_json shadows/report.json '.verdict == "agree" and .planes.color.edge_mismatch_fraction == 0'
}

test_isosurface_with_an_exact_erf_agrees() {
    tree_3d 30
    agrees isosurface --erf exact "${HARD[@]}"
}

test_an_isosurface_whose_numbers_are_in_matrices_agrees() {
    run_ok corcast grow --terminals 1537 --seed 3 -o tree.swc --quiet
    run_ok corcast verify tree.swc --model isosurface --erf exact --cell-beta 50 --size 60x40 -o check
    grep -q 'Vs\[3072\](x,y,z)\.x' check/scene.inc || fail "expected the last segment to have a matrix"
}

test_colors_that_blend_agree_to_the_last_of_16_bits() {
    local options
    tree_3d 30
    for options in 'isosurface --color-by radius' 'isosurface --potential graph --color-by pressure' \
        'isosurface --erf exact --color-by flow --classes 5' 'blob --color-by wss'; do
        # shellcheck disable=SC2086
        run_ok corcast verify tree.swc --bits 16 --view iso --size 160x120 -o report --model $options \
            --color-blend blended
        expect_json report/report.json '.planes.color.differing_pixels == 0'
    done
}

# The Strahler orders of a grown tree are exactly on the bounds of these classes. Each vessel has
# the same color in both pictures. The look is flat, so a picture contains only the background, the
# colors of the classes, and those of --over and --under.
test_values_on_the_bounds_of_classes_have_one_color_in_both_pictures() {
    local model classes
    tree_3d 30
    for model in isosurface blob; do
        for classes in '--classes 2' '--classes 3,5' '--classes 4 --range 2,4 --under red --over blue'; do
            # shellcheck disable=SC2086
            run_ok corcast verify tree.swc --look flat --antialias 1 --size 80x60 -o report --model $model \
                --color-by strahler --color-blend blended $classes
            expect_json report/report.json '.planes.color.differing_pixels == 0'
        done
    done
}

test_a_blob_whose_numbers_are_in_matrices_agrees() {
    local blend
    run_ok corcast grow --terminals 1537 --seed 3 -o tree.swc --quiet
    for blend in segment blended; do
        run_ok corcast verify tree.swc --model blob --color-by pressure --color-blend $blend --size 60x40 -o check
        grep -q 'Ve\[3072\](0,0,0)\.y' check/scene.inc || fail "expected the last segment to have a matrix"
    done
}

test_joints_whose_numbers_move_a_point_agree() {
    run_ok corcast grow --terminals 4600 --seed 3 -o tree.swc --quiet
    run_ok corcast verify tree.swc --model joined --size 60x40 -o check
    [ "$(grep -c '^Vessel_Joint(' check/scene.inc)" -gt 8000 ] || fail "expected more joints"
}

# More segments than fit into one cell of the scene, and some shorter than their radius.
test_blobs_in_many_cells_agree() {
    run_ok corcast grow --terminals 300 --seed 3 --lambda 0 -o tree.swc
    agrees blob --view iso "${HARD[@]}"
    [ "$(grep -c '^Blob_Cell()' report/scene.inc)" -gt 2 ] || fail "expected a scene in several cells"
}

test_linear_codes_of_16_bits_agree_within_one_in_every_model() {
    local options
    tree_3d 30
    for options in cylinders joined rounded isosurface \
        blob 'rounded --projection perspective --antialias 3' 'mesh --mesh-tolerance 0.1'; do
        # shellcheck disable=SC2086
        run_ok corcast verify tree.swc --bits 16 --view iso --size 160x120 -o report "${HARD[@]}" --model $options
        expect_json report/report.json '.verdict == "agree" and .planes.color.bits == 16 and
            (.planes.color.classes | .edge + .shadow + .geometry + .shading == 0)'
    done
    run corcast verify tree.swc --bits 12 -o twelve
    expect_status 2
    expect_sentence "--bits: '12' is not 8 or 16"
}

test_a_camera_of_ones_own_agrees() {
    tree_3d
    agrees rounded --projection perspective --location 31.5,-42,77 --look-at 1,2,-3 --up 0.1,1,0.2 --angle 41
    rm -r report
    agrees cylinders --location -20,35,60 --look-at 0,5,0 --height 37.5 --background 0.1,0.2,0.3
}

test_a_picture_wider_than_high_and_one_higher_than_wide_agree() {
    local size
    tree_2d 30
    for size in 201x53 47x151; do
        run_ok corcast verify tree.swc --model rounded --size $size -o report-$size
        [ "$(differing report-$size/povray.png report-$size/native.png)" -eq 0 ] ||
            fail "expected the same pixels at $size"
    done
}

test_a_tree_drawn_by_hand_agrees_in_every_model() {
    local model
    cp "$DATA/bifurcation.swc" tree.swc
    for model in $(corcast models | cut -f 1); do
        agrees $model
        rm -r report
    done
}

# Faces of cells are at x = 0 and y = 0.
test_isosurface_agrees_at_any_magnification() {
    local height
    cp "$DATA/bifurcation.swc" tree.swc
    for height in 1 0.05 0.002; do
        agrees isosurface --location 0,-0.53,90 --look-at 0,-0.53,0 --height $height "${HARD[@]}"
        rm -r report
    done
}

test_a_tree_agrees_at_every_scale() {
    local scale
    tree_3d
    grep -v '^#' tree.swc >unscaled.swc
    for scale in 0.01 1000; do
        awk -v by=$scale '{ for (i = 3; i <= 6; i++) $i *= by; print }' CONVFMT=%.15g OFMT=%.15g unscaled.swc >tree.swc
        run_ok corcast verify tree.swc --model isosurface "${HARD[@]}" --size 160x120 -o report
        expect_json report/report.json ".surface.verdict == \"agree\" and (.surface.p99_abs_mm / $scale | . > 0.0005 and . < 0.02)"
    done
}

test_a_tree_far_from_the_origin_agrees() {
    local model
    tree_3d 40
    awk '/^#/ { if (!/domain/) print; next }
         { $3 += 1000000; $4 -= 500000; $5 += 200000; print }' CONVFMT=%.15g OFMT=%.15g tree.swc >far.swc
    mv far.swc tree.swc
    for model in rounded isosurface blob; do
        agrees $model
        rm -r report
    done
}

# The inner sides of walls are lit like their outer sides.
test_walls_seen_from_inside_agree() {
    local model
    printf '%s\n' '1 3 0 0 0 1 -1' '2 3 5 0 0 1 1' '3 3 8 3 0 .5 2' '4 3 8 -3 0 .5 2' >tree.swc
    for model in cylinders rounded isosurface; do
        agrees $model --projection perspective --location 2.5,0.2,0.1 --look-at 0,0,0 --angle 60
        rm -r report
    done
    agrees isosurface --projection perspective --location 2.5,0.2,0.1 --look-at 8,0,0 --angle 60 "${HARD[@]}"
}

test_odd_trees_agree() {
    local tree model
    for tree in star collinear stout; do
        cp "$DATA/$tree.swc" tree.swc
        for model in $(corcast models --of primitives | cut -f 1); do
            agrees $model "${HARD[@]}"
            rm -r report
        done
    done
}

test_a_measured_tree_agrees() {
    [ -d "$SHARED/brava" ] || skip "the measured trees of ../shared/data/brava are not here"
    cp "$SHARED/brava/BG0002records.swc" tree.swc
    agrees rounded --view left
    rm -r report
    agrees joined --view left
}

test_colors_by_a_field_agree_in_every_model() {
    local model
    tree_2d 20
    for model in $(corcast models | cut -f 1); do
        agrees $model --color-by pressure
        rm -r report
    done
}

point_lights() {
    cat >lights.ini <<'END'
[vessel]
color = 0.56 0.055 0.045
[background]
color = 0.9 1 1
[finish]
ambient = 0.12
diffuse = 0.72
brilliance = 1.5
phong = 0.32
phong_size = 72
specular = 0.2
roughness = 0.03
[light near]
position = 1.5 0.3 1
color = 0.3 0.3 0.4
[light far]
direction = 0 1 1
color = 0.2 0.1 0.2
[light soft]
position = -1.5 2 2.5
color = 0.7 0.7 0.6
END
}

test_point_lights_and_highlights_agree() {
    tree_3d
    point_lights
    agrees rounded --look ./lights.ini --shadows on
    rm -r report
    agrees joined --look ./lights.ini --shadows on --projection perspective
}

test_many_lights_of_both_kinds_agree() {
    local i
    tree_3d
    point_lights
    for i in $(seq 40); do
        printf '[light %d]\n%s = %d.5 %d 2\ncolor = 0.03 0.02 0.01\n' $i \
            "$([ $((i % 2)) -eq 0 ] && echo position || echo direction)" $((i % 7 - 3)) $((i % 5 - 2))
    done >>lights.ini
    agrees rounded --look ./lights.ini --shadows on
    rm -r report
    agrees isosurface --look ./lights.ini --shadows on --projection perspective
}

# ground LINES: writes a look with a ground plane that the lines describe.
ground() {
    point_lights
    printf '[ground]\n%s\ncolor = 0.8 0.75 0.9\ndiffuse = 0.7\n' "$1" >>lights.ini
}

test_shadows_on_the_ground_agree() {
    local model
    tree_3d
    ground 'axis = 0 1 0'
    for model in $(corcast models | cut -f 1); do
        agrees $model --look ./lights.ini --shadows on --projection perspective \
            --location 40,10,90 --look-at 0,-10,0 --angle 50
        rm -r report
    done
    agrees rounded --look ./lights.ini --projection perspective --location 40,10,90 --look-at 0,-10,0 --antialias 2
    corcast render --exact tree.swc --look ./lights.ini --size 90x90 --view iso -o ground.ppm
    sed -i '/ground/,$d' lights.ini
    corcast render --exact tree.swc --look ./lights.ini --size 90x90 --view iso -o none.ppm
    expect_differing 8100 8100 ground.ppm none.ppm
}

test_a_sheet_behind_the_tree_agrees() {
    tree_3d
    ground 'normal = 0.2 0.1 1'
    agrees rounded --look ./lights.ini --shadows on --view iso
    rm -r report
    agrees isosurface --look ./lights.ini --shadows on --antialias 2
}

# Seen from below, the ground hides the tree. It blocks no light from above.
test_a_ground_seen_from_below_agrees() {
    tree_3d
    ground 'axis = 0 1 0'
    agrees rounded --look ./lights.ini --shadows on --location 20,-60,50 --look-at 0,0,0
}

test_a_horizon_agrees() {
    tree_3d
    ground 'axis = 0 1 0'
    agrees rounded --look ./lights.ini --shadows on --projection perspective --location 400,-10,900 --look-at 0,80,0 \
        --angle 50
}

test_ambient_occlusion_is_not_held_against_povray() {
    tree_2d 5
    run corcast verify tree.swc --ao 8 -o report
    expect_status 2
    expect_sentence "--ao cannot be verified: POV-Ray has no ambient occlusion"
    run corcast scene tree.swc --ao 8 -o scene.pov
    expect_status 2
    expect_sentence "--ao cannot be verified"
}

soft_lights() {
    point_lights
    printf 'size = 0.8\nsamples = 4\n' >>lights.ini
}

# Only differences that POV-Ray's shadow cache explains are counted as settled.
test_soft_shadows_agree_but_for_the_shadow_cache() {
    tree_3d
    soft_lights
    run_ok corcast verify tree.swc --model rounded --look ./lights.ini --shadows on --size 240x180 -o report
    expect_json report/report.json '.verdict == "agree" and .settled.unexplained_pixels == 0'
    expect_json report/report.json '.planes.color.differing_pixels == .settled.rules[0].measured
        and .settled.rules[0].measured > 0'
    [ "$(differing report/povray.png report/native.png 1)" -eq 0 ] ||
        fail "expected none to differ by more than a level"
    corcast render --exact tree.swc --model rounded --look ./lights.ini --shadows on --size 240x180 -o soft.ppm
    sed 's/^samples/round = on\n&/' lights.ini >round.ini
    run_ok corcast verify tree.swc --model rounded --look ./round.ini --shadows on --size 240x180 -o round
    expect_json round/report.json '.verdict == "agree" and .settled.unexplained_pixels == 0'
    sed -i '/^size/d' lights.ini
    corcast render --exact tree.swc --model rounded --look ./lights.ini --shadows on --size 240x180 -o hard.ppm
    expect_differing 1100 1400 soft.ppm hard.ppm
}

# povray_sees COMMAND: replaces POV-Ray by a script that runs COMMAND before the first POV-Ray run.
# COMMAND may change the files $scene and $geometry.
povray_sees() {
    cat >povray.sh <<END
#!/bin/sh
for argument; do
    case \$argument in +I*) scene=\$(readlink -f "\${argument#+I}") ;; esac
done
geometry=\${scene%.pov}.inc
(
    flock 9
    [ -f "\$geometry.whole" ] || {
        cp "\$geometry" "\$geometry.whole"
        $1
    }
) 9>"\$geometry.lock"
exec povray "\$@"
END
    chmod +x povray.sh
    export CORCAST_POVRAY=$PWD/povray.sh
}

# A light with fewer points, a light of another size, and a square light instead of a round one.
test_faults_in_soft_shadows_are_found_out() {
    local edit
    tree_3d
    soft_lights
    for edit in '/^ *Light_Area/s/, 4)$/, 2)/' '/^ *Light_Area/s/, <\([-0-9.]*\),/, <1.02*\1,/2' 's/ circular//'; do
        [ "$edit" != 's/ circular//' ] || echo 'round = on' >>lights.ini
        rm -rf report
        povray_sees "sed -i '$edit' \"\$scene\""
        run corcast verify tree.swc --model rounded --look ./lights.ini --shadows on --size 240x180 -o report
        expect_status 1
        expect_json report/report.json '.verdict == "differ" and .settled.unexplained_pixels > 10'
    done
}

# Joints between pieces of a smooth vessel are 1e-7 radii thick at the inside of a bend. A pixel at the outline showed
# POV-Ray a surface beside such a joint when the function of joints had a margin of 1e-6 radii.
test_joints_of_smooth_vessels_end_at_their_rims() {
    run_ok corcast grow --terminals 6 --domain ball:20 --seed 5 --quiet -o tree.swc
    run_ok corcast verify tree.swc --model joined --smooth --size 120x90 -o report
}

# A chain of segments seen end-on. POV-Ray misses roots of rays that graze the wall.
END_ON='--model blob --location 0.2,-0.2,300 --look-at 0.2,-0.2,0 --up 0,1,0 --height 3.2 --size 160x120'

test_where_povray_misses_a_root_of_a_blob_the_field_says_so() {
    # END_ON is words.
    # shellcheck disable=SC2086
    run_ok corcast verify "$DATA/end-on.swc" $END_ON -o report
    expect_json report/report.json '.planes.color.differing_pixels > 0 and .settled.unexplained_pixels == 0'
    expect_json report/report.json '.settled.pixels[0] | .cause == "missed root" and .depth_a_mm > .root_mm + 1
        and (.depth_b_mm - .root_mm | fabs) < 1e-4 and .cosine < 0.1'
    expect_stdout 'pixels at which POV-Ray missed a root: [1-6] \(limit 6\); corcast is right in these pixels'
    expect_stdout 'missed root at \([0-9]+, [0-9]+\), segment [0-9]+: POV-Ray hits a surface at'
    grep -q 'in favour of corcast: .*POV-Ray missed a root' report/report.html || fail "expected the page to say so"
    grep -q '<testcase classname="blob" name="settled">' report/junit.xml || fail "expected a test case in junit.xml"
}

test_where_povray_misses_a_root_of_an_antialiased_blob_the_field_says_so() {
    # shellcheck disable=SC2086
    run_ok corcast verify "$DATA/end-on.swc" $END_ON --antialias 2 -o report
    expect_json report/report.json '.settled.unexplained_pixels == 0 and (.settled.pixels | length) > 1'
}

# povray_then COMMAND: replaces POV-Ray by a script that runs COMMAND after POV-Ray. COMMAND may
# change $picture, the picture of the plane $plane.
povray_then() {
    cat >povray.sh <<END
#!/bin/sh
povray "\$@" || exit
for argument; do
    case \$argument in
    +O*) picture=\${argument#+O} ;;
    Declare=Corcast_Plane=*) plane=\${argument##*=} ;;
    esac
done
$1
END
    chmod +x povray.sh
    export CORCAST_POVRAY=$PWD/povray.sh
}

# One pixel of POV-Ray's colors becomes darker, then brighter. Neither a root nor a shadow explains
# this.
test_a_pixel_of_a_blob_that_nothing_explains_is_a_difference() {
    local level
    for level in 3 200; do
        povray_then "[ \$plane != 0 ] || {
    pngtopnm \"\$picture\" >p.ppm
    printf '\\$(printf %o $level)' | dd of=p.ppm bs=1 seek=\$((15 + 3 * (60 * 160 + 75))) conv=notrunc 2>dd.log
    pnmtopng p.ppm >\"\$picture\" 2>png.log
}"
        # shellcheck disable=SC2086
        run corcast verify "$DATA/end-on.swc" $END_ON "${HARD[@]}" -o report
        expect_status 1
        expect_json report/report.json '.verdict == "differ" and .settled.unexplained_pixels == 1'
    done
}

# The surface behind a missing segment is a later root of the field, but the rays that hit it do not
# graze.
test_a_missing_segment_of_a_blob_is_found_out() {
    tree_3d 30
    povray_sees "awk '/^ *Vessel_Blob\(/ && ++n == 30 { next } { print }' \"\$geometry.whole\" >\"\$geometry\""
    run corcast verify tree.swc --model blob --size 160x120 -o report
    expect_status 1
    expect_json report/report.json '.verdict == "differ" and .settled.unexplained_pixels > 3'
}

# Compares the picture with guaranteed roots with the picture that finds the surface as POV-Ray
# does.
test_soft_shadows_fall_on_isosurfaces() {
    local hits
    tree_3d
    point_lights
    printf 'size = 0.8\nsamples = 4\n' >>lights.ini
    for hits in exact povray; do
        run_ok corcast render --exact tree.swc --model isosurface --hits $hits --look ./lights.ini --shadows on \
            --size 160x120 -o $hits.png
    done
    [ "$(differing exact.png povray.png 3)" -le 20 ] || fail "expected the same soft shadows on both"
    sed -i '/^size/d' lights.ini
    run_ok corcast render --exact tree.swc --model isosurface --look ./lights.ini --shadows on --size 160x120 \
        -o hard.png
    [ "$(differing exact.png hard.png 3)" -gt 40 ] || fail "expected soft shadows to differ from hard ones"
}

# Replaces POV-Ray by a script that waits until three copies of it run.
test_the_planes_are_drawn_side_by_side() {
    cat >povray.sh <<END
#!/bin/sh
touch "$PWD/begun.\$\$"
for moment in \$(seq 200); do
    [ \$(ls "$PWD"/begun.* | wc -l) -ge 3 ] && exec povray "\$@"
    sleep 0.05
done
echo 'rror: alone' >&2
exit 1
END
    chmod +x povray.sh
    run_ok env CORCAST_POVRAY="$PWD/povray.sh" "$CORCAST" verify "$DATA/bifurcation.swc" --size 40x30 -o report
    rm begun.*
    sed -i 's/seq 200/seq 2/' povray.sh
    run env CORCAST_POVRAY="$PWD/povray.sh" "$CORCAST" verify "$DATA/bifurcation.swc" --size 40x30 --threads 1 -o one
    expect_status 3
    expect_sentence 'exit status 1\): rror: alone'
}

# planes_asked_for REPORT: prints the planes of the commands in the report, in one line.
planes_asked_for() {
    jq -r '.commands[]' "$1" | sed -n 's/.*Corcast_Plane=\([0-9]\).*/\1/p' | tr '\n' ' '
}

test_ids_too_large_for_a_plane_with_depth_have_their_own() {
    local model
    tree_2d 10
    awk '/^#/ { print; next } { $1 += 65530; if ($7 >= 0) $7 += 65530; print }' tree.swc >large.swc
    for model in joined isosurface; do
        run_ok corcast verify tree.swc --model $model --size 80x60 -o small
        run_ok corcast verify large.swc --model $model --size 80x60 -o large
        [ "$(planes_asked_for small/report.json)" = '0 4 2 ' ] || fail "expected depth with ids of $model"
        [ "$(planes_asked_for large/report.json)" = '0 1 2 3 ' ] || fail "expected ids alone of $model"
        expect_json large/report.json '.verdict == "agree" and .planes.id.mismatch_fraction == 0'
        cmp -s small/povray.depth.pfm large/povray.depth.pfm || fail "expected the same depths of $model"
    done
}

test_verify_writes_what_the_contract_names() {
    local file
    tree_2d 10
    run_ok corcast verify tree.swc --model rounded --size 80x60 -o report --json
    for file in report.html report.json junit.xml scene.pov scene.inc povray.png native.png diff.png; do
        expect_file "report/$file"
    done
    expect_json stdout '.verdict == "agree"'
    expect_json report/report.json '.povray.version | startswith("3.7")'
    expect_json report/report.json '.povray.seconds > 0 and .native.seconds >= 0'
    expect_json report/report.json '.planes.color | has("max_abs") and has("flip_mean") and has("ssim")'
    expect_json report/report.json '.planes.depth | has("median_abs_mm") and has("p99_abs_mm") and has("max_abs_mm")'
    expect_json report/report.json '.planes.normal | has("median_deg") and has("p99_deg")'
    expect_json report/report.json '.planes.id | has("mismatch_fraction")'
    grep -q '<testsuite' report/junit.xml || fail "expected a testsuite in junit.xml"
    [ "$(grep -o '<testcase' report/junit.xml | wc -l)" -ge 4 ] || fail "expected a test case a plane"
}

test_the_report_page_needs_nothing_else() {
    tree_2d 10
    run_ok corcast verify tree.swc --size 80x60 -o report
    ! grep -oE '(src|href)="?(https?:|//|[a-z]+\.(png|js|css))[^ >]*' report/report.html >found ||
        fail "expected everything to be inside, found $(cat found)"
    grep -q 'data:image/png;base64,' report/report.html || fail "expected the pictures in the page"
    grep -qi 'agree' report/report.html || fail "expected the verdict in the page"
    ! grep -qF "$PWD" report/report.html report/report.json || fail "expected no path of this machine"
}

# povray_with ARGUMENT...: replaces POV-Ray by a script that passes further arguments to it, so that
# it draws another picture.
povray_with() {
    printf '#!/bin/sh\nexec povray "$@" %s\n' "$*" >povray.sh
    chmod +x povray.sh
    export CORCAST_POVRAY=$PWD/povray.sh
}

test_another_finish_is_found_out() {
    local change
    tree_2d 30
    for change in Vessel_Phong=0.33 Vessel_Diffuse=0.727 Vessel_Ambient=0.126 Vessel_Phong_Size=33 \
        Light_Intensity=1.01; do
        povray_with "Declare=$change"
        run corcast verify tree.swc --look "$REPO/tests/golden/red.ini" --model rounded --size 160x120 -o report
        [ "$status" -eq 1 ] || fail "expected exit status 1 with $change, got $status$(said)"
        expect_json report/report.json '.verdict == "differ"'
    done
}

# At the exact surface, the colors equal POV-Ray's up to the accuracy of POV-Ray's root finder.
test_a_hundredth_more_diffuse_light_is_found_in_the_exact_isosurface() {
    local change
    tree_3d 30
    run_ok corcast verify tree.swc --model isosurface --size 160x120 --view iso "${HARD[@]}" -o report
    expect_json report/report.json '.exact.verdict == "agree" and .exact.tier == "surface" and .exact.gain - 1 < 0.0005'
    grep -q '<testcase classname="isosurface" name="exact color">' report/junit.xml || fail "expected a test case"
    for change in Vessel_Diffuse=0.7272 Vessel_Diffuse=0.7128 Vessel_Ambient=0.125 Vessel_Brilliance=1.02; do
        povray_with "Declare=$change"
        run corcast verify tree.swc --model isosurface --size 160x120 --view iso "${HARD[@]}" -o report
        expect_status 1
        expect_json report/report.json '.exact.verdict == "differ" and any(.exact.rules[]; .name == "distance of the gain from 1" and (.met | not))'
    done
}

test_joints_as_meshes_look_like_the_exact_ones() {
    cp "$DATA/bifurcation.swc" tree.swc
    povray_with Declare=Joint_Sides=64
    run corcast verify tree.swc --model joined --size 240x180 -o report
    [ "$status" -le 1 ] || fail "expected a comparison, got exit status $status$(said)"
    [ "$(differing report/povray.png report/native.png)" -gt 0 ] || fail "expected no mesh to be exact"
    [ "$(differing report/povray.png report/native.png 2)" -le 4 ] ||
        fail "expected meshes of 64 sides to be within 2 levels, but for 4 pixels"
}

test_joints_that_break_down_are_drawn_alike_to_the_letter() {
    run_ok corcast grow --terminals 600 --seed 3 --lambda 0 -o tree.swc
    run corcast verify tree.swc --model joined --joints paper --size 300x225 -o report
    [ "$status" -le 1 ] || fail "expected a comparison, got exit status $status$(said)"
    grep -q ',1,[0-9]*,[0-9]*,0,0)' report/scene.inc || fail "expected folded joints in the scene"
    [ "$(differing report/povray.png report/native.png 8)" -le 10 ] ||
        fail "expected at most 10 pixels off by more than 8 levels"
}

test_a_missing_segment_is_found_out() {
    local model
    tree_2d 30
    povray_sees "awk '/^ *Vessel_Cylinder\(/ && ++n == 30 { next } { print }' \"\$geometry.whole\" >\"\$geometry\""
    for model in cylinders rounded; do
        rm -rf report
        run corcast verify tree.swc --model $model --size 160x120 -o report
        expect_status 1
        expect_json report/report.json '.verdict == "differ"'
    done
}

test_verify_writes_what_formats_says() {
    run_ok corcast verify "$DATA/bifurcation.swc" --quiet --model isosurface --size 40x30 -o report
    sed -n '/^## What verify writes/,/^## /p' "$REPO/docs/FORMATS.md" | grep -v 'with `--\(witness\|background\)' |
        sed -n 's/^| \(`[^|]*`\) |.*/\1/p' | tr -d '`,' | tr ' ' '\n' | sort >said
    ls report | sort >written
    expect_same said written
}

# All looks. Effects of a look that POV-Ray cannot draw are left out.
test_every_look_agrees_but_for_what_is_said_to_be_left_out() {
    local look
    cp "$DATA/bifurcation.swc" tree.swc
    for look in $(corcast looks | grep -v 'not in POV-Ray' | cut -f 1); do
        run_ok corcast verify tree.swc --size 60x45 --model rounded --smooth off --look "$look" -o "$look"
        if grep -q "also in POV-Ray" <(corcast looks | grep "^$look	"); then
            [ ! -s stderr ] || fail "expected nothing to be left out of $look, got: $(cat stderr)"
        else
            expect_sentence "^corcast: --look $look: only corcast draws .*; both pictures omit them"
        fi
    done
}

# The fade is part of the texture of every model, and of the picture that is compared.
test_fading_agrees_in_every_model() {
    local model
    run_ok corcast grow --quiet --terminals 8 --domain ball:20 -o tree.swc
    printf '[fade]\nnearest = 0.2\nfarthest = 0.9\n[background]\ncolor = 0 0 1\n[light key]\n' >fading.ini
    for model in $(corcast models | cut -f 1); do
        run_ok corcast verify tree.swc --quiet --size 60x45 --model "$model" --view iso --projection perspective \
            --color-by flow --look ./fading.ini -o "$model"
        run_ok corcast verify tree.swc --quiet --size 60x45 --model "$model" --look ./fading.ini -o "$model-one"
        grep -q 'Fade_Farthest = 0.9' "$model/scene.pov" || fail "expected the fade in the scene of $model"
    done
}

run_tests "$@"
