#!/usr/bin/env bash
# Unusual trees, as found in files of others. Every model of primitives draws them, ray by ray and
# in tiles, or reports in one message why not. tests/povray compares some of the pictures with
# POV-Ray's.
. "$(dirname "$0")/../lib.sh"

# rows ROW ...: writes tree.swc with the SWC rows.
rows() {
    printf '%s\n' "$@" >tree.swc
}

each_way() {
    local model projection
    for model in 'cylinders' 'rounded' 'joined' 'joined --joints paper'; do
        for projection in orthographic perspective; do
            "$@" --model $model --projection $projection
        done
    done
}

# draws OPTION ...: both methods draw a picture whose planes contain no NaN. The two pictures differ
# by at most two levels, except in 3 pixels.
draws() {
    local method
    for method in trace raster; do
        run timeout 300 "$CORCAST" render --antialias 1 tree.swc --size 120x120 --quiet --method $method \
            --planes depth,normal,id "$@" -o $method.ppm
        expect_status 0
        ! tail -n +4 $method.normal.pfm | od -A n -t f4 -v | grep -qi nan || fail "expected no NaN with $method $*"
    done
    levels trace.ppm >trace.levels
    levels raster.ppm >raster.levels
    paste trace.levels raster.levels | awk '
        { d = $1 - $2; if (d > 2 || d < -2) off[int((NR - 1) / 3)] = 1 }
        END { for (p in off) n++; exit n > 3 }' || fail "expected trace and raster to agree with $*"
    [ "$(sort -u trace.levels | wc -l)" -gt 20 ] || fail "expected a shaded picture with $*"
}

levels() {
    pnmtoplainpnm "$1" | tail -n +4 | tr -s ' ' '\n' | grep -v '^$'
}

# refuses PATTERN OPTION ...: `render` refuses the tree with a sentence that matches the pattern.
refuses() {
    local sentence=$1
    shift
    run timeout 300 "$CORCAST" render --exact tree.swc --size 40x40 "$@" -o picture.ppm
    expect_status 2
    expect_sentence "$sentence"
    [ ! -e picture.ppm ] || fail "expected no picture"
}

# star N: writes a tree with a root vessel and N daughters at its end, spread evenly over all
# directions.
star() {
    awk -v n="$1" 'BEGIN {
        print "1 3 0 9.3 0 1.2 -1\n2 3 0 0 0 1.2 1"
        for (i = 0; i < n; i++) {
            y = 1 - 2 * (i + 0.5) / n; q = sqrt(1 - y * y); a = 2.39996323 * i; l = 20 + i % 7
            printf "%d 3 %.9g %.9g %.9g 0.0%d 2\n", i + 3, l * q * cos(a), l * y, l * q * sin(a), 2 + i % 5
        }
    }' >tree.swc
}

# within SECONDS COMMAND ...: runs the command with a limit on processor time.
within() {
    run bash -c 'ulimit -t "$0"; exec "$@"' "$@"
}

test_a_node_of_a_hundred_thousand_daughters_is_drawn_in_seconds() {
    local model
    star 100000
    for model in cylinders rounded; do
        within 8 "$CORCAST" render --antialias 1 tree.swc --model $model --method raster --size 40x30 -o $model.png
        expect_status 0
    done
}

test_a_node_of_thousands_of_daughters_is_joined_in_seconds() {
    star 12000
    within 10 "$CORCAST" render --antialias 1 tree.swc --model joined --method raster --size 40x30 -o joined.png
    expect_status 0
}

test_a_scene_of_cells_that_would_take_minutes_to_find_is_refused_with_a_sentence() {
    rows '1 3 0 0 0 1 -1' '2 3 4.1 0 0 0.7 1' '3 3 7.3 2.2 0 0.5 2' '4 3 7.1 -2.9 1 70194 2' '5 3 11 3.4 2 0.4 3'
    within 30 "$CORCAST" scene tree.swc --quiet --model isosurface -o tree.pov
    expect_status 2
    grep -q 'radii that differ too much' stderr || fail "expected the reason$(said)"
    expect_only tree.swc
}

test_twelve_hundred_daughters_at_one_node() {
    cp "$DATA/star.swc" tree.swc
    [ "$(grep -c ' 2$' tree.swc)" -ge 1200 ] || fail "expected 1200 daughters"
    each_way draws
}

