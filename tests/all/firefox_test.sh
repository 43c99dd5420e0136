#!/usr/bin/env bash
# The page that grows trees in Firefox, on a virtual display [tests/page/grow.js].
. "$(dirname "$0")/../lib.sh"

test_firefox_grows_the_bytes_of_the_program_saves_files_and_checks_addresses() {
    local page=$REPO/build/grow/corcast.html
    [ -e "$page" ] || skip "the page that grows trees is not built: run \`make page\`"
    command -v node >node.path || skip "nodejs is not installed"
    command -v firefox-esr >firefox.path && command -v xvfb-run >xvfb.path || skip "firefox-esr or xvfb is not installed"
    run_ok corcast grow --terminals 300 --domain ball:30 --seed 5 --gamma 2.7 --quiet -o T.swc
    jq -n --arg page "$page" --arg sha256 "$(sha256sum <T.swc | cut -d ' ' -f 1)" \
        --arg command 'corcast grow --terminals 300 --domain ball:30 --seed 5 --gamma 2.7 -o tree.swc' \
        '{$page, trees: [{address: "terminals=300&domain=ball:30&seed=5&gamma=2.7", $command, $sha256}]}' >expected.json
    run xvfb-run -a node "$REPO/tests/page/grow.js" firefox-esr expected.json
    [ "$status" -eq 0 ] || fail "$(head -5 stdout | tr '\n' ';')$(said)"
}

run_tests "$@"
