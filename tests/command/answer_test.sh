#!/usr/bin/env bash
# `answer`, and pictures that `compare` grades by it: pictures of our own renderers are certified, and
# pictures of renderers with a planted fault are not.
. "$(dirname "$0")/../lib.sh"

# make_answer T N OPTION ...: the answer of T by the pattern N, and the exact picture of T.
make_answer() {
    local tree=$1 n=$2
    shift 2
    run_ok corcast answer "$tree" --size 96x96 --ao 0 --pattern "$n" "$@" -o answer.exr
    expect_stdout ' 9[12][0-9][0-9] of 9216 pixels decided '
    run_ok corcast render "$tree" --size 96x96 --ao 0 --exact --antialias "$n" "$@" -o exact.png
}

expect_certified() {
    run corcast compare answer.exr "$1"
    expect_status 0
    expect_stdout '^certified: 0 of 9216 pixels outside; [0-9] undecided$'
}

# expect_refused PICTURE N: at least N pixels are outside.
expect_refused() {
    run corcast compare answer.exr "$1" --json
    expect_status 1
    expect_json stdout ".certified == false and .outside >= ${2-1}"
}

test_exact_pictures_are_certified() {
    make_answer "$DATA/trifurcation.swc" 3 --shadows on
    expect_certified exact.png
    make_answer "$DATA/trifurcation.swc" 2 --model cylinders --projection perspective --view iso --shadows on
    expect_certified exact.png
    make_answer "$DATA/messy.swc" 1 --color-by radius --look data --shadows on # negative lights
    expect_certified exact.png
    make_answer "$DATA/trifurcation.swc" 1 --look dark --shadows on # area lights
    expect_certified exact.png
}

# The ground has a finish of its own and receives shadows.
test_pictures_of_a_ground_are_certified() {
    cp "$REPO/tests/golden/hard.ini" ground.ini
    printf '[ground]\nnormal = 0.3 0.2 1\ngap = 0.1\ncolor = 0.6 0.7 0.8\nambient = 0.2\n' >>ground.ini
    run_ok corcast answer "$DATA/trifurcation.swc" --size 24x24 --shadows on --look ./ground.ini --area \
        -o a.exr --certificate proof.json
    run python3 "$REPO/tests/oracle/check_answer.py" proof.json 1
    expect_status 0
    make_answer "$DATA/trifurcation.swc" 1 --look ./ground.ini --shadows on
    expect_certified exact.png
    sed -i 's/gap = 0.1/gap = 0.2/' ground.ini
    run_ok corcast render "$DATA/trifurcation.swc" --size 96x96 --ao 0 --exact --look ./ground.ini --shadows on -o faulty.png
    expect_refused faulty.png 10
}

# expect_faults_found MODEL: exact pictures with 0.1 % more radius, and without shadows, are refused, and so
# are changed numbers by the checker of certificates. Unchanged certificates are proved.
expect_faults_found() {
    local tree=$DATA/trifurcation.swc options="--ao 0 --model $1"
    # shellcheck disable=SC2086
    make_answer "$tree" 2 $options --shadows on
    awk '/^#/ || NF < 7 { print; next } { $6 *= 1.001; print }' "$tree" >thicker.swc
    # shellcheck disable=SC2086
    run_ok corcast render thicker.swc --size 96x96 --exact --antialias 2 --shadows on $options -o faulty.png
    expect_refused faulty.png 10
    # shellcheck disable=SC2086
    run_ok corcast render "$tree" --size 96x96 --exact --antialias 2 --shadows off $options -o faulty.png
    expect_refused faulty.png 10
    # shellcheck disable=SC2086
    run_ok corcast answer "$tree" --size 24x24 --shadows on --look "$REPO/tests/golden/hard.ini" $options -o a.exr --certificate proof.json
    run python3 "$REPO/tests/oracle/check_answer.py" proof.json
    expect_status 0
    sed 's/"radius":\([0-9.]*\)/"radius":\100001/' proof.json >changed.json
    run python3 "$REPO/tests/oracle/check_answer.py" changed.json
    expect_status 1
    run corcast answer "$tree" --model "$1" --area -o a.exr
    expect_status 2
    expect_sentence "no bounds can be proved yet for the model $1; use --pattern instead of --area, or one of the models cylinders, rounded and mesh"
}

test_isosurfaces_are_certified_and_planted_faults_in_them_are_found() {
    local options
    for options in '--shadows on' '--potential graph --projection perspective --view iso --shadows on' \
        '--look dark --shadows on'; do
        # shellcheck disable=SC2086
        make_answer "$DATA/trifurcation.swc" 2 --model isosurface $options
        expect_certified exact.png
    done
    expect_faults_found isosurface
}

# Slow: the checker computes rays of both models with 50 digits.
test_blobs_and_joined_vessels_are_certified_and_planted_faults_in_them_are_found() {
    local model options
    for model in blob joined; do
        for options in '--shadows on' '--projection perspective --view iso --shadows on' '--look dark --shadows on'; do
            # shellcheck disable=SC2086
            make_answer "$DATA/trifurcation.swc" 2 --model $model $options
            expect_certified exact.png
        done
        expect_faults_found $model
    done
}

