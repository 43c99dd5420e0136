/* The implicit surface: value, gradient and first hits. */
#include "field/field.h"
#include "unit.h"

#include <stdint.h>
#include <stdlib.h>

#include "field_scenes.h"
#include <stdio.h>

static FieldSegment random_segment(Random *random)
{
    double radius = pow(10, uniform(random, -1.4, 0.6));
    Vec3 a = random_point(random, 7);
    double length = radius * pow(10, uniform(random, -1, 1.7));
    return (FieldSegment){
        .a = a, .b = vec3_add_scaled(a, random_direction(random), length), .radius_mm = radius};
}

/* A place up to `reach` radii from some place of the segment. */
static Vec3 random_place_near(const FieldSegment *segment, Random *random, double reach)
{
    Vec3 at = vec3_add_scaled(segment->a, vec3_sub(segment->b, segment->a), random_uniform(random));
    return vec3_add_scaled(at, random_direction(random),
                           reach * segment->radius_mm * random_uniform(random));
}

/* e^-2, at any radius. */
static void the_level_is_the_potential_at_the_radius_of_a_long_vessel(void **state)
{
    (void)state;
    const double radii[] = {0.0385, 2.385, 61.25};
    for (int i = 0; i < 3; i++) {
        double r = radii[i];
        const FieldSegment segment = {.a = {-50 * r, 0, 0}, .b = {50 * r, 0, 0}, .radius_mm = r};
        double term = potential_term(&segment, vec3(3 * r, 0.6 * r, 0.8 * r));
        assert_true(fabs(term - 0.1353352832366127) < 1e-15);
        assert_true(fabs(term - FIELD_LEVEL) < 1e-15);
    }
}

static void term_and_gradient_follow_the_definition(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 41);
    for (int i = 0; i < 20000; i++) {
        FieldSegment segment = random_segment(&random);
        Vec3 x = random_place_near(&segment, &random, 3.1), gradient;
        LongVec3 exact_gradient;
        double exact = (double)exact_term(&segment, long_vec3(x), &exact_gradient);
        double term = potential_term(&segment, x);
        assert_true(fabs(term - exact) <= 1e-13);
        assert_true(potential_term_gradient(&segment, x, &gradient) == term);
        Vec3 expected =
            vec3((double)exact_gradient.x, (double)exact_gradient.y, (double)exact_gradient.z);
        assert_true(vec3_distance(gradient, expected) <= 1e-12 / segment.radius_mm);
    }
}

static void gradient_is_the_slope_of_the_term(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 42);
    for (int i = 0; i < 2000; i++) {
        FieldSegment segment = random_segment(&random);
        Vec3 x = random_place_near(&segment, &random, 2.3), gradient;
        Vec3 d = random_direction(&random);
        potential_term_gradient(&segment, x, &gradient);
        long double h = 1e-6L * (long double)segment.radius_mm;
        LongVec3 ahead = long_vec3(x), behind = ahead;
        ahead.x += h * (long double)d.x, behind.x -= h * (long double)d.x;
        ahead.y += h * (long double)d.y, behind.y -= h * (long double)d.y;
        ahead.z += h * (long double)d.z, behind.z -= h * (long double)d.z;
        double slope =
            (double)((exact_term(&segment, ahead, NULL) - exact_term(&segment, behind, NULL)) /
                     (2 * h));
        assert_true(fabs(vec3_dot(gradient, d) - slope) <= 1e-9 / segment.radius_mm);
    }
}

static void term_keeps_its_digits_far_beyond_an_end(void **state)
{
    (void)state;
    FieldSegment segment = {.a = {1.25, -2, 0.5}, .b = {4.5, -2, 0.5}, .radius_mm = 0.785};
    for (double beyond = 0.1; beyond < 9; beyond += 0.37) {
        for (int end = 0; end < 2; end++) {
            Vec3 x = vec3(end ? 4.5 + beyond : 1.25 - beyond, -2.125, 0.75);
            double exact = (double)exact_term(&segment, long_vec3(x), NULL);
            assert_true(fabs(potential_term(&segment, x) / exact - 1) < 1e-12);
        }
    }
}

