#!/usr/bin/env bash
# The documents: links lead to existing files, and numbers agree with the program.
. "$(dirname "$0")/lib.sh"

test_documents_link_only_to_what_exists() {
    local document link
    for document in README.md CHANGELOG.md $(cd "$REPO" && echo docs/*.md); do
        for link in $(grep -oE '\]\([^)#:]+[)#]' "$REPO/$document" | sed 's/^](//; s/[)#]$//'); do
            [ -e "$REPO/$(dirname "$document")/$link" ] || fail "$document links to $link, which does not exist"
        done
    done
}

# Lines may be longer in tables, code, links to pictures, and generated text: the reference, and the
# parts that `make power` writes.
test_documents_are_wrapped_at_100_columns() {
    local document
    for document in README.md $(cd "$REPO" && ls docs/*.md docs/decisions/*.md | grep -vx docs/REFERENCE.md); do
        sed '/^<!-- .*: begin -->/,/^<!-- .*: end -->/d; /^```/,/^```/d; /^|/d; /^    /d; /^!\[/d' "$REPO/$document" >prose
        ! LC_ALL=C.UTF-8 grep -E '^.{101}' prose >long || fail "$document has a line of more than 100 columns: $(head -1 long)"
    done
}

# says DOCUMENT WORDS: the document in docs contains the words, regardless of line breaks.
says() {
    tr -s '\n ' '  ' <"$REPO/docs/$1" | grep -qF -- "$2" || fail "expected docs/$1 to say '$2'"
}

# agree DOCUMENT: reads lines "WORDS @ FILE @ CODE" from standard input. The document must contain
# the words, and the file the code. The file is in src, templates or tests/fit; its folder is needed
# if the name is not unique. This ties numbers in the documents to constants in the code that no
# output shows. To change such a number, change both.
agree() {
    local words file code path
    while IFS=@ read -r words file code; do
        words=$(echo "$words" | sed 's/^ *//; s/ *$//') file=${file// /}
        says "$1" "$words"
        path=$(find "$REPO/src" "$REPO/templates" "$REPO/tests/fit" -path "*/$file")
        [ -f "$path" ] || fail "docs/$1 says '$words', but there is no one file $file that could hold it"
        tr -s '\n ' '  ' <"$path" | grep -qF -- "${code# }" || fail "docs/$1 says '$words', but $file does not have '${code# }'"
    done
}

# Mutable globals exist only where signal handlers or libraries leave no alternative.
test_architecture_names_each_mutable_global() {
    local file
    cd "$REPO" || fail "no repository"
    for file in $(grep -lE '^static (volatile|_Thread_local|struct sigaction|[a-z]+ [a-z_]+;)' -r src --include=*.c); do
        grep -q "\`${file#src/}\`" docs/ARCHITECTURE.md || fail "docs/ARCHITECTURE.md does not name $file, which has a mutable global"
    done
}

test_the_numbers_of_growth_are_those_of_the_source() {
    run_ok corcast grow --help
    expect_stdout '^ +default: 8\]$|1000; default: 8\]$'
    says METHODS.md 'The nearest segments (8; `--candidates`)'
    agree METHODS.md <<'END'
one point in three is far enough @ grow/grow.c @ TOSSES_PER_ADDED = 3 }
1.15 times what the rule asks for, and distances 1.1 times @ connection.c @ length_reserve = 1.15, clearance_reserve = 1.1;
changes the numbers of its eight nearest ancestors at once @ network.c @ LEVELS = 8 }
whenever the tree has grown by a fifth @ grow/grow.c @ refresh_growth = 1.2;
ahead of its share by more than a sixteenth @ forest.c @ lead = 1.0 / 16;
all by 1.1, and those of segments that break a rule by 2.2 @ refine_penalty.c @ rise = 1.1, steep_rise = 2.2;
as far as the rules are kept with 0.15 of the radii to spare @ repair.c @ relaxed_spare = 0.15,
Penalties rise twentyfold @ grow/refine/refine.c @ first_rate = 0.1, last_rate = 2;
a tenth of it, or the cost of 40 moves per terminal, at most half @ grow/refine/refine.c @ last_moves = 40, least_left = 0.1, most_left = 0.5;
the same method with 2,000 moves per terminal @ grow/refine/refine.c @ [GROW_REFINE_ANNEAL] = 2000}
20 moves times the square of the number of terminals, or 2,000 times the number if that is less @ grow/refine/refine.c @ moves_per_square = 20, most_per_terminal = 2000;
*topology* has 88 @ grow/refine/refine.c @ [GROW_REFINE_TOPOLOGY] = 88,
until they agree to 10⁻¹³ @ finish.c @ agreement = 1e-13;
256 points per terminal, and up to 4,096 if the total stays below two million @ segment_weights.c @ least_points = 256, most_points = 4096, all_points = 2e6;
END
}

