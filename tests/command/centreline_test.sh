#!/usr/bin/env bash
# Measured trees: smoothed and resampled centrelines, types, repaired radii, statistics as CSV.
. "$(dirname "$0")/../lib.sh"

# sums FILE: prints the total length, the volume and the sum of l / r^4 of a SWC file.
sums() {
    awk '!/^#/ { x[$1] = $3; y[$1] = $4; z[$1] = $5
        if ($7 > 0) { l = sqrt((x[$1] - x[$7])^2 + (y[$1] - y[$7])^2 + (z[$1] - z[$7])^2)
            length_ += l; volume += 3.14159265358979 * $6^2 * l; resistance += l / $6^4 } }
        END { printf "%.9g %.9g %.9g\n", length_, volume, resistance }' "$1"
}

test_smoothing_removes_the_steps_of_a_voxel_path() {
    # A helix of radius 20 and pitch 30 voxels, rounded to voxels.
    awk 'BEGIN { for (t = 0; t <= 12.6; t += 0.01) {
            p = sprintf("%d %d %d", 20 * cos(t) + 50.5, 20 * sin(t) + 50.5, 30 * t / 6.2832 + 0.5)
            if (p != last) print ++n, 5, p, 4, (n > 1 ? n - 1 : -1)
            last = p } }' >steps.swc
    run corcast convert steps.swc smooth.swc --smooth --step 3
    expect_status 0
    grep -q '^corcast: smoothed: nodes moved by up to ' stderr || fail "no report of the moves: $(cat stderr)"
    sums steps.swc >before
    sums smooth.swc >after
    awk 'BEGIN { exact = 12.6 * sqrt(20^2 + (30 / 6.2832)^2); getline before <"before"; getline after <"after"
        exit !(before / exact > 1.06 && after / exact > 0.985 && after / exact < 1.02) }' ||
        fail "length: $(cat before after)"
    # Both ends keep their positions.
    [ "$(sed -n '/^[^#]/{p;q}' smooth.swc | cut -d' ' -f3-5)" = "$(sed -n '/^[^#]/{p;q}' steps.swc | cut -d' ' -f3-5)" ] ||
        fail "the first node moved"
    [ "$(tail -1 smooth.swc | cut -d' ' -f3-5)" = "$(tail -1 steps.swc | cut -d' ' -f3-5)" ] || fail "the last node moved"
}

test_resampling_keeps_resistance_and_bifurcations() {
    printf '%s\n' '1 3 0 0 0 1 -1' '2 5 1 0 0 1 1' '3 5 2.5 0 0 0.7 2' '4 5 3.2 0 0 0.5 3' '5 6 4 1 0 0.3 4' \
        '6 6 4.4 1.5 0 0.2 5' '7 7 4 -1 0 0.4 4' >t.swc
    run_ok corcast convert t.swc r.swc --step 0.4 --quiet
    sums t.swc >before
    sums r.swc >after
    awk '{ getline other <"after"; split(other, b); exit ($1 / b[1] - 1)^2 > 1e-16 || ($3 / b[3] - 1)^2 > 1e-14 }' before ||
        fail "length or resistance changed: $(cat before after)"
    grep -q ' 3.2 0 0 ' r.swc || fail "the bifurcation is not there: $(cat r.swc)"
    awk '!/^#/ { x[$1] = $3; y[$1] = $4; if ($7 > 0) { l = sqrt((x[$1] - x[$7])^2 + (y[$1] - y[$7])^2)
        if (l < 0.3 || l > 0.55) exit 1 } }' r.swc || fail "segments are not near 0.4 mm: $(cat r.swc)"
    run_ok corcast convert t.swc long.swc --step 100 --quiet
    [ "$(grep -vc '^#' long.swc)" = 4 ] || fail "a branch has more than one segment: $(cat long.swc)"
}

test_types_are_a_field_and_stay_in_files() {
    local extension
    printf '%s\n' '1 3 0 0 0 1 -1' '2 5 1 0 0 1 1' '3 6 2 1 0 0.5 2' '4 11 2 -1 0 0.5 2' >t.swc
    for extension in vtp vtk csv graphml; do
        run_ok corcast convert t.swc t.$extension
        [ ! -s stderr ] || fail ".$extension: $(cat stderr)"
        run_ok corcast convert t.$extension back.swc
        [ "$(grep -v '^#' back.swc | cut -d' ' -f2 | sort -n | tr '\n' ' ')" = '3 5 6 11 ' ] || fail ".$extension: $(cat back.swc)"
    done
    run_ok corcast render t.swc --color-by type --size 60x60 -o t.png --quiet
    run_ok corcast convert t.swc f.segments.csv --fields type
    grep -q type f.segments.csv || fail "no column: $(head -2 f.segments.csv)"
}

test_gaps_of_radii_are_filled_along_the_branch() {
    printf '%s\n' '1 3 0 0 0 1 -1' '2 3 2 0 0 1 1' '3 3 4 0 0 0 2' '4 3 6 0 0 0.5 3' '5 3 8 0 0 -1 4' \
        '6 3 9 1 0 0 5' '7 3 9 -1 0 0.2 5' >t.swc
    run_ok corcast info t.swc --repair-radii --json
    expect_json stdout '.reading.repaired_radii == 3 and .reading.repaired_ids == [3, 5, 6]'
    run_ok corcast convert t.swc r.swc --repair-radii --quiet
    run_ok corcast info t.swc --repair-radii --radius 9 --json
    expect_json stdout '.reading.repaired_radii == 3 and .reading.given_radii == 0'
    # A missing radius is interpolated: half way between 1 and 0.5. At the end of a branch it is the
    # nearest radius. A branch without any radius gets that of the thinner neighbour.
    [ "$(grep -v '^#' r.swc | cut -d' ' -f6 | tr '\n' ' ')" = '1 1 0.75 0.5 0.5 0.5 0.2 ' ] || fail "$(cat r.swc)"
}

test_statistics_go_into_a_table() {
    run_ok corcast grow --terminals 30 --domain ball:9 --seed 2 -o t.swc --quiet
    run_ok corcast info t.swc --stats -o s.csv --json
    [ "$(head -1 s.csv)" = table,number,quantity,mean,sd ] || fail "header: $(head -1 s.csv)"
    jq -r '.stats.by_strahler[] | "strahler,\(.order),elements,\(.elements),"' stdout >orders
    grep -F strahler, s.csv | grep -v diameter- | grep ',elements,' | cmp -s - orders || fail "orders: $(head -3 s.csv orders)"
    run corcast info t.swc --stats -o s.json
    expect_status 2
    expect_sentence "'s.json' is not a file that ends in .csv"
    run corcast info t.swc -o s.csv
    expect_status 2
    expect_sentence '--stats'
}

run_tests
