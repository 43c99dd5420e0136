#!/usr/bin/env bash
# The color of a value, in the native picture and in the scene for POV-Ray. Expected are entries of
# matplotlib's published tables, as 8-bit codes and as linear numbers computed by hand.
. "$(dirname "$0")/../lib.sh"

MODELS=$(corcast models | cut -f 1)

# Makes the unconnected vessels 2, 4, 6, 8 and 10 with the radii 1.37 mm times 1, 2, 4, 8 and 16,
# and a look without shading. On a linear scale from the minimum to the maximum, the radii are at
# the entries 0, 17, 51, 119 and 255 of 256; on a logarithmic scale at 0, 1/4, 1/2, 3/4 and 1.
make_vessels() {
    cat >tree.swc <<'SWC'
1 1 -50 90 0.5 1.37 -1
2 3 50 90 0.5 1.37 1
3 1 -50 80 0.5 2.74 -1
4 3 50 80 0.5 2.74 3
5 1 -50 60 0.5 5.48 -1
6 3 50 60 0.5 5.48 5
7 1 -50 20 0.5 10.96 -1
8 3 50 20 0.5 10.96 7
9 1 -50 -50 0.5 21.92 -1
10 3 50 -50 0.5 21.92 9
SWC
    cat >flat.ini <<'INI'
[vessel]
color = 0.3 0.4 0.5
[background]
color = 1 1 1
[finish]
ambient = 1
diffuse = 0
[light key]
direction = 0 0 1
color = 1 1 1
INI
}

VIEW="--size 60x80 --location 0,10,100 --look-at 0,10,0 --height 170"

# numbers FILE: prints the three bytes of each of the last 60 x 80 pixels.
numbers() {
    tail -c 14400 "$1" | od -An -v -tu1 -w3
}

# expect_codes OPTION... -- "ID R G B" ...: every pixel of a vessel has the codes, and every other
# pixel is $background.
background="255 255 255"
expect_codes() {
    local options=() expected
    while [ "$1" != -- ]; do
        options+=("$1")
        shift
    done
    shift
    # shellcheck disable=SC2086
    run_ok corcast render --antialias 1 --quiet tree.swc --look ./flat.ini $VIEW --planes color,id "${options[@]}" -o p.ppm
    expected=$(printf '%s\n' "0 $background" "$@")
    paste -d ' ' <(numbers p.id.ppm | awk '{ print $1 * 65536 + $2 * 256 + $3 }') <(numbers p.ppm) |
        tr -s ' ' | sort -n | uniq >seen
    [ "$(cat seen)" = "$expected" ] ||
        fail "expected the colors '$(echo $expected)', got '$(echo $(cat seen))', from: $command_line"
}

# expect_scene OPTION... -- "ID R G B" ...: the scene gives each vessel this linear color.
expect_scene() {
    local options=()
    while [ "$1" != -- ]; do
        options+=("$1")
        shift
    done
    shift
    run_ok corcast scene --quiet tree.swc --look ./flat.ini --size 60x80 "${options[@]}" -o s.pov
    grep -oE '[(,][0-9]+,[0-9]+,[0-9.e-]+,<[^<>]*>\)' s.inc | # Id, Order, Value, Color
        sed -E 's/^.([0-9]+),.*<(.*)>\)$/\1 \2/; s/,/ /g' | sort -n | uniq >seen
    printf '%s\n' "$@" | paste -d ' ' seen - | awk '
        NF != 8 || $1 != $5 { bad = 1 }
        { for (i = 2; i <= 4; i++) if (($i - $(i + 4)) ^ 2 > 1e-13) bad = 1 }
        END { exit bad }' || fail "expected the colors '$*', got '$(echo $(cat seen))', from: $command_line"
}