test_the_numbers_of_the_potential_are_those_of_the_source() {
    agree METHODS.md <<'END'
With eps = 10⁻⁶ (`CELL_TERM_CUTOFF`) that is 1.85 · 10⁻⁶ n r @ field.h @ #define CELL_TERM_CUTOFF 1e-6
with Phi clamped to [10⁻⁵, 0.2] @ field.h @ #define LOG_FORM_FLOOR 1e-5
with Phi clamped to [10⁻⁵, 0.2] @ field.h @ #define LOG_FORM_CEILING 0.2
`Phi'^2 >= 4.6 M lack` @ kernel_potential.h @ #define CROSSING_FACTOR 4.6f
Within 2 % of C and with ten times that certainty @ kernel_trace.h @ #define NEWTON_DEFICIT (2e-2f * LEVEL)
or within 0.1 %, Newton's method closes it @ kernel_trace_common.h @ #define MAX_MARGIN (1e-3f * LEVEL)
come to where the margin exceeds 10⁻³ C @ kernel_trace.h @ precise = margin <= MAX_MARGIN
does not count where Phi is within 1 % of C and falls @ fieldcast.c @ sample->phi < 1.01 * FIELD_LEVEL && sample->slope < 0
lie in one plane (to 10⁻⁷ / k) @ fieldterms.c @ <= 1e-7;
to within 4 · 10⁻⁶ of ln C @ kernel_trace_flat.h @ #define PLANE_CLOSE 3e-6f
10⁻⁶ each: `exp(-d^2)` times the term's peak is below it @ field.h @ #define TILE_TERM_CUTOFF 1e-6
with an allowance for 20 dropped terms @ kernel_trace_common.h @ #define MARGIN_DROPPED 2e-5f
6 · 10⁻⁷ for each term @ kernel_trace_common.h @ #define MARGIN_TERM 6e-7f
1.2 · 10⁻⁷ e k B for each term @ kernel_trace_common.h @ #define MARGIN_POSITION 1.2e-7f
of at most 2 of its own radii @ vesseltree.h @ #define BLEND_REACH 2
1 % of the one weighing as much as 4.3° of the other @ fit_blob.c @ #define DISTANCE 0.03
1 % of the one weighing as much as 4.3° of the other @ fit_blob.c @ #define ANGLE 13.0
At the distance D r the field is at most `1.05 exp(2 - 2 D^2)` @ kernel_blob.h @ #define ENVELOPE 1.05f
nowhere below -0.0085 @ kernel_blob.h @ #define DIP 0.0085f
1/2 + 0.62 y of it y r within an end @ kernel_blob.h @ #define INWARDS 0.62f
the largest of 37.5 (1 @ kernel_blob.h @ #define NEAR_END_CURVED 37.5f
(1 - e² / 1.06²) @ kernel_blob.h @ #define NEAR_END_WIDTH 1.06f
18.9 (1 - d² @ kernel_blob.h @ #define NEAR_AXIS_CURVED 18.9f
/ 1.21²) @ kernel_blob.h @ #define NEAR_AXIS_WIDTH 1.21f
6.8 (1 - d² / @ kernel_blob.h @ #define FAR_CURVED 6.8f
1.675²) and 0 @ kernel_blob.h @ #define FAR_WIDTH 1.675f
p from 24 to 96 @ fit_blob.c @ for (double power = 24; power <= 96; power *= 2)
END
}

test_the_numbers_of_pictures_are_those_of_the_source() {
    agree METHODS.md <<'END'
`Phi_i <= B = exp(-d^2) min(1, h / s)` @ kernel_potential.h @ term->peak = term->gauss * lanes_min(term->h_per_sine, lanes_set(1));
4 exp(-3/2) h / s, 2 sqrt(2/e) / (sqrt(pi) a) @ kernel_potential.h @ term->h_per_sine * BEND_ACROSS, BEND_ALONG / lanes_max(term->cosine, tiny)
packets of 16 (AVX-512), 8 (AVX2 with FMA) or 4 rays @ lanes.h @ #define LANES 16
A band begins at a multiple of eight rows @ render/render.h @ RENDER_BAND_STEP = 8 }
in which tiles of 8 x 8 pixels @ tile.h @ TILE_SIDE = 8,
longer than 2 x 16384 pixels @ rasteritem.c @ max_length_px = 16384;
4 eps H, 0.004 pixels for the longest @ rasteritem.c @ length / 2 + radius > max_length_px * pixel
cylinders seen within 0.02 rad of their axis @ rasteritem.c @ min_sine = 0.02;
cylinders seen within 0.02 rad of their axis @ kernel_round.h @ steep_sine2 = 4e-4f;
within 10⁻⁴ r of the ray @ kernel_joint.h @ off_joint_line = 1e-4f;
0.001 mm and 3 · 2^-23 of the scene's radius @ rastershadow.c @ SHADOW_NEAREST_MM + 0x3p-23 * lightview_radius
0.001 mm and 3 · 2^-23 of the scene's radius @ shadowengine.h @ SHADOW_NEAREST_MM 1e-3
within 1.16 radii of the scene's middle cast rays @ lightview.c @ min_distance_in_radii = 1.16;
at most a quarter of a pixel apart @ zbuffer.c @ spacing_px = 0.25;
nothing below the horizon covers it, and at most 3.5 mean radii @ occluders.c @ max_half_width_in_radii = 3.5;
and whose normals are within 60 degrees of its normal @ occlusion.c @ min_cosine = 0.5f;
each within 5 / 4 of a pixel of the other's tangent plane @ visibility.h @ limit = 1.25f * a->pixel_mm;
Otherwise it has the value of another pixel within two @ visibility.c @ enum { SEARCH_PIXELS = 2 };
followed over 16 of its ellipses @ ink.c @ RULINGS = 16 };
found on each by Newton's iteration @ inkjoint.c @ NEWTON_STEPS = 4 };
a ray from 10⁻⁶ radii beside it @ ink.c @ #define BESIDE 1e-6
located by bisection to a hundredth of the line width @ ink.c @ HALVINGS = 6 }
END
}

