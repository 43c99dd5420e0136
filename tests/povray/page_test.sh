#!/usr/bin/env bash
# The report page, opened in headless Chromium; see tests/page/page.js.
. "$(dirname "$0")/../lib.sh"

# Makes a report of two cases: one agrees, in the other POV-Ray draws another highlight.
two_cases() {
    run_ok corcast grow --terminals 20 --seed 5 -o tree.swc
    run_ok corcast verify tree.swc --size 120x90 -o good
    printf '#!/bin/sh\nexec povray "$@" Declare=Vessel_Phong=0.5\n' >povray.sh
    chmod +x povray.sh
    run env CORCAST_POVRAY="$PWD/povray.sh" "$CORCAST" verify tree.swc --size 120x90 -o bad
    expect_status 1
    run corcast report good bad -o page.html
    expect_status 1
    grep -q '<small><code>tree.swc --size 120x90 -o good</code> in good</small>' page.html || fail "expected cases to be told apart"
    expect_stdout '^differ: 2 cases; page.html'
}

# pixel PICTURE.png X Y: prints the color of a pixel as a JSON array.
pixel() {
    pngtopnm "$1" | pamcut "$2" "$3" 1 1 | tail -c 3 | od -An -tu1 | awk '{ printf "[%d, %d, %d]", $1, $2, $3 }'
}

test_the_page_opens_sorts_swipes_zooms_and_shows_the_right_values() {
    command -v node >node.path || skip "nodejs is not installed"
    command -v chromium >chromium.path || skip "chromium is not installed"
    local x y depth
    two_cases
    x=$(jq .planes.color.worst.x bad/report.json)
    y=$(jq .planes.color.worst.y bad/report.json)
    depth=$(tail -c +$((1 + $(head -3 bad/native.depth.pfm | wc -c) + 4 * ((89 - y) * 120 + x))) bad/native.depth.pfm |
        head -c 4 | od -An -tf4)
    jq --argjson depth "$depth" --argjson a "$(pixel bad/povray.png "$x" "$y")" --argjson b "$(pixel bad/native.png "$x" "$y")" \
        '{cases: 2, worst: {id: "case-2", differing: .planes.color.differing_pixels, x: .planes.color.worst.x,
          y: .planes.color.worst.y, segment: .planes.color.worst.id_a, classes: .planes.color.classes,
          depth: $depth, a: $a, b: $b}}' bad/report.json >expected.json
    run node "$REPO/tests/page/page.js" chromium page.html expected.json
    [ "$status" -eq 0 ] || fail "$(head -5 stdout | tr '\n' ';')$(said)"
}

test_the_page_shows_what_the_judge_finds() {
    run_ok corcast grow --terminals 20 --seed 5 -o tree.swc
    run_ok corcast verify tree.swc --size 60x45 -o good
    printf '{"faults": [{"fault": "a <b>", "model": "rounded", "A": true, "B": false}], "limits": [
        {"parameter": "phong", "model": "rounded", "unit": "relative", "A": 0.001, "B": null}],
        "clean_scenes": 3, "povray_scenes": 4, "alarms": []}' >power.json
    run_ok corcast report good --power power.json -o page.html
    grep -q '<th>a &lt;b&gt;</th><td>rounded</td><td>✓</td><td>–</td>' page.html || fail "expected the kill matrix"
    grep -q '0 false alarms about 7 clean scenes' page.html || fail "expected the count of alarms"
}

test_a_folder_without_a_report_is_refused() {
    mkdir empty
    run corcast report empty -o page.html
    expect_status 2
    expect_sentence 'empty/report\.html'
    [ ! -e page.html ] || fail "expected no page"
}

run_tests "$@"
