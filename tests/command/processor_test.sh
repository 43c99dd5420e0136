#!/usr/bin/env bash
# The same bytes on every processor. glibc chooses its versions of pow, exp, log, sin, cos and
# others by the processor. These tests hide fused multiply-add from glibc, as on a processor without
# it.
. "$(dirname "$0")/../lib.sh"

without_fma() {
    GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F corcast "$@"
}

# expect_alike OPTION...: `grow` writes the same tree with fused multiply-add and without.
expect_alike() {
    run_ok corcast grow --quiet --terminals 120 --seed 3 "$@" -o with.swc
    run_ok without_fma grow --quiet --terminals 120 --seed 3 "$@" -o without.swc
    expect_same with.swc without.swc
}

test_usual_exponents_grow_the_same_bytes() {
    expect_alike
    expect_alike --domain ball:30
    expect_alike --inlet 0,50 --inlet 30,-40 --inlet-shares 0.7,0.3
    expect_alike --terminal-flow territory
    expect_alike --terminals 60 --refine topology
}

test_other_exponents_grow_the_same_bytes() {
    expect_alike --gamma 2.1
    expect_alike --gamma 2.55 --lambda 1
    expect_alike --gamma 2.7 --lambda 1.5
    expect_alike --gamma 2.8 --domain ball:30
    expect_alike --gamma 0.1:2.1,1:3
    expect_alike --lambda 3
}

test_viscosity_of_pries_annealing_and_pairs_grow_the_same_bytes() {
    expect_alike --viscosity-law pries
    expect_alike --terminals 40 --viscosity-law pries --refine topology
    expect_alike --terminals 40 --gamma 2.7 --refine anneal --refine-moves 20000
    expect_alike --domain ball:30 --pair 1 --inlet 0,0,30 --inlet 0,0,-30 --clearance 0.05
}

# expect_file_alike FILE COMMAND OPTION...: the command writes the same bytes into FILE with fused
# multiply-add and without, except times in JSON.
expect_file_alike() {
    local file=$1
    shift
    run_ok corcast "$@"
    grep -av '"seconds"' "$file" >with
    run_ok without_fma "$@"
    grep -av '"seconds"' "$file" >without
    expect_same with without
}

test_reports_scenes_meshes_voxels_and_pictures_are_the_same_bytes() {
    run_ok corcast grow --quiet --terminals 60 --seed 3 --domain ball:20 --gamma 2.55 --lambda 1.5 -o tree.swc
    expect_file_alike stdout info --json tree.swc
    expect_file_alike stdout certify --json tree.swc
    expect_file_alike scene.pov scene tree.swc --model joined --look journal -o scene.pov
    expect_file_alike mesh.stl export tree.swc --model rounded -o mesh.stl
    expect_file_alike mesh.glb export tree.swc --model isosurface -o mesh.glb
    expect_file_alike voxels.nii export tree.swc -o voxels.nii --spacing 1
    expect_file_alike tree.svg diagram tree.swc -o tree.svg
    expect_file_alike picture.ppm render tree.swc --model joined --exact --size 97x61 -o picture.ppm
    expect_file_alike picture.ppm render tree.swc --model isosurface --hits povray --size 97x61 -o picture.ppm
}

run_tests "$@"