test_the_limits_of_the_tiers_are_those_of_the_source() {
    agree METHODS.md <<'END'
| pixels off by more than N levels | 2 ppm, N = 0, or one code of 16 bits | @ tolerance.c @ {LIMIT_COLOR_PPM, 2}
| pixels off by more than N levels | 2 ppm, N = 0, or one code of 16 bits | @ tolerance.c @ {LIMIT_COLOR_LEVELS, 1 / 257.0}
| ... off the band, in the band | | 2000 ppm, 10000 ppm, N = 2 | @ tolerance.c @ {LIMIT_INTERIOR_PPM, 2000}
| ... off the band, in the band | | 2000 ppm, 10000 ppm, N = 2 | @ tolerance.c @ {LIMIT_BAND_PPM, 10000}
| largest difference off the band | 1 level | @ tolerance.c @ {LIMIT_INTERIOR_LEVELS, 1}
| mean difference | | 0.01 levels | @ tolerance.c @ {LIMIT_BIAS_LEVELS, 0.01}
| pixels brighter less pixels darker, over the root of their sum | | 6 | @ tolerance.c @ {LIMIT_SIGN_SIGMA, 6}
| gain, offset | | 0.0005, 0.0255 levels | @ tolerance.c @ {LIMIT_GAIN, 0.0005}
| gain, offset | | 0.0005, 0.0255 levels | @ tolerance.c @ {LIMIT_OFFSET_LEVELS, 0.0255}
| outline of the visible vessels | | 0.002 px | @ tolerance.c @ {LIMIT_SILHOUETTE_PX, 0.002}
outline (of at least 8 px) | | 0.12 levels, 0.15 px | @ tolerance.c @ {LIMIT_SEGMENT_LEVELS, 0.12}
outline (of at least 8 px) | | 0.12 levels, 0.15 px | @ tolerance.c @ {LIMIT_SEGMENT_PX, 0.15}
| segments of more than 2 pixels visible in one picture only | | 0 | @ tolerance.c @ {LIMIT_SEGMENTS_MISSING, 0}
| ids that differ | 2 ppm | 0 off the band, 2000 ppm in it | @ tolerance.c @ {LIMIT_ID_PPM, 2}
| ids that differ | 2 ppm | 0 off the band, 2000 ppm in it | @ tolerance.c @ {LIMIT_ID_INTERIOR_PPM, 0}
| ids that differ | 2 ppm | 0 off the band, 2000 ppm in it | @ tolerance.c @ {LIMIT_ID_BAND_PPM, 2000}
| normals | 2 ppm beyond 0.03° | 1 % beyond 0.1°, median 0.02° | @ tolerance.c @ {LIMIT_NORMAL_MAX_DEG, 0.03}
| normals | 2 ppm beyond 0.03° | 1 % beyond 0.1°, median 0.02° | @ tolerance.c @ {LIMIT_NORMAL_MAX_DEG, 0.1}
| normals | 2 ppm beyond 0.03° | 1 % beyond 0.1°, median 0.02° | @ tolerance.c @ {LIMIT_NORMAL_PPM, 10000}
| normals | 2 ppm beyond 0.03° | 1 % beyond 0.1°, median 0.02° | @ tolerance.c @ {LIMIT_NORMAL_MEDIAN_DEG, 0.02}
| visible in one plane only (depth, normal) | 2 ppm | @ tolerance.c @ {LIMIT_COVERAGE_PPM, 2}
2000 ppm, 15000 ppm, N = 2 | @ tolerance.c @ {LIMIT_BAND_PPM, 15000}
0.0005, 0.15 levels | @ tolerance.c @ {LIMIT_OFFSET_LEVELS, 0.15}
1 level, 0.15 px | @ tolerance.c @ {LIMIT_SEGMENT_LEVELS, 1}, {LIMIT_SEGMENT_PX, 0.15}
99 % within 10⁻⁴ of the depth @ tolerance.c @ LIMIT_DEPTH_P99_PART, depth_mm > 0 ? depth_mm : 1e-4}
| largest missing or extra region | | | 2 pixels | @ tolerance.c @ {LIMIT_REGION_PIXELS, 2}
one segment: mean difference (of at least 64 pixels), outline (of at least 8 px) @ ledger.c @ LEVELS_MIN_PIXELS = 64, OUTLINE_MIN_PX = 8
segments of more than 2 pixels visible in one picture only @ ledger.c @ MISSING_MIN_PIXELS = 3
END
}