test_every_model_shows_the_published_entry_of_each_value_and_writes_it_for_povray() {
    local model
    make_vessels
    for model in $MODELS; do
        expect_codes --model $model --color-by radius -- \
            "2 68 1 84" "4 72 26 108" "6 65 68 135" "8 35 136 142" "10 253 231 37"
        expect_scene --model $model --color-by radius -- \
            "2 0.05795103 0.0003772446 0.08865738" "4 0.06494307 0.01005327 0.1489319" \
            "6 0.05246566 0.05719803 0.2428499" "8 0.0172071 0.2466823 0.2688405" \
            "10 0.9847088 0.799651 0.01824342"
    done
}

test_the_fast_methods_show_the_same_colors() {
    local method
    make_vessels
    for method in raster zbuffer; do
        expect_codes --method $method --color-by radius -- \
            "2 68 1 84" "4 72 26 108" "6 65 68 135" "8 35 136 142" "10 253 231 37"
    done
}

test_log_takes_equal_factors_to_equal_steps_of_every_map() {
    make_vessels
    expect_codes --color-by radius --log -- \
        "2 68 1 84" "4 59 82 139" "6 33 144 140" "8 93 201 99" "10 253 231 37"
    expect_codes --color-by radius --log --colormap magma -- \
        "2 0 0 4" "4 80 18 124" "6 182 55 121" "8 251 135 97" "10 252 253 191"
    expect_codes --color-by radius --log --colormap inferno -- \
        "2 0 0 4" "4 87 16 109" "6 187 55 85" "8 249 141 10" "10 252 255 164"
    expect_codes --color-by radius --log --colormap plasma -- \
        "2 13 8 135" "4 126 3 168" "6 203 71 120" "8 248 148 65" "10 240 249 33"
}

test_classes_are_steps_of_one_color_that_use_the_whole_map() {
    make_vessels
    expect_codes --color-by radius --log --classes 3 -- \
        "2 68 1 84" "4 68 1 84" "6 33 144 140" "8 253 231 37" "10 253 231 37"
}

# In the range 2.74 to 10.96, 5.48 is at 1/3, entry 85, and on a logarithmic scale at 1/2. Values
# outside the range have the color of the nearer end.
test_range_sets_the_ends_of_the_map() {
    make_vessels
    expect_codes --color-by radius --range 2.74,10.96 -- \
        "2 68 1 84" "4 68 1 84" "6 49 104 142" "8 253 231 37" "10 253 231 37"
    expect_codes --color-by radius --range 2.74,10.96 --log -- \
        "2 68 1 84" "4 68 1 84" "6 33 144 140" "8 253 231 37" "10 253 231 37"
}

test_a_field_of_one_value_has_the_middle_of_the_map() {
    make_vessels
    expect_codes --color-by length -- \
        "2 33 144 140" "4 33 144 140" "6 33 144 140" "8 33 144 140" "10 33 144 140"
}

# The codes are 255 times the numbers. The linear numbers were decoded by hand.
test_a_background_is_given_as_it_is_encoded() {
    local background="64 128 191"
    make_vessels
    expect_codes --background 0.25,0.5,0.75 --color-by length --model cylinders -- \
        "2 33 144 140" "4 33 144 140" "6 33 144 140" "8 33 144 140" "10 33 144 140"
    expect_scene --background 0.25,0.5,0.75 --color-by length --model cylinders -- \
        "2 0.01495968 0.2793277 0.2642065" "4 0.01495968 0.2793277 0.2642065" "6 0.01495968 0.2793277 0.2642065" \
        "8 0.01495968 0.2793277 0.2642065" "10 0.01495968 0.2793277 0.2642065"
    sed -nE 's/.*#declare Background_(Red|Green|Blue) *= *([0-9.e-]+);.*/\2/p' s.pov | paste -s -d ' ' >seen
    awk '($1 - 0.05087609) ^ 2 + ($2 - 0.2140411) ^ 2 + ($3 - 0.5225216) ^ 2 < 1e-12 { found = 1 } END { exit !found }' seen ||
        fail "expected the linear background 0.05087609 0.2140411 0.5225216, got '$(cat seen)'"
}