test_more_daughters_at_one_node_than_povray_paints() {
    run_ok corcast scene "$DATA/star.swc" --quiet --model isosurface -o plain.pov
    run corcast scene "$DATA/star.swc" --quiet --model isosurface --color-by length -o painted.pov
    expect_status 2
    grep -q 'can color at most 256' stderr || fail "expected the reason$(said)"
    expect_only plain.pov plain.inc
}

test_all_segments_on_one_line() {
    cp "$DATA/collinear.swc" tree.swc
    each_way draws
}

test_every_vessel_wider_than_long() {
    cp "$DATA/stout.swc" tree.swc
    each_way draws
}

test_segments_without_length() {
    rows '1 3 0 0 0 1 -1' '2 3 0 0 0 1 1' '3 3 5 0 0 1 2' '4 3 5 0 0 0.5 3' '5 3 8 3 0 0.5 4'
    each_way draws
}

test_a_radius_of_a_millionth_of_a_micrometre() {
    rows '1 3 0 0 0 1 -1' '2 3 5 0 0 1e-9 1' '3 3 5 5 0 1 2'
    each_way draws
}

test_a_radius_of_a_thousand_kilometres() {
    rows '1 3 0 0 0 1e9 -1' '2 3 5 0 0 1e9 1'
    each_way refuses 'the segment of node 2 is farther than 1e\+07 mm from the origin'
}

test_two_hundred_segments_at_one_place() {
    rows '1 3 0 0 0 1 -1'
    seq -f '%g 3 5 1.25 2 1 1' 2 200 >>tree.swc
    each_way draws
    run_ok corcast scene tree.swc --model blob -o scene.pov
    rows '1 3 0 0 0 1 -1'
    seq 2 200 | awk '{ print $1, 3, 5, 1.25, 2 + $1 / 1e4, 1, 1 }' >>tree.swc
    run corcast scene tree.swc --model blob -o scene.pov
    expect_status 2
    expect_sentence '[0-9]+ segments overlap at \('
}

# scaled POWER: writes a tree of size 2^POWER times 9 mm.
scaled() {
    awk -v k="$(awk "BEGIN { printf \"%.20g\", 2 ^ $1 }")" 'BEGIN {
        n = split("0 0 0 1 -1;0 -6 0 1 1;3 -9 2 0.8 2;-3 -9 -1 0.7 2", rows, ";")
        for (i = 1; i <= n; i++) {
            split(rows[i], f, " ")
            printf "%d 3 %.17g %.17g %.17g %.17g %d\n", i, f[1] * k, f[2] * k, f[3] * k, f[4] * k, f[5]
        }
    }' >tree.swc
}

# vessel_pixels OPTION ...: prints the number of pixels of an unlit picture that show the tree.
vessel_pixels() {
    run_ok corcast render tree.swc --input-unit mm --look flat --size 48x48 --antialias 1 "$@" -o p.ppm
    tail -c 6912 p.ppm | od -An -v -tu1 -w3 | grep -vc '255 255 255'
}

# POV-Ray ignores hits nearer than fixed lengths, which do not scale with the tree. The default
# camera keeps far enough away.
test_a_tree_of_a_millionth_of_a_millimetre_is_drawn_like_a_large_one() {
    local model power large
    for model in cylinders joined rounded isosurface blob mesh; do
        scaled 0
        large=$(vessel_pixels --model $model)
        for power in -12 -24; do
            scaled $power
            [ "$(vessel_pixels --model $model)" -eq "$large" ] ||
                fail "expected $large pixels of $model at 2^$power, got $(vessel_pixels --model $model)"
            [ $model = rounded ] || [ "$(vessel_pixels --model $model --exact)" -eq "$large" ] ||
                fail "expected $large exact pixels of $model at 2^$power"
        done
    done
}