test_the_numbers_of_comparing_are_those_of_the_source() {
    agree METHODS.md <<'END'
one side over 1.5 times as bright @ pixel_counts.c @ sum_a > 1.5 * sum_b || sum_b > 1.5 * sum_a
moved by up to 48 whole pixels (less than 1/50 of the differences remain @ cause.c @ REACH = 48
moved by up to 48 whole pixels (less than 1/50 of the differences remain @ cause.c @ leaves(trial.before, trial.after, 0.02)
49 of 50 codes that are off by more than a level @ compare/cause/tone.c @ 50 * fit->misfits <= fit->beyond
a twenty-fifth of the squares @ compare/cause/warp.c @ 25 * after < before
three quarters of its rim @ compare/cause/place.c @ 4 * lack.background >= 3 * lack.rim
by more than 2 levels off an outline @ compare/cause/place.c @ SLIGHT = 2
POV-Ray sees a later root, to 0.02 r @ explain.c @ root_tolerance_radii = 0.02;
(cosine to the normal below 0.1) @ explain.c @ max_grazing_cosine = 0.1;
shadows that count from 10⁻³ on, which is corcast's, and from 10⁻⁴ on @ explain.c @ shadow_ray_start_mm = 1e-3, shadow_cache_start_mm = 1e-4;
no neighbouring pixel differs | 40 ppm, or 6 pixels | @ settled.c @ [SETTLED_ROOT] = {"missed root", "pixels at which POV-Ray missed a root", 40, 6},
so far before and behind | 40 ppm, or 6 pixels | @ settled.c @ "pixels at which POV-Ray's root is a little off", 40, 6},
as many rays as graze | 200 ppm, or 12 pixels | @ settled.c @ "pixels at which POV-Ray missed a root on the way to a light", 200, 12},
| 1000 ppm, or 20 pixels | @ settled.c @ "pixels on their own horizon, left to POV-Ray's shadow cache", 1000, 20},
it may be off by the accuracy of its cell, r / 300 @ celltree.c @ accuracy_ratio = 1.0 / 300,
not judged but the mean difference is, to 1.5 levels @ verification.c @ [LIMIT_BIAS_LEVELS] = 1.5;
at 67.02 pixels per degree @ flip_kernels.c @ pixels_per_degree = 67.0206451f;
Gaussian window of 11 x 11 @ ssim.c @ RADIUS = 5, TAPS = 2 * RADIUS + 1
K1 = 0.01, K2 = 0.03 @ ssim.c @ c1 = 0.01 * 255 * 0.01 * 255, c2 = 0.03 * 255 * 0.03 * 255
END
}