static void bound_holds_all_over_the_box_and_uses_the_true_distance(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 43);
    for (int i = 0; i < 3000; i++) {
        FieldSegment segment = random_segment(&random);
        if (i % 7 == 0)
            segment.b = vec3(segment.a.x, segment.a.y, segment.a.z - 1.83);
        Vec3 low = random_place_near(&segment, &random, 3);
        Vec3 size = vec3_scale(
            vec3(random_uniform(&random), random_uniform(&random), random_uniform(&random)),
            5 * segment.radius_mm);
        Box box = {low, vec3_add(low, size)};
        double bound = potential_term_bound(&segment, box), nearest2 = HUGE_VAL;
        for (int k = 0; k < 400; k++) {
            Vec3 at = vec3_add_scaled(segment.a, vec3_sub(segment.b, segment.a), k / 399.0);
            /* The place of the box nearest to a place of the segment, and any place. */
            Vec3 x = vec3(fmin(fmax(at.x, low.x), box.high.x), fmin(fmax(at.y, low.y), box.high.y),
                          fmin(fmax(at.z, low.z), box.high.z));
            nearest2 = fmin(nearest2, vec3_dot(vec3_sub(x, at), vec3_sub(x, at)));
            assert_true(potential_term(&segment, x) <= bound * (1 + 1e-12));
            x = vec3(uniform(&random, low.x, box.high.x), uniform(&random, low.y, box.high.y),
                     uniform(&random, low.z, box.high.z));
            assert_true(potential_term(&segment, x) <= bound * (1 + 1e-12));
        }
        double k2 = 2 / (segment.radius_mm * segment.radius_mm);
        double expected = potential_term_peak(&segment) * exp(-k2 * nearest2);
        double step = vec3_distance(segment.a, segment.b) / 399;
        assert_true(bound >= expected * (1 - 1e-9));
        assert_true(log(bound / expected) <= k2 * step * (2 * sqrt(nearest2) + step) + 1e-9);
    }
}

static void the_wall_of_a_long_vessel_is_as_steep_as_four_levels_a_radius(void **state)
{
    (void)state;
    FieldSegment segment = {.a = {-20, 0, 0}, .b = {20, 0, 0}, .radius_mm = 0.685};
    Vec3 gradient;
    double term = potential_term_gradient(&segment, vec3(0.5, 0, 0.685), &gradient);
    assert_true(fabs(term - FIELD_LEVEL) < 1e-15);
    assert_true(fabs(vec3_length(gradient) - 4 * FIELD_LEVEL / 0.685) < 1e-14);
}

static void log_form_is_the_distance_from_a_lone_vessel(void **state)
{
    (void)state;
    double s = 0.3425;
    FieldSegment segment = {.a = {-20, 0, 0}, .b = {20, 0, 0}, .radius_mm = 2 * s};
    for (double d = 0.63; d < 1.63; d += 0.081)
        assert_true(fabs(potential_log_form(potential_term(&segment, vec3(0.5, d, 0))) -
                         (d - 2 * s) / s) < 1e-12);
    assert_true(fabs(potential_log_form(FIELD_LEVEL)) < 1e-15);
    assert_true(potential_log_form(0) == potential_log_form(LOG_FORM_FLOOR));
    assert_true(potential_log_form(1.7) == potential_log_form(LOG_FORM_CEILING));
}

