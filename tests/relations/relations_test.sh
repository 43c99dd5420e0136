#!/usr/bin/env bash
# Metamorphic relations: pairs of scenes that must give the same picture, mesh, voxels or numbers
# [relations.py].
. "$(dirname "$0")/../lib.sh"

# holds RELATION...: the relations hold for PAIRS (default 3) random pairs of the seed SEED (default
# 1).
holds() {
    /usr/bin/python3 -c 'import numpy' 2>import.log || skip "python3-numpy is not installed"
    run /usr/bin/python3 "$REPO/tests/relations/relations.py" "$CORCAST" "$@" --pairs "${PAIRS:-3}" --seed "${SEED:-1}"
    [ "$status" -eq 0 ] || fail "$(cat stdout stderr)"
}

test_pictures_do_not_depend_on_threads_bands_tiles_or_planes() {
    holds threads tiles planes
}

test_pictures_do_not_depend_on_ids_or_the_order_of_rows() {
    holds ids rows
}

test_pictures_scale_with_all_lengths() {
    holds scale
}

test_pictures_follow_motions_of_scene_and_camera() {
    holds translation rotation mirror
}

test_pictures_do_not_depend_on_the_order_of_lights() {
    holds lights
}

test_pictures_do_not_depend_on_where_a_segment_is_split() {
    holds split
}

test_a_taller_picture_holds_the_smaller_one() {
    holds crop
}

test_kernels_draw_the_same_picture() {
    holds kernels
}

test_vessels_beside_the_frame_or_behind_the_camera_change_nothing() {
    holds outside behind
}

test_meshes_follow_motions_and_scale_with_all_lengths() {
    holds export
}

test_voxels_follow_motions_and_scale_with_all_lengths() {
    holds voxels
}

test_numbers_and_diagrams_follow_motions() {
    holds info diagram certify
}

test_growth_scales_with_domain_and_flow() {
    holds grow
}

run_tests