test_the_numbers_of_fields_and_joints_are_those_of_the_source() {
    agree METHODS.md <<'END'
1 mmHg = 133.322387415 Pa @ units.h @ mmhg * 133.322387415;
rho = 1.05 · 10⁻³ g/mm³ @ derive.h @ BLOOD_DENSITY_G_MM3 1.05e-3
0.32 R, 0.52 R and 0.16 R @ pulse_outlets.c @ part_before = 0.32, part_within = 0.52, part_behind = 0.16;
`m = 6 exp(-0.085 D) + 3.2 - 2.44 exp(-0.06 D^0.645)` @ viscosity.c @ 6 * elementary_exp(-0.085 * diameter) + 3.2 - 2.44 * elementary_exp(-0.06 * elementary_pow(diameter, 0.645));
Nothing passes at D <= 1.1 @ viscosity.c @ wall_layer = 1.1;
it ends when at most 1 % of the vessels change @ diameter_orders.c @ assign_orders(vessels, bin, largest, made) * 100 <= vessels->n;
parent and a daughter is less than 60 degrees @ joints.c @ sharp_cosine = 0.5;
END
}

test_the_limits_of_large_trees_are_those_of_the_source() {
    agree LARGE.md <<'END'
grows up to 50,000,000 terminals @ grow.h @ GROW_MAX_TERMINALS = 50000000,
ids of nodes go up to 100,000,000 @ tree.h @ TREE_MAX_ID = 100000000
files of trees up to 20 GB @ treeio.c @ MOST_BYTES 2e10
hold ids up to 16777215 @ image/image.h @ IMAGE_MAX_ID = 0xffffff
END
}