test_meshes_are_certified_and_planted_faults_in_them_are_found() {
    local tree=$DATA/trifurcation.swc options
    for options in '--shadows on' '--projection perspective --view iso --shadows on'; do
        # shellcheck disable=SC2086
        make_answer "$tree" 1 --model mesh $options
        expect_certified exact.png
    done
    run_ok corcast render "$tree" --size 96x96 --exact --projection perspective --view iso --ao 0 --model mesh \
        --shadows on --mesh-tolerance 0.04 -o faulty.png
    expect_refused faulty.png 10
    run_ok corcast answer "$tree" --size 20x20 --shadows on --look "$REPO/tests/golden/hard.ini" --pattern 1 --model mesh --mesh-tolerance 0.1 \
        -o a.exr --certificate proof.json
    run python3 "$REPO/tests/oracle/check_answer.py" proof.json
    expect_status 0
}

# Areas of triangles are cut exactly along edges. The checker tests points of two pixels.
test_areas_of_meshes_are_proved() {
    run_ok corcast answer "$DATA/trifurcation.swc" --size 16x16 --shadows off --area --width 1/50 --leaves 100 \
        --model mesh --mesh-tolerance 0.1 -o a.exr --certificate proof.json
    keep_each_third proof.json
    keep_each_third proof.json
    run python3 "$REPO/tests/oracle/check_answer.py" proof.json 2
    expect_status 0
}

test_planted_faults_are_found() {
    make_answer "$DATA/trifurcation.swc" 3 --shadows on
    awk '/^#/ || NF < 7 { print; next } { $6 *= 1.001; print }' "$DATA/trifurcation.swc" >thicker.swc
    run_ok corcast render thicker.swc --size 96x96 --exact --antialias 3 --shadows on --ao 0 -o faulty.png
    expect_refused faulty.png 10
    run_ok corcast render "$DATA/trifurcation.swc" --size 96x96 --exact --antialias 3 --shadows off --ao 0 -o faulty.png
    expect_refused faulty.png 10
    run_ok corcast render "$DATA/trifurcation.swc" --size 96x96 --exact --antialias 2 --shadows on --ao 0 -o faulty.png
    expect_refused faulty.png 10
    run corcast compare faulty.png answer.exr
    expect_sentence 'answer.exr is an answer; give it as A, before the picture'
    run corcast compare answer.exr faulty.png -o distances.png
    expect_status 1
    expect_stdout '^not certified: [0-9]+ of 9216 pixels outside'
    expect_stdout '^worst: .* levels too (bright|dark) in (red|green|blue) at column [0-9]+, row [0-9]+'
    expect_file distances.png
}

test_our_other_renderers_are_certified() {
    local options
    cp "$REPO/tests/golden/hard.ini" hard.ini # these renderers approximate soft shadows
    for options in '--look ./hard.ini --model rounded' '--look ./hard.ini --model cylinders --projection perspective'; do
        # shellcheck disable=SC2086
        make_answer "$DATA/trifurcation.swc" 3 --shadows on $options
        # shellcheck disable=SC2086
        run_ok corcast render "$DATA/trifurcation.swc" --size 96x96 --ao 0 --shadows on $options --method raster -o raster.png
        expect_certified raster.png
        # shellcheck disable=SC2086
        run_ok corcast render "$DATA/trifurcation.swc" --size 96x96 --ao 0 --shadows on $options -o tiles.png
        expect_certified tiles.png
    done
}

test_area_answers_of_two_ways_intersect_and_decide_all_pixels() {
    local tree=$DATA/trifurcation.swc options
    cp "$REPO/tests/golden/hard.ini" hard.ini # a light of many points takes many times longer
    for options in '--look ./hard.ini --model rounded --shadows on' \
        '--look ./hard.ini --model cylinders --projection perspective --view iso --shadows on'; do
        # shellcheck disable=SC2086
        run_ok corcast answer "$tree" --size 20x20 --area $options -o turned.exr
        expect_stdout ' 400 of 400 pixels decided to 1/510'
        # shellcheck disable=SC2086
        run_ok corcast answer "$tree" --size 20x20 --area --squares --width 1/1500 $options -o squares.exr
        expect_stdout ' 400 of 400 pixels decided to 1/1500'
        run corcast compare turned.exr squares.exr
        expect_status 0
    done
    # shellcheck disable=SC2086
    run_ok corcast answer "$tree" --size 20x20 --area $options --filter 1.1 -o wide.exr
    run_ok python3 "$REPO/tests/oracle/answer_picture.py" wide.exr wide.ppm
    run corcast compare turned.exr wide.ppm
    expect_status 1
    run corcast compare wide.exr wide.ppm
    expect_status 0
}

