#!/usr/bin/env bash
# The build: compilers, guarantees of the Makefile, the dependency script, and rules for the
# sources.
. "$(dirname "$0")/lib.sh"

CLANG_CORCAST=$REPO/build/clang/corcast

test_gcc_and_clang_grow_the_same_bytes() {
    local seed
    for seed in 1 5; do
        run_ok corcast grow --terminals 120 --seed "$seed" --gamma 2.7 -o gcc.swc
        run_ok "$CLANG_CORCAST" grow --terminals 120 --seed "$seed" --gamma 2.7 -o clang.swc
        expect_same gcc.swc clang.swc
    done
    run_ok corcast grow --terminals 60 --domain ball:20 -o gcc.swc
    run_ok "$CLANG_CORCAST" grow --terminals 60 --domain ball:20 -o clang.swc
    expect_same gcc.swc clang.swc
}

test_gcc_and_clang_render_the_same_bytes() {
    local model suffix
    grow_tree 30
    for model in $(corcast models | cut -f 1); do
        run_ok corcast render --exact tree.swc --model $model --size 97x61 --planes depth,normal,id -o gcc.pfm
        run_ok "$CLANG_CORCAST" render --exact tree.swc --model $model --size 97x61 --planes depth,normal,id -o clang.pfm
        for suffix in pfm depth.pfm normal.pfm id.ppm; do
            expect_same gcc.$suffix clang.$suffix
        done
    done
}

test_gcc_and_clang_export_the_same_bytes() {
    local file
    grow_tree 30
    for file in tree.stl 'tree.3mf --lattice' tree.py; do
        run_ok corcast export --quiet tree.swc -o $file
        mv ${file% *} gcc
        run_ok "$CLANG_CORCAST" export --quiet tree.swc -o $file
        expect_same gcc ${file% *}
    done
}

test_continuous_integration_runs_the_test_command_of_the_readme() {
    grep -qx 'make check' "$REPO/.ci/run" || fail "expected .ci/run to call make check"
    grep -q 'make check' "$REPO/README.md" || fail "expected README.md to name make check"
    grep -q 'make demo' "$REPO/README.md" || fail "expected README.md to name make demo"
}

test_the_tables_of_elementary_functions_are_those_of_their_script() {
    "$REPO/tests/elementary/tables" 2>bounds | clang-format --style="file:$REPO/.clang-format" >tables.h
    expect_same tables.h "$REPO/src/base/elementary_tables.h"
    grep -q 'log <= 0.50001 ulp, exp <= 0.5079 ulp, pow <= 0.5172 ulp' bounds || fail "expected the bounds of METHODS.md 3.10, got: $(cat bounds)"
}