test_the_numbers_of_formats_are_those_of_the_source() {
    agree FORMATS.md <<'END'
trees above 20 GB @ treeio.c @ MOST_BYTES 2e10
scenes and reports above 4 GB @ job/verify/povray.c @ .most_bytes = 4e9
scenes and reports above 4 GB @ report_merge.c @ .most_bytes = 4e9
polygons and NIfTI files above 1 GB @ polygon_file.c @ .most_bytes = 1e9
polygons and NIfTI files above 1 GB @ mask_file.c @ .most_bytes = 1e9
meshes above 8 GB @ mesh_file.c @ .name = "an STL file", .most_bytes = 8e9
meshes above 8 GB @ mesh_file.c @ .name = "an OBJ file", .most_bytes = 8e9
pictures above 16 GB @ image_file.c @ .most_bytes = 16e9
INI files above 1 MB @ ini.c @ .most_bytes = 1e6
at most 10000 other columns @ builder.h @ BUILDER_MAX_COLUMNS = 10000
is an integer from 1 to 100000000 @ tree.h @ TREE_MAX_ID = 100000000
for `pries`, in [0, 0.95] @ viscosity.h @ MAX_HEMATOCRIT 0.95
less than a thousandth of the box around it @ domain.c @ least_filled = 1e-3;
more than 0.002 from its own @ profile.c @ <= 0.002
For pictures above 4 million pixels the page has no depths @ report_planes.c @ MOST_PIXELS = 1 << 22
END
    run_ok corcast render --help
    tr -s "\n " "  " <stdout >help && mv help stdout
    expect_stdout "memory MB [^-]*default: 128\\]"
    says FORMATS.md 'larger pictures than `--memory` MB (128)'
}

test_formats_lists_the_keys_of_a_tree() {
    sed -n '/^### Header/,/^## /s/^| `\([A-Za-z_]*\)` |.*/\1/p' "$REPO/docs/FORMATS.md" | sort >listed
    sed -n 's/.*{\.name = "\([A-Za-z_]*\)".*/\1/p' "$REPO/src/tree/meta.c" | sort >known
    expect_same listed known
}

# `--tolerance` accepts exactly the keys that FORMATS.md lists.
test_formats_lists_the_keys_of_a_tolerance() {
    sed -n '/^## Tolerances/,/^## /p' "$REPO/docs/FORMATS.md" | tr '\n' ' ' | sed 's/.*other keys are limits: `\([^`]*\)`.*/\1/; s/\. .*//' |
        tr ' ' '\n' | grep . | sort >listed
    sed -n 's/^    \[LIMIT_[A-Z0-9_]*\] = {"\([a-z0-9_]*\)".*/\1/p' "$REPO/src/compare/rules/tolerance.c" | sort >known
    expect_same listed known
}

