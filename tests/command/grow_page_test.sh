#!/usr/bin/env bash
# The page that grows trees: its size, its contents and, in headless Chromium, the bytes of its
# trees [tests/page/grow.js].
. "$(dirname "$0")/../lib.sh"

PAGE=$REPO/build/grow/corcast.html

need_page() {
    [ -e "$PAGE" ] || skip "the page that grows trees is not built: run \`make page\`"
}

# Prints options of `grow`, as NAME=VALUE, one tree per line. The page must grow the same bytes.
trees() {
    cat <<'END'
terminals=300 domain=ball:30 seed=5 gamma=2.7 lambda=1.5
terminals=60 domain=box:40,30,20 inlet=-20,0,0 inlet=20,0,0 pair=1.5 clearance=0.2
terminals=300 domain=disc:40
terminals=300 domain=ball:25 seed=7
terminals=200 inlet=0,50 inlet=30,-40 inlet-shares=0.7,0.3
terminals=200 domain=ball:30 viscosity-law=pries
terminals=200 terminal-flow=territory seed=2
terminals=100 refine=topology
terminals=200 gamma=2.1
terminals=200 gamma=2.55 domain=ball:30
terminals=200 gamma=2.8 seed=3
terminals=200 gamma=0.1:2.3,2:2.9
terminals=200 lambda=3 domain=ellipsoid:40,30,20
terminals=100 viscosity-law=pries refine=geometry
terminals=40 refine=anneal refine-moves=4000 gamma=2.7
END
}

# expectation OPTION...: grows a tree with corcast, and prints the JSON that tests/page/grow.js
# compares the page with.
expectation() {
    local option arguments=() address=
    for option; do
        arguments+=("--${option%%=*}" "${option#*=}")
        address="$address&$option"
    done
    corcast grow "${arguments[@]}" --quiet -o T.swc || fail "expected to grow $*"
    jq -n --arg address "${address#&}" --arg sha256 "$(sha256sum <T.swc | cut -d ' ' -f 1)" \
        --arg command "corcast grow$(printf ' %s' "${arguments[@]}") -o tree.swc" '$ARGS.named'
}

# expectations N: writes the expectations for the first N trees to expected.json.
expectations() {
    local tree
    while read -r tree; do
        # shellcheck disable=SC2086
        expectation $tree
    done < <(trees | head -n "$1") | jq -s --arg page "$PAGE" '{page: $page, trees: .}' >expected.json
    [ "$(jq '.trees | length' expected.json)" -eq "$1" ] || fail "expected $1 trees"
}

test_the_program_of_the_page_writes_the_bytes_of_the_native_program_with_and_without_vectors() {
    need_page
    command -v node >node.path || skip "nodejs is not installed"
    expectations 15
    run_ok corcast grow --terminals 12 --domain ball:9 --quiet -o T.swc
    run_ok corcast export T.swc --lod 0.5 --quiet -o T.stl
    jq --arg sha256 "$(sha256sum <T.stl | cut -d ' ' -f 1)" '. + {stl: {address: "terminals=12&domain=ball:9", $sha256}}' expected.json >all.json
    run node "$REPO/tests/page/grow_bytes.js" "$REPO/build/grow" all.json
    [ "$status" -eq 0 ] || fail "$(head -5 stdout | tr '\n' ';')$(said)"
}

# Slow: a browser that draws by software.
test_the_page_grows_saves_and_checks_its_address_in_a_browser() {
    need_page
    command -v node >node.path || skip "nodejs is not installed"
    command -v chromium >chromium.path || skip "chromium is not installed"
    expectations 1
    run node "$REPO/tests/page/grow.js" chromium expected.json
    [ "$status" -eq 0 ] || fail "$(head -5 stdout | tr '\n' ';')$(said)"
}

test_the_page_is_one_file_of_at_most_four_megabytes_with_the_licences_of_its_parts() {
    need_page
    [ "$(wc -c <"$PAGE")" -lt 4000000 ] || fail "expected less than 4 MB, got $(wc -c <"$PAGE")"
    grep -qE '(src|href)="' "$PAGE" && fail "expected nothing from elsewhere"
    grep -q 'Permission is hereby granted' "$PAGE" || fail "expected the licence of three.js"
    grep -q 'Copyright (c) 2021 Fabio Crameri' "$PAGE" || fail "expected the licences of the color maps"
    grep -q '@[A-Z]*@' "$PAGE" && fail "expected every part of the page to be filled in"
    grep -q "content=\"corcast $(corcast version | sed -n 's/^corcast \([^ ]*\).*/\1/p')\"" "$PAGE" || fail "expected the version of the program"
}

run_tests "$@"