# No failed allocation is forgotten: the characters of a text that failed are NULL, and JSON made of
# NULL is NULL.
test_texts_and_json_are_made_by_the_functions_that_carry_a_failure_on() {
    local found
    found=$(cd "$REPO" && grep -nE '(\.|->)chars\b|json_(object_(set|update)|array_(append|set|insert)|string\(|dump)' \
        src/*/*.[ch] src/*/*/*.[ch] | grep -v '^src/base/')
    [ -z "$found" ] || fail "expected text_chars, json_with, json_text and text_json in place of: $found"
}

# Code tests properties of a model's row and never its name. A new model of known elements is
# therefore one new row.
test_no_source_names_a_model_outside_the_table() {
    local names found
    names=$(sed -n 's/^    X(\([A-Z]*\), .*/\1/p' "$REPO/src/scene/models.h" | paste -sd '|')
    [ -n "$names" ] || fail "expected the rows of MODEL_TABLE in src/scene/models.h"
    found=$(cd "$REPO" && grep -rnE "\bSCENE_($names)\b" src || true)
    [ -z "$found" ] || fail "expected a property of the model [scene/models.h] in place of: $found"
}

# If two tests had the same name, the later one would run twice and the earlier one never.
test_no_test_file_names_two_tests_alike() {
    local file twice
    for file in "$REPO"/tests/*_test.sh "$REPO"/tests/*/*_test.sh; do
        twice=$(sed -n 's/^test_\([a-z0-9_]*\)() *{.*/\1/p' "$file" | sort | uniq -d)
        [ -z "$twice" ] || fail "$file has two tests $twice"
    done
}

test_every_source_opens_with_its_design() {
    local file
    for file in $(cd "$REPO" && find src -name '*.c'); do
        head -1 "$REPO/$file" | grep -q '^/\*' || fail "expected $file to open with a comment that says how it works"
    done
}

# `make power` takes long and is run rarely. This test checks that its faults can still be planted.
test_every_fault_of_make_power_changes_its_file() {
    local file edit
    sed -n "/cat <<'FAULTS'/,/^FAULTS/p" "$REPO/tests/power/run-shared" | sed '1d;$d' >shared
    ! awk -F '|' 'NF != 3' shared | grep . || fail "expected a name, a file and an edit without | in each line of run-shared"
    {
        cut -d '|' -f 2,3 shared
        sed -z 's/\\\n */ /g' "$REPO/tests/power/run" | sed -nE "s/^ *(mutant|faulty) \"[^\"]*\" (src[^ ]*) '([^']*)'.*/\2|\3/p
            s/^ *mutant [a-z]+ (src[^ ]*) '([^']*)'.*/\1|\2/p"
    } >faults
    [ "$(wc -l <faults)" -ge 50 ] || fail "expected at least 50 faults, got $(wc -l <faults)"
    while IFS='|' read -r file edit; do
        [ -f "$REPO/$file" ] || fail "a fault is to be planted in $file, which does not exist"
        ! sed "$edit" "$REPO/$file" | cmp -s - "$REPO/$file" || fail "the edit '$edit' changes nothing in $file"
    done <faults
}

test_the_release_program_is_hardened() {
    local program=$REPO/build/release/corcast
    [ -f "$program" ] || skip "this is not the release build"
    readelf -hlW "$program" >headers
    readelf -dW "$program" >dynamic
    readelf -sW --dyn-syms "$program" >symbols
    grep -q 'Type: *DYN' headers || fail "expected a position-independent program"
    grep -q 'FLAGS_1.*NOW.*PIE' dynamic || fail "expected all addresses to be bound at start"
    grep -q GNU_RELRO headers || fail "expected tables of addresses that are read-only"
    grep -qE 'GNU_STACK.* RW +0x' headers || fail "expected a stack that holds no code"
    grep -q '__stack_chk_fail' symbols || fail "expected a check of the stack"
    [ "$(grep -oE '__[a-z]+_chk@' symbols | grep -v stack | sort -u | wc -l)" -ge 4 ] ||
        fail "expected calls that check the size of their buffers, found $(grep -oE '__[a-z]+_chk@' symbols | sort -u | tr '\n' ' ')"
}

# Kernels for one kind of processor call fused multiply-add explicitly.
test_no_other_source_than_kernels_fuses_a_product_and_a_sum() {
    [ -d "$REPO/build/release/src" ] || skip "this is not the release build"
    find "$REPO/build/release/src" -name '*.o' ! -name '*avx2.o' ! -name '*avx512.o' -exec objdump -d --no-show-raw-insn {} + >code
    grep -q mulsd code || fail "expected code to read"
    ! grep -E '\bvfn?m(add|sub)' code >fused || fail "$(wc -l <fused) operations are fused: $(head -1 fused)"
}

# The umask and the locale are shared by all threads.
test_no_source_changes_the_umask_or_the_locale() {
    [ -d "$REPO/build/release/src" ] || skip "this is not the release build"
    ! find "$REPO/build/release/src" -name '*.o' -exec nm -A -u {} + | grep -E ' (umask|setlocale)$' >found ||
        fail "expected no source to change what all threads share: $(cat found)"
}

# compile_with OPTION...: compiles three objects into ./built: of growth, of base, and of kernels
# for AVX2.
compile_with() {
    local object objects=()
    for object in base/elementary grow/cco/grid render/light/occlusionkernels.avx2; do
        objects+=("$PWD/built/src/$object.o")
    done
    run make -C "$REPO" --no-print-directory V=1 MODE=release "BUILD=$PWD/built" "$@" "${objects[@]}"
}