/* Three pixels: what both see square on, what one sees askew and the other not, what both miss. */
static void the_tolerance_grows_as_the_surface_turns_from_the_ray(void **state)
{
    (void)state;
    FieldSegment segments[2] = {
        {.a = {-20, 0, 0}, .b = {0, 0, 0}, .radius_mm = 2.385, .segment = 0},
        {.a = {0, 0, 0}, .b = {20, 0, 0}, .radius_mm = 0.731, .segment = 1}};
    uint32_t numbers[] = {7, 3};
    const Geometry geometry = {.segments = segments, .n_segments = 2, .ids = numbers, .n_ids = 2};
    const Camera camera = {
        .direction = {0, 0, -1}, .right = {3, 0, 0}, .up = {0, 1, 0}, .width = 3, .height = 1};
    const float square[] = {0, 0, 1, 0, 0, 1, 0, 0, 1}, askew[] = {0, 0, 1, 0, 0.8f, 0.6f, 0, 0, 1};
    const float depth[] = {41.5f, 41.5f, INFINITY};
    const uint32_t ids[] = {7, 3, 0};
    const SurfacePlanes seen = {depth, square, ids}, exact = {depth, askew, ids};
    float allowed[3];
    assert_int_equal(surface_tolerance(&geometry, &camera, ERF_EXACT, &seen, &exact, allowed, NULL),
                     STATUS_OK);
    double rounding = 41.5 * 1.19209290e-7;
    double thick = cell_accuracy(2.385) + cell_displacement(2.385, ERF_EXACT) + rounding;
    double thin = cell_accuracy(0.731) + cell_displacement(0.731, ERF_EXACT) / 0.6 + rounding;
    assert_true(fabs((double)allowed[0] - thick) < 1e-8);
    assert_true(fabs((double)allowed[1] - thin) < 1e-8);
    assert_true(allowed[2] == 0);

    const float grazing[] = {0, 0, 1, 0, 0.999f, 0.0447f, 0, 0, 1};
    const SurfacePlanes past = {depth, grazing, ids};
    assert_int_equal(surface_tolerance(&geometry, &camera, ERF_EXACT, &past, &seen, allowed, NULL),
                     STATUS_OK);
    assert_true(isinf(allowed[1]) && isfinite(allowed[0]));
}

static void the_index_sums_the_terms_of_all_segments(void **state)
{
    (void)state;
    enum { N = 40 };
    Random random;
    random_seed(&random, 97);
    FieldSegment segments[N];
    for (int i = 0; i < N; i++)
        segments[i] = random_segment(&random);
    const Geometry geometry = {.segments = segments, .n_segments = N};
    FieldIndex *index;
    assert_int_equal(fieldindex_build(&geometry, &index, NULL), STATUS_OK);
    for (int i = 0; i < 500; i++) {
        Vec3 x = random_place_near(&segments[i % N], &random, 2.7);
        double sum = 0;
        for (int k = 0; k < N; k++)
            sum += potential_term(&segments[k], x);
        assert_true(fabs(fieldindex_potential(index, x) - sum) <= N * RAY_TERM_CUTOFF);
    }
    fieldindex_free(index);
}

enum { GROUPED = 12, GROUPS = 20 };

/* The groups as sets of bits, made into lists. */
static void make_groups(const uint32_t *sets, Geometry *geometry)
{
    static uint32_t first[GROUPS + 1], members[GROUPS * GROUPED];
    static uint32_t first_of_segment[GROUPED + 1], groups[GROUPS * GROUPED];
    for (uint32_t group = 0; group < GROUPS; group++) {
        first[group + 1] = first[group];
        for (uint32_t i = 0; i < GROUPED; i++)
            if (sets[group] >> i & 1)
                members[first[group + 1]++] = i;
    }
    for (uint32_t i = 0; i < GROUPED; i++) {
        first_of_segment[i + 1] = first_of_segment[i];
        for (uint32_t group = 0; group < GROUPS; group++)
            if (sets[group] >> i & 1)
                groups[first_of_segment[i + 1]++] = group;
    }
    geometry->n_segments = GROUPED;
    geometry->blend = (Blend){
        GROUPS, {.first = first, .items = members}, {.first = first_of_segment, .items = groups}};
}

/* Whether the set, which is not empty, is part of no other, and the first of its equals. */
static bool is_kept(const uint32_t *sets, int self)
{
    for (int i = 0; i < GROUPS; i++)
        if ((sets[i] & sets[self]) == sets[self] && (sets[i] != sets[self] || i < self))
            return false;
    return sets[self] != 0;
}