test_a_picture_of_16_bits_has_the_same_colors_more_finely() {
    make_vessels
    run_ok corcast render --exact --quiet tree.swc --look ./flat.ini --size 60x80 --bits 16 --color-by radius -o p.ppm
    # The entry 17, 0.282656 0.100196 0.422160, times 65535.
    tail -c 28800 p.ppm | od -An -v -tu2 --endian=big -w6 | tr -s ' ' | grep -qx ' 18524 6566 27666' ||
        fail "expected a pixel of the codes 18524 6566 27666"
}

# A tree with constant viscosity, drawn with --viscosity-law pries, has the colors of a tree that
# states this law.
test_a_field_of_flow_follows_what_options_say_of_the_blood() {
    local law='--viscosity-law pries --hematocrit 0.31 --plasma-viscosity 1.05'
    run_ok corcast grow --terminals 23 --quiet -o constant.swc
    sed 's/^# viscosity_cP.*/# viscosity_law: pries\n# hematocrit: 0.31\n# plasma_viscosity_cP: 1.05/' constant.swc >pries.swc
    run_ok corcast render --exact --quiet constant.swc --size 60x80 --color-by pressure $law -o said.ppm
    run_ok corcast render --exact --quiet pries.swc --size 60x80 --color-by pressure -o written.ppm
    run_ok corcast render --exact --quiet constant.swc --size 60x80 --color-by pressure -o constant.ppm
    expect_same said.ppm written.ppm
    ! cmp -s said.ppm constant.ppm || fail "expected the law to change the picture"
    run corcast render constant.swc --color-by pressure --hematocrit 0.31 -o no.ppm
    expect_status 2
    expect_sentence '--hematocrit is for --viscosity-law pries'
}

# says LINE: standard error contains exactly this line.
says() {
    [ "$(cat stderr)" = "$1" ] || fail "expected the line '$1'$(said)"
}

test_the_range_is_said_in_the_log_the_json_the_picture_and_the_scene() {
    local said='radius 1.37 to 21.9 mm, of the 5 segments drawn'
    make_vessels
    run_ok corcast render --exact tree.swc --input-unit mm --size 60x80 --color-by radius --json r.json -o p.png
    says "corcast: $said"
    [ "$(jq -r '.color | "\(.field) \(.unit) \(.low) \(.high) \(.log) \(.said)"' r.json)" = \
        "radius mm 1.37 21.92 false $said" ] || fail "expected the range in the JSON, got $(jq -c .color r.json)"
    grep -aq "$said" p.png || fail "expected the range in the picture's text"
    run_ok corcast scene --quiet tree.swc --input-unit mm --color-by radius -o s.pov
    grep -q "^// Desc: .*, colored by $said\$" s.pov || fail "expected the range in the scene's head"
    grep -qx "#declare Value_Said = \"$said\";" s.inc || fail "expected the range in the anatomy"
    run_ok corcast render --exact --quiet tree.swc --input-unit mm --size 60x80 --color-by radius -o p.png
    [ ! -s stderr ] || fail "expected --quiet to say nothing, got '$(cat stderr)'"
}

# 2.74 and 10.96 mm are 2740 and 10960 um. The range and the classes are in the selected unit.
test_a_unit_goes_for_range_classes_and_what_is_said() {
    make_vessels
    expect_codes --color-by radius --unit um --range 2740,10960 -- \
        "2 68 1 84" "4 68 1 84" "6 49 104 142" "8 253 231 37" "10 253 231 37"
    run_ok corcast render --exact tree.swc --input-unit mm --size 60x80 --color-by radius --unit cm --classes 0.2,1.5 -o p.ppm
    says 'corcast: radius 0.137 to 2.19 cm, of the 5 segments drawn; classes at 0.2, 1.5'
    refuses "--unit: the field radius is in mm, not in Pa; it can be in um, cm, m" --color-by radius --unit Pa
    refuses "--unit: the field level is a pure number, not in Pa" --color-by level --unit Pa
}