test_flags_of_the_caller_follow_and_never_join_a_product_and_a_sum() {
    local compiler
    for compiler in gcc clang; do
        rm -rf built
        compile_with CC=$compiler CFLAGS='-O1 -march=haswell -ffp-contract=fast' CPPFLAGS=-DOF_THE_CALLER
        expect_status 0
        expect_stdout '-O2.* -O1 -march=haswell'
        expect_stdout '-Isrc.*-DOF_THE_CALLER'
        objdump -d --no-show-raw-insn built/src/*/*.o built/src/*/*/*.o >code
        grep -q '%ymm\|vmulsd' code || fail "expected the caller's processor to be used by $compiler"
        ! grep -E '\bvfn?m(add|sub)' code >fused || fail "$compiler fused $(wc -l <fused) operations: $(head -1 fused)"
    done
}

test_flags_come_from_the_environment_and_inexact_ones_are_refused() {
    export CFLAGS=-DOF_THE_ENVIRONMENT LDFLAGS=-Wl,--as-needed
    run_ok make -C "$REPO" --no-print-directory -n V=1 "BUILD=$PWD/built" "$PWD/built/corcast"
    expect_stdout '-DOF_THE_ENVIRONMENT -ffp-contract=off'
    expect_stdout '-z,now.* -Wl,--as-needed -o'
    export CFLAGS=-Ofast
    run make -C "$REPO" --no-print-directory -n
    expect_status 2
    expect_sentence '-Ofast changes results'
}

test_make_help_names_every_public_target() {
    local target
    run_ok make -C "$REPO" --no-print-directory help
    for target in all deps demo bench-compare verify-all coronary power check check-all unit layers format format-check asan tsan fuzz golden-update \
        install uninstall dist check-quick clean help; do
        expect_stdout "^  $target "
    done
}

test_make_install_puts_program_templates_and_documents_under_the_prefix() {
    run_ok make -C "$REPO" --no-print-directory install "DESTDIR=$PWD/stage" "PREFIX=/opt/my corcast"
    expect_file "stage/opt/my corcast"/bin/corcast
    expect_file "stage/opt/my corcast"/share/corcast/templates/povray/scene.pov
    (cd "stage/opt/my corcast"/share/doc/corcast &&
        for linked in $(grep -o '](docs/[^)#]*' README.md | cut -c 3- | grep -v '/decisions$'); do
            [ -s "$linked" ] || fail "expected $linked, which README links to, to be installed"
        done) || exit 1
    grow_tree 5
    run_ok "stage/opt/my corcast"/bin/corcast scene tree.swc -o installed.pov
    if /usr/bin/python3 -c 'import numpy' 2>/dev/null; then
        run_ok env -u CORCAST_TEMPLATES -u CORCAST_LIBRARY PYTHONPATH="stage/opt/my corcast/lib/python3/dist-packages" PYTHONDONTWRITEBYTECODE=1 \
            /usr/bin/python3 -c 'import corcast; corcast.read("tree.swc").render(look="journal", size=(40, 30)).save("installed.png")'
    fi
    [ ! -e "$REPO/build/viewer/viewer.js" ] || run_ok "stage/opt/my corcast"/bin/corcast export tree.swc -o installed.html
    run_ok make -C "$REPO" --no-print-directory uninstall "DESTDIR=$PWD/stage" "PREFIX=/opt/my corcast"
    [ -z "$(find stage -type f)" ] || fail "expected nothing to be left, found $(find stage -type f)"
}

test_an_object_has_the_same_bytes_in_every_folder() {
    local folder
    mkdir one two
    for folder in one two; do
        cp -R "$REPO/Makefile" "$REPO/src" "$folder"
        run_ok env CCACHE_DISABLE=1 make -C "$folder" --no-print-directory build/release/src/base/text.o
    done
    expect_same one/build/release/src/base/text.o two/build/release/src/base/text.o
}

test_a_build_folder_that_cannot_be_written_to_is_refused() {
    run make -C "$REPO" --no-print-directory BUILD=/proc/corcast program
    expect_status 2
    grep -q '^/proc/corcast cannot be written to: "make program BUILD=FOLDER" builds in another folder$' stderr || fail "expected a way out$(said)"
}

test_make_dist_packs_what_is_committed_into_the_same_bytes() {
    local name
    git -C "$REPO" rev-parse --quiet --verify HEAD >/dev/null 2>&1 || skip "these sources are no git repository"
    [ -e "$REPO/build/viewer/viewer.js" ] || skip "the viewer is not built, for want of npm, esbuild or three.js"
    name=corcast-$(corcast --version | cut -d ' ' -f 2)
    run_ok make -C "$REPO" --no-print-directory dist
    cp "$REPO/build/$name.tar.gz" first.tar.gz
    sleep 1
    run_ok make -C "$REPO" --no-print-directory dist
    expect_same "$REPO/build/$name.tar.gz" first.tar.gz
    tar -xzf first.tar.gz
    (cd "$name" && find . -type f -o -type l) | sed 's|^\./||' | sort >packed
    # A release contains the viewer, the sources of the viewer, and the page that grows trees, in
    # addition to the commit.
    git -C "$REPO" ls-tree -r --name-only HEAD | sort >committed
    grep -v -e '^templates/page/viewer.js$' -e '^templates/viewer/node_modules/three/' -e '^corcast.html$' packed >sources
    expect_same committed sources
    grep -q '^templates/page/viewer.js$' packed || fail "expected the viewer in the release"
}

# bare_path PROGRAM...: makes the folder bin with only the named programs and a dpkg-query that
# knows no package.
bare_path() {
    local program
    mkdir bin
    for program in sh "$@"; do
        ln -s "$(command -v "$program")" bin/
    done
    printf '#!/bin/sh\nexit 1\n' >bin/dpkg-query
    chmod +x bin/dpkg-query
}

test_deps_says_what_is_needed_when_there_is_no_apt() {
    bare_path id
    run env PATH="$PWD/bin" "$REPO/.ci/deps" build run
    expect_status 3
    grep -q 'not a Debian system' stderr || fail "expected the reason on standard error$(said)"
    grep -q 'install them: .*libpng-dev.* povray' stderr || fail "expected the packages to be named$(said)"
}

test_deps_says_what_is_needed_when_it_is_neither_root_nor_has_sudo() {
    bare_path
    printf '#!/bin/sh\necho 1000\n' >bin/id
    printf '#!/bin/sh\nexit 0\n' >bin/apt-get
    chmod +x bin/id bin/apt-get
    run env PATH="$PWD/bin" "$REPO/.ci/deps" build
    expect_status 3
    grep -q 'no sudo' stderr || fail "expected the reason on standard error$(said)"
    grep -q 'libjansson-dev' stderr || fail "expected the packages to be named$(said)"
}

test_without_npm_or_its_registry_the_viewer_is_not_built_and_the_reason_said() {
    bare_path dirname mkdir cmp cp grep rm
    run env PATH="$PWD/bin" "$REPO/templates/viewer/bundle" made
    expect_status 3
    expect_sentence 'esbuild is not installed; export to \.html needs it, nothing else does'
    command -v npm >npm.path && command -v esbuild >esbuild.path || skip "npm and esbuild are not installed"
    run env npm_config_registry=http://127.0.0.1:9 npm_config_cache="$PWD/cache" npm_config_fetch_retries=0 "$REPO/templates/viewer/bundle" made
    expect_status 3
    expect_sentence 'npm cannot install three.js: npm error'
    [ ! -e made/viewer.js ] || fail "expected no viewer"
}

test_deps_touches_nothing_when_everything_is_installed() {
    printf '#!/bin/sh\ntouch %s/called\n' "$PWD" >apt-get
    chmod +x apt-get
    run_ok env PATH="$PWD:$PATH" "$REPO/.ci/deps"
    [ ! -e called ] || fail "expected apt-get not to be called"
}

run_tests "$@"
