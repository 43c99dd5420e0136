#!/usr/bin/env bash
# libcorcast: gives the same bytes as the command line; wrong use, threads, surroundings, failing
# allocations, the installed files, and the stored binary interface.
. "$(dirname "$0")/../lib.sh"

API=$REPO/build/release/tests/api
LIBRARY=$REPO/build/release/libcorcast.so.0
FAILING=$REPO/build/release/tests/failing.so

session() {
    "$API/session" "$@"
}

test_growth_has_the_bytes_of_the_command_line() {
    run_ok corcast grow --terminals 300 --seed 5 --gamma 2.7 --inlet 0,50 -o program.swc
    run_ok session grow library.swc terminals=300 seed=5 gamma=2.7 inlet=0,50
    expect_same program.swc library.swc
    run_ok corcast grow --terminals 60 --domain ball:20 --refine topology --refine-moves 500 -o program2.swc
    run_ok session grow library2.swc terminals=60 domain=ball:20 refine=topology refine-moves=500
    expect_same program2.swc library2.swc
}

test_refinement_has_the_bytes_of_the_command_line() {
    grow_tree 40
    run_ok corcast refine tree.swc --refine topology --refine-moves 2000 -o program.swc
    run_ok session refine tree.swc library.swc refine=topology refine-moves=2000
    expect_same program.swc library.swc
}

test_pictures_of_all_models_have_the_bytes_of_the_command_line() {
    local model
    grow_tree 30
    for model in $(corcast models | cut -f 1); do
        run_ok corcast render tree.swc --model "$model" --size 97x61 -o program.png
        run_ok session export render tree.swc library.png "model=$model" size=97x61
        expect_same program.png library.png
        run_ok corcast render tree.swc --model "$model" --size 97x61 -o program.ppm
        run_ok session render tree.swc library.ppm "model=$model" size=97x61
        expect_same <(pnmtoplainpnm program.ppm) <(pnmtoplainpnm library.ppm)
    done
}

test_files_have_the_bytes_of_the_command_line() {
    local name
    grow_tree 30
    mkdir program library bytes
    for name in t.pov t.scad t.tachyon; do
        run_ok corcast scene tree.swc -o "program/$name"
        run_ok session export scene tree.swc "library/$name"
        run_ok session bytes scene tree.swc "bytes/$name"
    done
    for name in t.stl t.glb t.3mf t.ply; do
        run_ok corcast export tree.swc -o "program/$name"
        run_ok session export export tree.swc "library/$name"
        run_ok session bytes export tree.swc "bytes/$name"
    done
    run_ok diff -r program library
    run_ok diff -r program bytes
}

test_comparison_has_the_report_of_the_command_line() {
    grow_tree 20
    run_ok corcast render tree.swc --size 60x40 -o a.png
    run_ok corcast render tree.swc --size 60x40 --look journal -o b.png
    run corcast compare a.png b.png --json
    expect_status 1
    mv stdout program.json
    run session compare a.png b.png
    expect_status 1
    expect_same program.json stdout
    run_ok session compare a.png a.png
}

test_facts_and_conversions_are_those_of_the_command_line() {
    grow_tree 20
    run_ok corcast info tree.swc --json --stats
    jq -S 'del(.reading.format, .format)' stdout >program.json
    run_ok session info tree.swc stats=on
    jq -S 'del(.reading.format, .format)' stdout >library.json
    expect_same program.json library.json
    run_ok session convert tree.swc same.swc
    expect_same tree.swc same.swc
    run_ok corcast render tree.swc --size 60x40 -o picture.ppm
    mkdir recoded
    run_ok session recode picture.ppm recoded/same.ppm
    expect_same picture.ppm recoded/same.ppm
}

test_pulses_flows_coverage_and_answers_are_those_of_the_command_line() {
    local kept='del(.command)'
    run_ok corcast grow --terminals 12 --domain ball:20 --seed 3 --quiet -o tree.swc
    run_ok corcast pulse tree.swc --fields wss,dilation --frames 3 --json -o program.vtp
    mv stdout program.json
    run_ok session pulse library.vtp tree.swc fields=wss,dilation frames=3
    expect_same program.json stdout
    expect_same <(strings -n 8 program.vtp | grep -v corcast) <(strings -n 8 library.vtp | grep -v corcast)
    run_ok corcast convert library.vtp again.csv --quiet
    grep -q '"wss_0.333333 \[Pa\]"' again.csv || fail "columns: $(head -20 again.csv)"
    run_ok corcast flow tree.swc --q-perf 60 --json -o program.vtp
    mv stdout program.json
    run_ok session flow library.vtp tree.swc q-perf=60
    expect_same program.json stdout
    expect_same <(strings -n 8 program.vtp | grep -v corcast) <(strings -n 8 library.vtp | grep -v corcast)
    run session flow library.vtp tree.swc ends=closed
    expect_status 2
    run_ok session export pulse tree.swc deck.json outlet-time=1.5
    run_ok corcast pulse tree.swc --outlet-time 1.5 -o same.json
    expect_same deck.json same.json
    run session export pulse tree.swc beat.pov
    expect_status 2
    run_ok corcast coverage tree.swc --spacing 2 --json program.json
    run_ok session coverage tree.swc spacing=2
    expect_same <(jq "$kept" program.json) <(jq "$kept" stdout)
    run_ok session export coverage tree.swc library.nii spacing=2
    run_ok corcast coverage tree.swc --spacing 2 -o program.nii
    expect_same program.nii library.nii
    run_ok corcast answer tree.swc --size 40x30 -o program.exr
    run_ok session answer library.exr tree.swc size=40x30
    expect_same program.exr library.exr
    jq -e '.pixels == 1200 and .undecided < 100 and (.scene | length) == 64' stdout >/dev/null || fail "report: $(cat stdout)"
}