# refuses SENTENCE OPTION...: `render` refuses the options with the sentence and writes no picture.
refuses() {
    local sentence=$1
    shift
    run corcast render tree.swc --input-unit mm "$@" -o no.ppm
    expect_status 2
    expect_sentence "$sentence"
    [ ! -e no.ppm ] || fail "expected no picture, from: $command_line"
}

test_classes_may_have_bounds() {
    make_vessels
    expect_codes --color-by radius --classes 2,5.48,15 -- \
        "2 68 1 84" "4 49 104 142" "6 53 183 121" "8 53 183 121" "10 253 231 37"
    refuses '--classes: bounds must ascend, but 5 comes before 2' --color-by radius --classes 1,5,2
    refuses "--classes: '2.5' is not an integer from 1 to 256, nor a list of bounds" \
        --color-by radius --classes 2.5
    refuses '--log has no effect if --classes gives bounds' --color-by radius --classes 1,2 --log
    refuses '--range has no effect if --classes gives bounds' --color-by radius --classes 1,2 --range 1,2
}

# The quartiles of 1.37, 2.74, 5.48, 10.96 and 21.92 are 2.74 and 10.96.
test_a_range_may_be_of_percentiles() {
    make_vessels
    expect_codes --color-by radius --range 25%,75% -- \
        "2 68 1 84" "4 68 1 84" "6 49 104 142" "8 253 231 37" "10 253 231 37"
    run_ok corcast render --exact tree.swc --input-unit mm --size 60x80 --color-by radius --range 25%,75% -o p.ppm
    says 'corcast: radius 2.74 to 11.0 mm, 25% to 75% of the 5 segments drawn; 1 below, 1 above'
    run_ok corcast render --exact tree.swc --input-unit mm --size 60x80 --color-by radius --range 2,6 -o p.ppm
    says 'corcast: radius 2 to 6 mm, as given; 1 below, 2 above'
    refuses "'75%,25%' is not A,B, two numbers with A below B, or percentiles" --color-by radius --range 75%,25%
    refuses "'2,1' is not A,B, two numbers with A below B" --color-by radius --range 2,1
    refuses '--range: the lower end 30 of the field radius is above the upper end 10.96' --color-by radius --range 30,75%
}

test_a_pruned_picture_may_keep_the_range_of_the_tree() {
    make_vessels
    expect_codes --color-by radius --prune-radius 5 --range-of tree -- \
        "6 65 68 135" "8 35 136 142" "10 253 231 37"
    run_ok corcast render --exact tree.swc --input-unit mm --size 60x80 --color-by radius --prune-radius 5 --range-of tree -o p.ppm
    grep -qx 'corcast: radius 1.37 to 21.9 mm, of all 5 segments of the tree' stderr ||
        fail "expected the range of the tree$(said)"
    run_ok corcast render --exact tree.swc --input-unit mm --size 60x80 --color-by radius --prune-radius 5 -o p.ppm
    grep -qx 'corcast: radius 5.48 to 21.9 mm, of the 3 segments drawn' stderr ||
        fail "expected the range of what is drawn$(said)"
    refuses '--range-of has no effect if --range gives two values' --color-by radius --range-of tree --range 1,2
}

test_values_outside_the_range_and_segments_without_one_have_their_colors() {
    make_vessels
    expect_codes --color-by radius --range 2.74,10.96 --under '#0080ff' --over red -- \
        "2 0 128 255" "4 68 1 84" "6 49 104 142" "8 253 231 37" "10 255 0 0"
    expect_codes --color-by radius --classes 2,15 --under navy --over 0.25,0.5,0.75 -- \
        "2 0 0 128" "4 33 144 140" "6 33 144 140" "8 33 144 140" "10 64 128 191"
    corcast convert tree.swc tree.csv
    awk -F, 'NR == 1 { print $0 ",load" } NR > 1 { print $0 "," (NR == 3 ? "" : NR == 5 ? -1 : NR) }' tree.csv >load.csv
    # shellcheck disable=SC2086
    run_ok corcast render --exact load.csv --look flat $VIEW --color-by load --log --no-data lime -o p.ppm
    grep -q 'load 7 to 11, of the 5 segments drawn; logarithmic; 2 without a logarithm' stderr ||
        fail "expected to hear of values without a logarithm$(said)"
    numbers p.ppm | tr -s ' ' | grep -qx ' 0 255 0' || fail "expected the color of no data"
    refuses "--under: 'bleu' is not R,G,B" --color-by radius --under bleu
}