test_what_the_limits_of_povray_hide_of_a_tiny_tree_is_named() {
    scaled -14
    run corcast render tree.swc --input-unit mm --model blob --projection perspective --size 48x48 -o p.png
    expect_status 2
    expect_sentence 'the whole tree is nearer to the camera than 0.01 mm, where neither POV-Ray nor render draws it'
    run_ok corcast render tree.swc --input-unit mm --model joined --shadows on --size 48x48 -o p.png
    grep -q 'parts nearer than 0.001 mm to a lit point cast no shadow on it' stderr || fail "expected shadows to be named$(said)"
    scaled -18
    run_ok corcast render tree.swc --input-unit mm --model rounded --exact --size 48x48 -o p.png
    grep -q '[1-9][0-9]* spheres have a radius of at most 1e-05 mm' stderr || fail "expected balls to be named$(said)"
    run_ok corcast render tree.swc --input-unit mm --model cylinders --projection perspective --size 48x48 -o p.png
    grep -q 'parts of the tree nearer to the camera than 0.0001 mm are not drawn' stderr || fail "expected the camera's limit$(said)"
}

# wall_rows MODEL ...: prints the number of rows that show a wall, of 300 rows of 0.01 mm across the
# middle of the vessel.
wall_rows() {
    run_ok corcast render tree.swc --input-unit mm --model "$@" --exact --antialias 1 --size 2x300 --location 5,0,50 \
        --look-at 5,0,0 --up 0,1,0 --height 3 --planes id -o p.ppm
    pamcut -left 1 -width 1 p.id.ppm | pnmtoplainpnm | tail -n +4 | tr -s ' ' '\n' | grep . | paste - - - |
        grep -vc '^0[[:space:]]0[[:space:]]0$'
}

# Segments between the same two points: two sisters, two sisters with a duplicated first node, and a
# segment that leads back; each pair in both orders. Every model draws the thicker segment and warns
# that it leaves the other out.
test_of_segments_between_the_same_two_points_the_thickest_is_drawn_in_every_model() {
    local model radii tree rows
    for radii in '1 1.4' '1.4 1'; do
        set -- $radii
        for tree in "2 3 10 0 0 $1 1|3 3 10 0 0 $2 1" "2 3 10 0 0 $1 1|3 3 0 0 0 $1 1|4 3 10 0 0 $2 3" \
            "2 3 10 0 0 $1 1|3 3 0 0 0 $2 2"; do
            printf '1 3 0 0 0 1 -1\n%s\n' "${tree//|/$'\n'}" >tree.swc
            for model in cylinders joined rounded blob mesh isosurface 'isosurface --potential graph'; do
                # shellcheck disable=SC2086
                rows=$(wall_rows $model)
                [ "$rows" -ge 278 ] && [ "$rows" -le 281 ] || fail "expected 280 rows of $model from $tree, got $rows"
                grep -q "corcast: 1 of [23] segments are inside other segments between the same two points and are not drawn" stderr ||
                    fail "expected $model to name the segment it leaves out of $tree$(said)"
            done
            run_ok corcast export tree.swc --input-unit mm -o tree.stl
            grep -q "corcast: 1 segment is inside other segments between the same two points and left out" stderr ||
                fail "expected export to name the segment it leaves out of $tree$(said)"
        done
    done
}

test_a_vessel_that_turns_back_into_itself() {
    rows '1 3 0 0 0 1 -1' '2 3 5 0 0 1 1' '3 3 0 0 0 1 2'
    each_way draws
}

test_a_camera_inside_a_vessel() {
    local model
    rows '1 3 0 0 0 1 -1' '2 3 5 0 0 1 1' '3 3 8 3 0 .5 2' '4 3 8 -3 0 .5 2'
    for model in $(corcast models | cut -f 1); do
        run_ok corcast render --exact tree.swc --model $model --projection perspective --location 2.5,0,0 --look-at 8,0,0 \
            --size 40x40 --planes depth -o picture.ppm
        ! tail -n +4 picture.depth.pfm | od -A n -t f4 -v | grep -qiE 'nan|inf' ||
            fail "expected to see the vessel's wall everywhere in $model"
    done
}

test_a_tree_a_kilometre_away() {
    rows '1 3 1e6 1e6 -1e6 1 -1' '2 3 1000005 1e6 -1e6 1 1' '3 3 1000008 1000003 -1e6 0.5 2' \
        '4 3 1000008 999997 -1e6 0.5 2'
    each_way draws
}

test_a_tree_without_segments() {
    rows '1 3 0 0 0 1 -1'
    each_way refuses 'the tree has nothing to draw'
}

run_tests "$@"
