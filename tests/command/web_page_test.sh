#!/usr/bin/env bash
# Web pages of trees: their contents, and what they show in headless Chromium; see
# tests/page/tree.js.
. "$(dirname "$0")/../lib.sh"

VIEW="--projection orthographic --turn 0,0 --look-at 1.5,-0.75,0 --height 56"

need_viewer() {
    [ -e "$REPO/build/viewer/viewer.js" ] || skip "the viewer is not built, for want of npm, esbuild or three.js"
}

# series: prints a table of nodes with a field at three moments, and a column whose name contains
# HTML.
series() {
    printf 'id,x,y,z,radius,parent,p_0.1,p_0.25,p_0.7,a</script><b>\n'
    printf '1,0,0,0,1.5,-1,0,0,0,1\n2,0,-9.5,0,1.5,1,1.25,7,3,2\n3,4,-14,0,0.75,2,2,1,8.5,3\n4,-4,-14,1,0.7,2,3,2,9,4\n'
}

expectations() {
    corcast convert tree.swc tree.segments.csv --fields all --quiet
    # shellcheck disable=SC2086
    corcast render tree.swc $VIEW --look cast --size 640x500 --background '#fbfaf7' --quiet -o drawn.png
    # shellcheck disable=SC2086
    corcast render tree.swc $VIEW --size 640x500 --exact --planes id --quiet -o exact.png
    pngtopnm drawn.png >drawn.ppm
    awk -F, '/^#/ { next }
        !n { for (i = n = 1; i <= NF; i++) { name[i] = $i; gsub(/"| .*/, "", name[i]) } next }
        { printf "%s\"%s\": {", (n++ > 1 ? ", " : "{"), $1
          for (i = 11; i <= NF; i++) printf "%s\"%s\": %s", (i > 11 ? ", " : ""), name[i], $i
          printf "}" } END { print "}" }' tree.segments.csv | jq 'map_values(del(.tree))' >segments.json
    jq -n --slurpfile segments segments.json --arg options "$VIEW" '{page: "tree.html", series: "series.html", width: 640, height: 500,
        address: "projection=orthographic&turn=0,0&look-at=1.5,-0.75,0&height=56",
        options: $options, exact: "drawn.ppm", ids: "exact.id.ppm", segments: $segments[0]}' >expected.json
}

# Slow: a browser that draws by software.
test_a_page_shows_a_tree_as_render_does_and_answers_to_hands_and_keys() {
    need_viewer
    command -v node >node.path || skip "nodejs is not installed"
    command -v chromium >chromium.path || skip "chromium is not installed"
    run_ok corcast grow --terminals 150 --seed 5 --domain ball:25 --quiet -o tree.swc
    series >series.csv
    expectations
    run_ok corcast export tree.swc -o tree.html
    run_ok corcast export series.csv -o series.html
    run node "$REPO/tests/page/tree.js" chromium expected.json
    [ "$status" -eq 0 ] || fail "$(head -5 stdout | tr '\n' ';')$(said)"
}

test_a_page_of_2000_segments_is_small_complete_and_the_same_each_time() {
    need_viewer
    run_ok corcast grow --terminals 1000 --seed 5 --quiet -o tree.swc
    run_ok corcast export tree.swc --color-by flow --log --colormap magma -o a.html
    run_ok corcast export tree.swc --color-by flow --log --colormap magma -o b.html --threads 1
    expect_same a.html b.html
    [ "$(wc -c <a.html)" -lt 1000000 ] || fail "expected less than 1 MB, got $(wc -c <a.html)"
    grep -qE '(src|href)="' a.html && fail "expected nothing from elsewhere"
    grep -q 'Permission is hereby granted' a.html || fail "expected the licence of three.js"
    grep -q 'Copyright (c) 2021 Fabio Crameri' a.html || fail "expected the licences of the color maps"
    grep -q '<title>tree.swc, an arterial tree</title>' a.html || fail "expected a title"
    sed -n 's/^<script type="application\/json" id="properties">\(.*\)<\/script>$/\1/p' a.html >properties.json
    expect_json properties.json '(.start | .field == "flow" and .map == "magma" and .kind == "log" and (.low - 0.5 | fabs) < 1e-9 and (.high - 500 | fabs) < 1e-9)
        and .command == "corcast export tree.swc --color-by flow --colormap magma --log -o M.html"
        and ([.fields[].name] | index("wss") and index("radius") and (index("tree") | not))'
}

test_names_do_not_end_the_elements_that_hold_them() {
    need_viewer
    series >'t<b>.csv'
    run_ok corcast export 't<b>.csv' -o page.html
    grep -q '<b>' page.html && fail "expected names to be escaped"
    sed -n 's/^<script type="application\/json" id="properties">\(.*\)<\/script>$/\1/p' page.html >properties.json
    expect_json properties.json '.fields | map(.name) | index("a</script><b>") and index("p")'
    expect_json properties.json '.fields[] | select(.name == "p").times == [0.1, 0.25, 0.7]'
    grep -q 'flow, velocity, pressure, wss, reynolds are left out' stderr || fail "expected what is left out"
}

test_more_segments_than_a_browser_turns_are_refused_with_the_radius_that_leaves_fewer() {
    awk 'BEGIN { for (i = 1; i <= 200002; i++) print i, 3, i / 100, 0, 0, 1 - i / 400000, (i > 1 ? i - 1 : -1) }' >long.swc
    run corcast export long.swc -o page.html
    expect_status 2
    expect_sentence 'long.swc: 200001 segments make a page of 17(\.[0-9]+)? MB, and a browser can rotate at most 200000; --prune-radius 0\.5 leaves'
    expect_only long.swc
}

test_values_of_more_moments_than_a_browser_opens_are_refused_with_their_size() {
    awk 'BEGIN { printf "id,x,y,z,radius,parent"
        for (k = 0; k < 130; k++) { printf ",p_%d", k; values = values ",1" }
        for (i = 1; i <= 150000; i++) printf "\n%d,%g,0,0,1,%d%s", i, i / 100, (i > 1 ? i - 1 : -1), values }' >long.csv
    run corcast export long.csv --quiet -o page.html
    expect_status 2
    expect_sentence 'the fields \(1[34][0-9], counting each time step\) make a page of 10[0-9](\.[0-9]+)? MB, .* 100 MB; remove columns'
    expect_only long.csv
}

test_options_without_effect_on_a_page_are_refused() {
    run_ok corcast grow --terminals 5 --quiet -o tree.swc
    for option in "--mesh-tolerance 0.05" "--color-by flow --classes 3" "--color-by flow --moment 1" "--colormap magma" "--spacing 0.1"; do
        # shellcheck disable=SC2086
        run corcast export tree.swc $option -o page.html
        expect_status 2
        [ ! -e page.html ] || fail "expected no page for $option"
    done
}

test_without_the_viewer_a_page_is_refused_and_what_is_missing_named() {
    run_ok corcast grow --terminals 5 --quiet -o tree.swc
    mkdir -p share && cp -R "$REPO/templates" share/templates
    run env CORCAST_TEMPLATES="$PWD/share/templates" "$CORCAST" export tree.swc -o page.html
    expect_status 3
    expect_sentence 'without the page viewer; install npm and esbuild'
    [ ! -e page.html ] || fail "expected no page"
}

# The color scale of the page: round numbers, positions and colors of values, linear and
# logarithmic.
test_the_scale_of_a_page_has_the_right_numbers() {
    command -v node >node.path || skip "nodejs is not installed"
    cp "$REPO/templates/viewer/colors.js" colors.mjs
    cat >scale.mjs <<'END'
import { chooseKind, rangeOf, reason, Scale } from "./colors.mjs";
const blue_to_yellow = { bytes: [0, 0, 255, 255, 255, 0], separate: false };
const scale = (low, high, log, whole = false) => new Scale({ whole }, blue_to_yellow, log ? "log" : "linear", [low, high]);
const expect = (what, found, expected) => {
  const near = found.length === expected.length &&
    found.every((value, k) => Math.abs(value - expected[k]) <= 1e-9 * Math.max(1e-9, Math.abs(expected[k])));
  if (!near) throw new Error(`${what}: expected ${expected}, got ${found}`);
};
const ticks = (low, high, log, whole, ...expected) =>
  expect(`ticks of ${low} to ${high}`, scale(low, high, log, whole).ticks(), expected);
ticks(0, 10, false, false, 0, 5, 10);
ticks(0, 7, false, false, 0, 2, 4, 6);
ticks(-0.3, 0.45, false, false, -0.2, 0, 0.2, 0.4);
ticks(0, 4, false, false, 0, 1, 2, 3, 4);
ticks(1, 7, false, true, 1, 2, 3, 4, 5, 6, 7);
ticks(1, 40, false, true, 10, 20, 30, 40);
ticks(1, 1000, true, false, 1, 10, 100, 1000);
ticks(2, 50, true, false, 3, 10, 30);
ticks(2, 12, true, false, 2, 3, 5, 7, 10);
ticks(1e-6, 1e6, true, false, 1e-6, 1e-3, 1, 1e3, 1e6);
for (const [low, high, log, place, value] of [[2, 10, false, 0.25, 4], [1, 1000, true, 1 / 3, 10], [4, 9, true, 0.5, 6]]) {
  expect("position", [scale(low, high, log).position(value)], [place]);
  expect("value", [scale(low, high, log).at(place)], [value]);
}
const color = [0, 0, 0];
scale(1, 1000, true).put(10, color, 0);
expect("color", color, [85, 85, 170]);
scale(0, 100, false).put(20, color, 0);
expect("color", color, [51, 51, 204]);
const field = (values, whole = false) => ({ whole, sorted: Float64Array.from(values).sort() });
const hundred = (value) => field(Array.from({ length: 101 }, (_, k) => value(k)));
const kind = (shown, wanted, words) => {
  const chosen = chooseKind(shown, blue_to_yellow);
  const said = reason(new Scale(shown, blue_to_yellow, chosen, rangeOf(shown, chosen)));
  if (chosen !== wanted || said !== words) throw new Error(`expected ${wanted} (${words}), got ${chosen} (${said})`);
};
kind(hundred((k) => 3 + k), "linear", "");
const because = (percent) => `because 80\u00a0% of the values fill ${percent}\u00a0% of a linear scale.`;
kind(hundred((k) => 3 * 10 ** (k / 10)), "log", "logarithmic, " + because(10));
kind(hundred((k) => (k ? 3 + k / 1000 : -90)), "percentiles", "2nd to 98th percentile, " + because(0.09));
kind(field([1, 1, 1, 1, 1, 1, 1, 1, 1, 900], true), "linear", "");
kind(field([2.5, 2.5, 2.5]), "linear", "");
kind(field([2.5, 2.5, 2.5, 2.5, 2.5, 2.5, 2.5, 2.5, 2.5, 2.5, 2.5, 9]), "linear",
  "Skewed: 80\u00a0% of the values fill 0\u00a0% of this scale.");
expect("percentiles", rangeOf(hundred((k) => 2.5 * k), "percentiles"), [5, 245]);
expect("log range", rangeOf(field([0, 0, 0.25, 7]), "log"), [0.25, 7]);
END
    run_ok node scale.mjs
}

# The background of the dark page is #131417.
test_each_color_of_each_map_is_visible_on_a_dark_page() {
    command -v node >node.path || skip "nodejs is not installed"
    cp "$REPO/templates/viewer/colors.js" colors.mjs
    cat >lifted.mjs <<'END'
import fs from "fs";
import { contrast, lifted, luminance } from "./colors.mjs";
const linear = (v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
const ground = luminance([0x13, 0x14, 0x17].map((v) => linear(v / 255)));
const lights = (bytes) => Array.from({ length: bytes.length / 3 }, (_, k) =>
  luminance([0, 1, 2].map((c) => linear(bytes[3 * k + c] / 255))));
const fall = (values) => values.reduce(([most, drop], v) => [Math.max(most, v), Math.max(drop, most - v)], [0, 0])[1];
let n = 0;
for (const file of process.argv.slice(2)) {
  const rows = fs.readFileSync(file, "utf8").split("\n").filter((line) => /^[0-9]/.test(line));
  const bytes = Uint8Array.from(rows.flatMap((line) => line.trim().split(/\s+/).map((v) => Math.round(255 * v))));
  const before = lights(bytes), after = lights(lifted(bytes, ground)), lowest = Math.min(...after.map((v) => contrast(v, ground)));
  if (!(lowest >= 3 && lowest < 3.2 || after.join() === before.join())) throw new Error(`${file}: contrast ${lowest}`);
  if (fall(after) > fall(before) + 0.01) throw new Error(`${file}: not as light as colors before by ${fall(after)}`);
  n++;
}
if (n < 12) throw new Error("expected all maps");
END
    run_ok node lifted.mjs "$REPO"/templates/colormaps/[A-Za-z]*.txt
}

run_tests "$@"