test_a_map_of_separate_colors_counts_whole_numbers() {
    make_vessels
    expect_codes --color-by strahler --colormap Set1 -- \
        "2 228 26 28" "4 228 26 28" "6 228 26 28" "8 228 26 28" "10 228 26 28"
    expect_codes --color-by radius --classes 2,5,15 --colormap Dark2 -- \
        "2 27 158 119" "4 217 95 2" "6 117 112 179" "8 117 112 179" "10 231 41 138"
    refuses '--colormap Set1 has separate colors, which suit integers' --color-by radius --colormap Set1
}

test_a_field_of_many_decades_gets_a_hint() {
    run_ok corcast grow --quiet --terminals 1234 -o tree.swc
    run_ok corcast render --exact tree.swc --input-unit mm --size 60x80 --color-by flow -o p.ppm
    grep -qx 'corcast: the field flow spans 3.1 decades; use --log for a logarithmic scale' stderr ||
        fail "expected a hint$(said)"
    run_ok corcast render --exact tree.swc --input-unit mm --size 60x80 --color-by flow --log -o p.ppm
    [ "$(wc -l <stderr)" = 1 ] || fail "expected no hint with --log$(said)"
    run_ok corcast render --exact tree.swc --input-unit mm --size 60x80 --color-by pressure -o p.ppm
    [ "$(wc -l <stderr)" = 1 ] || fail "expected no hint for pressure$(said)"
}

test_a_field_without_any_value_is_refused() {
    make_vessels
    corcast convert tree.swc tree.csv
    sed '1s/$/,load/; 2,$s/$/,/' tree.csv >none.csv
    sed '1s/$/,load/; 2,$s/$/,-2.5/' tree.csv >below.csv
    run corcast render none.csv --color-by load -o no.ppm
    expect_status 2
    expect_sentence 'none.csv: --color-by: the field load has no value'
    run corcast render below.csv --color-by load --log -o no.ppm
    expect_status 2
    expect_sentence 'below.csv: --color-by: the field load has no value above 0'
    run_ok corcast render --exact below.csv --size 60x80 --color-by load -o p.ppm
    says 'corcast: load −2.50 to −2.50, of the 5 segments drawn'
}