test_the_numbers_for_povray_are_those_of_the_source() {
    agree POVRAY.md <<'END'
for each light with n . L >= 1e-10 @ shade.h @ #define MIN_LIT_COSINE 1e-10
is within 2.85 · 10⁻⁴ of erf @ cellfunction.c @ return form == ERF_FAST ? 2.85e-4
no wall by more than three times that @ cellfunction.c @ return (3 * erf_form_error(form) + 2e-5) * radius_mm;
POV-Ray holds at most 1,048,575 functions @ povray_joint.c @ POV-Ray can hold 1,048,575 functions
more than 349,000 joints @ povray_joint.c @ MAX_EXACT = 349000,
In a scene of more than 8,000 joints @ povray_joint.c @ MANY = 8000,
scenes of more than 3,000 segments the twelve @ povray_text.h @ MAX_INLINE_TERMS = 3000
- `f(x) <= M d(x) / 2`, because after a miss POV-Ray skips @ povray_joint.c @ 2 * steepest, folded
Its hits are within 2 · 10⁻⁹ radii @ joints.inc @ accuracy 2e-9 open
no tile has more than 400,000 cylinders @ emit/povray.c @ {MODEL_CYLINDERS, NULL, put_primitive_macros, put_primitives, 400000},
200,000 pieces of a joined tree, 32,768 segments of a blob @ emit/povray.c @ {MODEL_BLOB, find_visible_segments, put_blob_macros, put_blob, 32768},
of a mesh, or 100,000 cells @ emit/povray.c @ {MODEL_POTENTIAL, find_cells, put_cell_macros, put_cells, 100000},
tile is narrower than 8 pixels @ povray_tiles.c @ MIN_TILE_SIDE = 8 };
for at most 65,536 segments @ povray_blob.c @ GROUP = 256, MAX_PAINTED = GROUP * GROUP,
END
    # The polynomial in tanh is half of the polynomial in the source.
    local linear cubic
    read -r linear cubic < <(sed -n 's/.*\[ERF_FAST\] = {-\([0-9.]*\), -\([0-9.]*\),.*/\1 \2/p' \
        "$REPO/src/field/cellfunction.c" | awk '{ printf "%.14g %.14g\n", $1 / 2, $2 / 2 }')
    says POVRAY.md "\`tanh($linear u + $cubic u^3)\`"
}

# The stated deviations are those that fit_blob measures.
test_the_numbers_of_the_blob_are_those_that_fit_blob_prints() {
    local line
    run_ok make -C "$REPO" --no-print-directory fit-blob
    grep '^| [0-9]' stdout >rows
    [ "$(wc -l <rows)" -eq 5 ] || fail "expected 5 rows of deviations"
    while read -r line; do
        grep -qxF -- "$line" "$REPO/docs/METHODS.md" || fail "expected METHODS.md to have the row '$line'"
    done <rows
    sed -n 's/^tube: radius \(.*\), strength \([0-9.]*[1-9]\)0*$/| tube | | \1 r | \2 |/p
        s/^bead: offset \(.*\), radius \(.*\), strength \(.*\)$/| bead | \1 r | \2 r | \3 |/p' stdout >rows
    [ "$(wc -l <rows)" -eq 4 ] || fail "expected 4 components"
    while read -r line; do
        grep -qxF -- "$line" "$REPO/docs/METHODS.md" || fail "expected METHODS.md to have the row '$line'"
    done <rows
    expect_stdout '^free end: -2\.56 % of r, 8°; overshoot 0\.525 r$'
    says METHODS.md 'At a free end they are 2.56 % and 8°; it overshoots by 0.525 r'
    expect_stdout '^one tube of strength 4 and half balls: 21\.45 % of r, 33°; overshoot 0\.765 r$'
    says METHODS.md 'free ends overshoot by 0.765 r instead of 0.551 r'
    says METHODS.md 'half balls alone, the same measure is 21.45 % and 33°'
    expect_stdout '^segments 2 r long, the largest: 3\.50 % of r'
    expect_stdout '^segments 1 r long, the largest: 5\.14 % of r'
    says METHODS.md 'Where segments are only 2 r long, the largest distance is 3.50 %, where they are 1 r long 5.14 %'
}

test_the_citation_is_of_this_version() {
    python3 -c 'import yaml' 2>/dev/null || skip "python3-yaml is not installed"
    python3 - "$REPO/CITATION.cff" "$(corcast --version | cut -d " " -f 2)" 2>stderr <<'END' || fail "expected a citation$(said)"
import sys, yaml
citation = yaml.safe_load(open(sys.argv[1]))
missing = {"cff-version", "message", "title", "authors", "version", "license", "type"} - citation.keys()
assert not missing, f"it lacks {missing}"
assert citation["cff-version"] == "1.2.0" and citation["license"] == "MIT" and citation["title"] == "corcast"
assert str(citation["version"]) == sys.argv[2], f"it is of {citation['version']}"
assert all(author.get("name") for author in citation["authors"])
END
}

run_tests "$@"