# Vessels thinner than a pixel are drawn by coverage. Their pictures are not exact, but nearer to the
# area answer than samples are.
test_thin_vessels_are_near_their_area_answers() {
    run_ok corcast grow --terminals 100 --seed 5 -o tree.swc
    run_ok corcast answer tree.swc --size 60x60 --area --shadows off -o answer.exr
    run_ok corcast render tree.swc --size 60x60 --shadows off -o covered.png
    run corcast compare answer.exr covered.png --json
    cp stdout covered.json
    run_ok corcast render tree.swc --size 60x60 --shadows off --exact --antialias 3 -o sampled.png
    run corcast compare answer.exr sampled.png --json
    cp stdout sampled.json
    expect_json covered.json '.worst_levels | fabs < 22'
    expect_json covered.json '[.mean_red, .mean_green, .mean_blue] | map(fabs) | max < 0.06'
    jq -se '.[0].outside < 0.7 * .[1].outside and (.[0].worst_levels | fabs) < 0.5 * (.[1].worst_levels | fabs)' \
        covered.json sampled.json >/dev/null || fail "expected coverage to be nearer to the areas than samples"
}

test_answers_of_one_scene_are_consistent_and_others_are_refused() {
    make_answer "$DATA/trifurcation.swc" 2 --shadows on
    cp answer.exr first.exr
    run corcast compare first.exr answer.exr
    expect_status 0
    run_ok corcast answer "$DATA/trifurcation.swc" --size 96x96 --ao 0 --pattern 2 --shadows off -o other.exr
    run corcast compare first.exr other.exr
    expect_status 2
    expect_sentence 'different scenes'
    run_ok corcast render "$DATA/trifurcation.swc" --size 96x80 --exact -o small.png
    run corcast compare first.exr small.png
    expect_status 2
    expect_sentence '96 x 96 pixels and the picture 96 x 80'
}

# keep_each_third PROOF.json: removes two thirds of the pixels.
keep_each_third() {
    python3 - "$1" <<'END'
import json, sys
proof = json.load(open(sys.argv[1]))
proof["pixels"] = proof["pixels"][::3]
json.dump(proof, open(sys.argv[1], "w"))
END
}

# The checker computes rays with 50 digits and sums in exact fractions, and shares no code. It knows
# no area lights.
test_certificates_are_proved_and_changed_ones_are_not() {
    local tree=$DATA/trifurcation.swc check=$REPO/tests/oracle/check_answer.py options
    for options in '--pattern 2' '--pattern 1 --model cylinders --projection perspective --view iso' '--area'; do
        # shellcheck disable=SC2086
        run_ok corcast answer "$tree" --size 24x24 --shadows on --look "$REPO/tests/golden/hard.ini" $options -o a.exr --certificate proof.json
        [ "$options" != --area ] || keep_each_third proof.json # areas have a thousand times the claims of samples
        run python3 "$check" proof.json 1
        expect_status 0
        expect_stdout '^([6-9]|[12][0-9]) of \1 pixels proved$'
    done
    run_ok corcast answer "$tree" --size 40x40 --shadows on --look "$REPO/tests/golden/hard.ini" --pattern 2 -o a.exr --certificate proof.json
    sed 's/"location":\[\([-0-9.]*\)/"location":[\1001/' proof.json >changed.json
    run python3 "$check" changed.json
    expect_status 1
    expect_stdout 'the mean of its samples is outside'
}

test_scenes_without_an_answer_are_refused_by_the_option() {
    local tree=$DATA/trifurcation.swc
    refuse() {
        run corcast answer "$tree" -o a.exr "$@"
        expect_status 2
    }
    refuse --ao 8
    expect_sentence '^corcast answer: --ao: '
    refuse --look ink --ao 0
    expect_sentence '^corcast answer: --look: no bounds can be proved for outlines'
    refuse --look studio
    expect_sentence '^corcast answer: --look: no bounds can be proved for ambient occlusion'
    refuse --background none
    expect_sentence '^corcast answer: --background: .none. is not '
    run_ok corcast answer --help
    ! grep -qE '^  --(antialias|color-blend|erf|cell-beta) ' stdout ||
        fail 'expected no option that has no effect'
    # vessels behind the camera, a camera in a vessel, an orthographic camera between vessels
    for place in '--projection perspective --location 0,0,0 --look-at 1,0,0' '--location 12,24,-4 --look-at 12,24,-14' \
        '--projection perspective --location 11.5625,22.375,-4 --look-at 15.75,29.375,-2.5'; do
        # shellcheck disable=SC2086
        refuse --ao 0 $place
        expect_sentence '^corcast answer: --location: a vessel is not in front of the camera'
    done
    refuse --width 3
    expect_sentence '^corcast answer: --width is .3.'
}

test_bytes_do_not_depend_on_threads() {
    run_ok corcast answer "$DATA/trifurcation.swc" --size 100x90 --pattern 2 --shadows on --threads 1 -o one.exr
    run_ok corcast answer "$DATA/trifurcation.swc" --size 100x90 --pattern 2 --shadows on --threads 3 -o three.exr
    run corcast compare one.exr three.exr
    expect_status 0
    tail -c 20000 one.exr >one.tail
    tail -c 20000 three.exr >three.tail
    expect_same one.tail three.tail
}

run_tests "$@"