# The look flat shows the color of the map, here entry 231 of 255. The look data, also the default
# look of a field, differs by at most 8 codes.
test_looks_for_data_show_the_color_of_the_map() {
    local look most
    make_vessels
    for look in "flat 1" "data 8" " 8"; do
        # shellcheck disable=SC2086
        run_ok corcast render --exact --quiet tree.swc --input-unit mm $VIEW --color-by radius --range 1,21.92 --planes id \
            $(awk 'NF == 2 { print "--look", $1 }' <<<"$look") -o p.ppm
        most=$(paste -d ' ' <(numbers p.id.ppm) <(numbers p.ppm) | awk '$3 == 10 && $5 > most { most = $5 } END { print most }')
        [ $((most - 231)) -ge -${look##* } ] && [ $((most - 231)) -le ${look##* } ] ||
            fail "expected the look '$look' to show about 231, got $most"
    done
}

# Two vessels with the values 1 and 3 meet end to end. Without blending there are two colors. With
# blending there are colors between them, and half way both have the same weight.
test_colors_blend_where_vessels_do() {
    local model
    printf '1 1 -30 10 0 10 -1\n2 3 0 10 0 10 1\n3 3 30 10 0 10 2\n' >tree.swc
    corcast convert tree.swc tree.csv
    sed '/^#/!{s/$/,1/;}' tree.csv | awk -F, -v OFS=, '/^#/ { print; next } !head { $NF = "load"; head = 1 } /^3,/ { $NF = 3 } { print }' >load.csv
    for model in isosurface blob; do
        run_ok corcast render --exact load.csv --quiet --look flat $VIEW --model $model --color-by load -o segment.ppm
        run_ok corcast render --exact load.csv --quiet --look flat $VIEW --model $model --color-by load --color-blend blended -o blended.ppm
        [ "$(numbers segment.ppm | sort -u | wc -l)" = 3 ] || fail "expected two colors by segment as $model"
        numbers blended.ppm | sort -u >seen
        [ "$(wc -l <seen)" -ge 6 ] || fail "expected colors between the two as $model, got $(wc -l <seen)"
        # Columns 29 and 30 of 60 are 1.06 mm to either side of the middle: entries 128 and 127 of
        # the map.
        numbers blended.ppm | awk 'NR % 60 == 30 || NR % 60 == 31' | sort -u | grep -v 255 >middle
        [ "$(wc -l <middle)" = 2 ] && [ "$(awk '{ sum += $2 } END { print int(sum / 2) }' middle)" -ge 142 ] &&
            [ "$(awk '{ sum += $2 } END { print int(sum / 2) }' middle)" -le 146 ] ||
            fail "expected the middle of the map in the middle as $model, got '$(cat middle)'"
        run_ok corcast render --exact load.csv --quiet --look flat $VIEW --model $model --color-by load --classes 2 --color-blend blended -o steps.ppm
        [ "$(numbers steps.ppm | sort -u | wc -l)" = 3 ] || fail "expected two classes as $model"
    done
    refuses '--color-blend is for --model isosurface and blob' --model joined --color-by level --color-blend blended
    refuses 'the colors of --colormap Set1 are separate and blend only with --classes' \
        --model blob --color-by level --colormap Set1 --color-blend blended
    refuses '--color-blend needs --color-by' --model blob --color-blend blended
    printf 'id,0,0.5\n2,1,2\n3,3,4\n' >load.csv
    run corcast scene tree.swc --quiet --color-by load.csv:load --model blob --color-blend blended -o no.pov
    expect_status 2
    expect_sentence 'colors that change with time cannot blend in a POV-Ray scene; choose one time with --moment'
    run_ok corcast scene tree.swc --quiet --color-by load.csv:load --moment 2 --model blob --color-blend blended -o yes.pov
}

test_the_maps_are_listed_with_licences_and_drawn() {
    run_ok corcast colormaps --cite -o maps.ppm
    expect_same stdout <(for map in "$REPO"/templates/colormaps/*.txt; do
        name=$(basename "$map" .txt)
        printf '%s\t' "$name"
        sed -n 's/^# //p' "$map" | tr '\n' ' ' | sed -E 's/.*Cite: (.*) One color.*/\1\n/'
    done)
    [ "$(grep -c 'Licence: ' stdout)" = "$(wc -l <stdout)" ] || fail "expected a licence of each map"
    [ "$(sed -n 2p maps.ppm)" = "512 392" ] || fail "expected 12 strips, got $(sed -n 2p maps.ppm)"
    tail -c $((512 * 392 * 3)) maps.ppm | tail -c $((512 * 3 * 9)) | head -c 3 | od -An -tu1 | grep -qx ' *68 *1 *84' ||
        fail "expected the last strip to begin with viridis' first color"
}

test_ends_of_a_range_may_be_any_numbers() {
    run_ok corcast grow --terminals 9 --seed 3 --quiet -o tree.swc
    run_ok corcast render tree.swc --color-by flow --range=-3e9,7.5e8 --size 20x20 -o p.ppm
    says 'corcast: flow −3×10⁹ to 7.5×10⁸ ml/min, as given'
}

run_tests "$@"