/* Which of the groups it is that stands for equal ones does not matter. */
static void a_list_has_the_groups_that_no_other_holds_there(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 46);
    for (int run = 0; run < 200; run++) {
        uint32_t sets[GROUPS], local[GROUPS], list[GROUPED], listed = 0;
        size_t n = 0, kept = 0;
        Geometry geometry = {0};
        LocalGroups *groups;
        for (int i = 0; i < GROUPS; i++)
            sets[i] = (uint32_t)(random_bits(&random) & random_bits(&random)) % (1U << GROUPED);
        make_groups(sets, &geometry);
        assert_int_equal(localgroups_new(&geometry, &groups, NULL), STATUS_OK);
        for (uint32_t turn = 0; turn < 5; turn++) { /* the workspace is used again */
            n = kept = listed = 0;
            for (uint32_t i = 0; i < GROUPED; i++)
                if (random_bits(&random) % 2)
                    listed |= 1U << (list[n++] = i * 5 % GROUPED);
            for (int i = 0; i < GROUPS; i++)
                local[i] = sets[i] & listed;
            for (int i = 0; i < GROUPS; i++)
                kept += is_kept(local, i);
            assert_int_equal(localgroups_find(groups, list, n), kept);
            for (size_t group = 0; group < kept; group++) {
                size_t count;
                uint32_t set = 0, matches = 0;
                const uint32_t *places = localgroups_members(groups, group, &count);
                for (size_t i = 0; i < count; i++) {
                    assert_true(i == 0 || places[i] > places[i - 1]);
                    set |= 1U << list[places[i]];
                }
                for (int i = 0; i < GROUPS; i++)
                    matches += local[i] == set && is_kept(local, i);
                assert_int_equal(matches, 1);
            }
        }
        localgroups_free(groups);
    }
}

/* What termmean_at is by definition, of all segments or of those with from <= index < to. */
static double mean_of(const Geometry *geometry, const double *numbers, size_t from, size_t to,
                      Vec3 x)
{
    bool blob = geometry->model == SCENE_BLOB;
    double all = 0, known = 0, sum = 0;
    for (size_t i = from; i < to; i++) {
        const FieldSegment *segment = &geometry->segments[i];
        double term = blob ? fmax(blob_segment_value(segment, x), 0) : potential_term(segment, x);
        double number = numbers[segment->segment];
        all += term;
        known += isnan(number) ? 0 : term;
        sum += isnan(number) ? 0 : term * number;
    }
    return known > 0 && 2 * known >= all ? sum / known : (double)NAN;
}

static void the_mean_is_weighted_by_the_terms_of_all_that_have_a_number(void **state)
{
    (void)state;
    enum { N = 60, POINTS = 400 };
    Random random;
    random_seed(&random, 2385);
    FieldSegment segments[N];
    double numbers[N];
    size_t felt = 0, none = 0;
    for (uint32_t i = 0; i < N; i++) {
        segments[i] = random_segment(&random);
        segments[i].segment = N - 1 - i;
        numbers[N - 1 - i] = i % 3 == 1 ? (double)NAN : uniform(&random, -2, 5);
    }
    for (int model = 0; model < 2; model++) {
        const Geometry geometry = {
            .model = model ? SCENE_BLOB : SCENE_ISOSURFACE, .segments = segments, .n_segments = N};
        TermMean *mean;
        assert_int_equal(termmean_new(&geometry, &mean, NULL), STATUS_OK);
        for (int k = 0; k < POINTS; k++) {
            Vec3 x = random_place_near(&segments[k % N], &random, 1.1);
            double is = termmean_at(mean, numbers, x),
                   should = mean_of(&geometry, numbers, 0, N, x);
            assert_true(isnan(is) == isnan(should));
            assert_true(isnan(is) || fabs(is - should) < 1e-6);
            felt += !isnan(is);
            none += isnan(is);
        }
        termmean_free(mean);
    }
    assert_true(felt > POINTS && none > POINTS / 4);
}