test_wrong_use_is_an_error_with_a_sentence() {
    run_ok "$API/misuse"
}

test_signals_umask_locale_and_streams_stay_untouched() {
    run_ok "$API/surroundings"
    [ ! -s stdout ] || fail "expected nothing on standard output, got: $(cat stdout)"
    [ ! -s stderr ] || fail "expected nothing on standard error, got: $(cat stderr)"
    corcast grow --terminals 300 --gamma 2.75 --quiet -o program.swc
    expect_same program.swc library.swc
}

test_a_locale_with_commas_changes_no_byte() {
    localedef -f UTF-8 -i de_DE ./de_DE.UTF-8 2>/dev/null || skip "localedef cannot make a locale here"
    LOCPATH=$PWD LC_ALL=de_DE.UTF-8 run_ok "$API/surroundings"
    corcast grow --terminals 300 --gamma 2.75 --quiet -o program.swc
    expect_same program.swc library.swc
}

test_two_threads_use_two_handles() {
    run_ok "$API/threads"
}

# expect_failing K ARGUMENT...: runs the session once for every K-th allocation and lets that
# allocation fail; with ALLOC=all, for every allocation.
expect_failing() {
    FAILING_STEP=$([ "${ALLOC:-}" = all ] && echo 1 || echo "$1") run env LD_PRELOAD="$FAILING" "$API/session" "${@:2}"
    expect_status 0
}

test_failing_allocations_are_errors() {
    local tree=$PWD/tree.swc
    grow_tree 6
    expect_failing 7 grow out.swc terminals=4 threads=1
    expect_failing 7 info "$tree" threads=1
    expect_failing 7 convert "$tree" out.vtp
    expect_failing 29 render "$tree" out.ppm size=20x16 threads=1
    run_ok corcast render "$tree" --size 20x16 -o picture.png
    # Without .tif: an allocation that fails in libtiff ends a program that uses the library [tiff_stream.c].
    expect_failing 5 recode "$PWD/picture.png" ./out.png
    if [ "${ALLOC:-}" = all ]; then
        expect_failing 1 refine "$tree" out.swc threads=1
        FAILING_OUTPUTS=many expect_failing 1 export export "$tree" out.stl threads=1
    fi
}

test_only_the_functions_of_the_header_are_visible() {
    nm -D --defined-only "$LIBRARY" | awk '$2 == "T" { sub("@.*", "", $3); print $3 }' | sort >visible
    grep -oE '^CORCAST_API .*|^ +\*?corcast_[a-z_]+\(' "$REPO/src/corcast.h" | grep -oE 'corcast_[a-z_]+\(' | tr -d '(' | sort >declared
    expect_same declared visible
    sed -n 's/^ \(corcast_[a-z_]*\)@.*/\1/p' "$REPO/.ci/packages/debian/libcorcast0.symbols" >packaged
    expect_same declared packaged
    readelf -d "$LIBRARY" | grep -q 'SONAME.*\[libcorcast.so.0\]' || fail "expected the SONAME libcorcast.so.0"
}

test_the_binary_interface_is_the_stored_one() {
    command -v abidiff >/dev/null || skip "abidiff is not installed (Debian package abigail-tools)"
    mkdir headers
    cp "$REPO/src/corcast.h" headers
    run abidiff --drop-private-types --headers-dir2 headers "$REPO/tests/api/libcorcast.abi" "$LIBRARY"
    [ "$status" -eq 0 ] || fail "the binary interface has changed (make abi stores it): $(cat stdout)"
}

test_the_header_is_c_and_cxx() {
    echo '#include "corcast.h"' >header.c
    cp header.c header.cc
    run_ok "${CC:-cc}" -std=c11 -Wall -Wextra -Wpedantic -Werror -I "$REPO/src" -c header.c
    command -v c++ >/dev/null || skip "there is no C++ compiler"
    run_ok c++ -std=c++11 -Wall -Wextra -Wpedantic -Werror -I "$REPO/src" -c header.cc
}

test_a_program_builds_against_an_installed_library() {
    run_ok make -C "$REPO" --no-print-directory install PREFIX="$PWD/usr"
    run_ok env PKG_CONFIG_PATH="$PWD/usr/lib/pkgconfig" pkg-config --modversion corcast
    # shellcheck disable=SC2046
    run_ok "${CC:-cc}" -Wall -Werror "$REPO/docs/examples/tree.c" -o example \
        $(PKG_CONFIG_PATH=$PWD/usr/lib/pkgconfig pkg-config --cflags --libs corcast) "-Wl,-rpath,$PWD/usr/lib"
    mkdir made
    run_ok env -i ./example made
    expect_stdout '^399 segments'
    expect_file made/tree.swc
    expect_file made/tree.png
    expect_file made/tree.stl
    [ -s usr/share/man/man3/corcast.h.3 ] || fail "expected the manual page corcast.h(3)"
    run_ok make -C "$REPO" --no-print-directory uninstall PREFIX="$PWD/usr"
    run find usr -type f
    [ ! -s stdout ] || fail "expected uninstall to leave no file, found: $(cat stdout)"
}

run_tests
