#!/usr/bin/env bash
# compare: metrics of small pictures written by hand, so that the right numbers are known.
. "$(dirname "$0")/../lib.sh"

# A grey PPM of 5 x 4 with code 100, pixel 7 (counted from 0) replaced by the code given.
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
        run_ok corcast render $tree.swc --size 40x40 --location 0,0,30 --look-at 0,0,0 --height 20 \
            --planes depth -o $tree.ppm
    done
    run_ok corcast compare thick.depth.pfm thick.depth.pfm
    run corcast compare thick.depth.pfm thin.depth.pfm
    expect_status 1
}

run_tests "$@"