/* Two groups that cross: at the wall of one, the other does not count. */
static void the_mean_of_groups_is_that_of_the_largest(void **state)
{
    (void)state;
    FieldSegment segments[] = {{{-9, 0, 0}, {0, 0, 0}, 1.3, 0},
                               {{0, 0, 0}, {9, 2, 0}, 1.1, 1},
                               {{1, -7, 1.8}, {-1, 8, 1.7}, 0.9, 2}};
    const Geometry geometry = {
        .model = SCENE_ISOSURFACE,
        .segments = segments,
        .n_segments = 3,
        .blend = {2,
                  {.first = (uint32_t[]){0, 2, 3}, .items = (uint32_t[]){0, 1, 2}},
                  {.first = (uint32_t[]){0, 1, 2, 3}, .items = (uint32_t[]){0, 0, 1}}}};
    const double numbers[] = {0.25, 2.385, 7};
    TermMean *mean;
    assert_int_equal(termmean_new(&geometry, &mean, NULL), STATUS_OK);
    const Vec3 at_first = {0.3, 0.2, -1.2}, at_second = {0.1, 0.4, 2.6};
    assert_true(fabs(termmean_at(mean, numbers, at_first) -
                     mean_of(&geometry, numbers, 0, 2, at_first)) < 1e-12);
    assert_true(fabs(termmean_at(mean, numbers, at_second) - 7) < 1e-12);
    termmean_free(mean);
}

/* A cell leaves out small terms, and has erf as a polynomial. */
static void the_mean_of_a_cell_is_nearly_that_of_all_terms(void **state)
{
    (void)state;
    FieldSegment segments[] = {{{-9, 0, 0}, {0, 0, 0}, 1.3, 0},
                               {{0, 0, 0}, {9, 2, 0}, 1.1, 1},
                               {{0, 0, 0}, {6, -8, 1.7}, 0.9, 2}};
    const Geometry geometry = {.model = SCENE_ISOSURFACE, .segments = segments, .n_segments = 3};
    const double numbers[] = {0.25, 1, 0};
    const CellParams params = {.beta = 0.5, .erf = ERF_FAST};
    CellTree cells = {0};
    TermMean *mean;
    int compared = 0;
    assert_int_equal(termmean_new(&geometry, &mean, NULL), STATUS_OK);
    assert_int_equal(celltree_build(&geometry, &params, &cells, NULL), STATUS_OK);
    for (size_t i = 0; i < cells.n_cells; i++) {
        const Cell *cell = &cells.cells[i];
        Vec3 x = vec3_scale(vec3_add(cell->low, cell->high), 0.5);
        if (fabs(cell_function(&cells, cell, x)) > 0.5 * cell->scale)
            continue;
        compared++;
        assert_true(fabs(cell_mean(&cells, cell, segments, numbers, x) -
                         termmean_at(mean, numbers, x)) < 2e-3);
    }
    assert_true(compared > 20);
    celltree_release(&cells);
    termmean_free(mean);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_level_is_the_potential_at_the_radius_of_a_long_vessel),
        cmocka_unit_test(term_and_gradient_follow_the_definition),
        cmocka_unit_test(gradient_is_the_slope_of_the_term),
        cmocka_unit_test(term_keeps_its_digits_far_beyond_an_end),
        cmocka_unit_test(bound_holds_all_over_the_box_and_uses_the_true_distance),
        cmocka_unit_test(the_wall_of_a_long_vessel_is_as_steep_as_four_levels_a_radius),
        cmocka_unit_test(log_form_is_the_distance_from_a_lone_vessel),
        cmocka_unit_test(the_tolerance_grows_as_the_surface_turns_from_the_ray),
        cmocka_unit_test(the_index_sums_the_terms_of_all_segments),
        cmocka_unit_test(the_mean_is_weighted_by_the_terms_of_all_that_have_a_number),
        cmocka_unit_test(the_mean_of_groups_is_that_of_the_largest),
        cmocka_unit_test(the_mean_of_a_cell_is_nearly_that_of_all_terms),
        cmocka_unit_test(a_list_has_the_groups_that_no_other_holds_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
