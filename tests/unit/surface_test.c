#include "surface/surface.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "field_scenes.h"
#include <cmocka.h>
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

static void log_form_is_the_distance_from_a_lone_vessel(void **state)
{
    (void)state;
    double s = 0.3425;
    FieldSegment segment = {.a = {-20, 0, 0}, .b = {20, 0, 0}, .radius_mm = 2 * s};
    for (double d = 0.63; d < 1.79; d += 0.081)
        assert_true(fabs(potential_log_form(potential_term(&segment, vec3(0.5, d, 0))) -
                         (d - 2 * s) / s) < 1e-12);
    assert_true(fabs(potential_log_form(FIELD_LEVEL)) < 1e-15);
    assert_true(potential_log_form(0) == potential_log_form(LOG_FORM_FLOOR));
    assert_true(potential_log_form(1.7) == potential_log_form(LOG_FORM_CEILING));
}

static double potential(const TestScene *test, Vec3 x)
{
    double sum = 0;
    for (size_t i = 0; i < test->scene.n_segments; i++)
        sum += potential_term(&test->segments[i], x);
    return sum;
}

/* A point of the surface on the line from x, or false. */
static bool find_surface(const TestScene *test, Vec3 x, Vec3 direction, double step, Vec3 *found)
{
    Vec3 low = x;
    if (potential(test, low) < FIELD_LEVEL)
        return false;
    for (int i = 0; i < 4000; i++) {
        Vec3 high = vec3_add_scaled(low, direction, step);
        if (potential(test, high) < FIELD_LEVEL) {
            for (int k = 0; k < 50; k++) {
                Vec3 middle = vec3_scale(vec3_add(low, high), 0.5);
                *(potential(test, middle) < FIELD_LEVEL ? &high : &low) = middle;
            }
            *found = high;
            return true;
        }
        low = high;
    }
    return false;
}

static const Cell *cell_at(const CellTree *cells, Vec3 x)
{
    for (size_t i = 0; i < cells->n_cells; i++) {
        const Cell *cell = &cells->cells[i];
        if (x.x >= cell->low.x && x.x <= cell->low.x + cell->side && x.y >= cell->low.y &&
            x.y <= cell->low.y + cell->side && x.z >= cell->low.z &&
            x.z <= cell->low.z + cell->side)
            return cell;
    }
    return NULL;
}

static double cell_potential(const TestScene *test, const CellTree *cells, const Cell *cell, Vec3 x)
{
    double sum = 0;
    for (uint32_t i = 0; i < cell->count; i++)
        sum += potential_term(&test->segments[cells->terms[cell->first + i]], x);
    return sum;
}

static const double betas[] = {1.9, 4, 6.5};

static void every_point_of_the_surface_lies_in_a_cell_that_has_its_terms(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 44);
    for (int run = 0; run < 2 * N_TAME_KINDS; run++) {
        TestScene test;
        make_test_scene((SceneKind)(run % N_TAME_KINDS), &random, &test);
        double cutoff = TERM_CUTOFF * (double)test.scene.n_segments;
        CellTree cells;
        assert_int_equal(celltree_build(&test.scene, betas[run % 3], &cells, NULL), STATUS_OK);
        int found = 0;
        for (int i = 0; i < 1500; i++) {
            const FieldSegment *segment =
                &test.segments[random_bits(&random) % test.scene.n_segments];
            Vec3 x;
            if (!find_surface(&test, random_place_near(segment, &random, 0.5),
                              random_direction(&random), 0.1 * segment->radius_mm, &x))
                continue;
            found++;
            const Cell *cell = cell_at(&cells, x);
            assert_non_null(cell);
            assert_true(fabs(cell_potential(&test, &cells, cell, x) - FIELD_LEVEL) <= cutoff);
        }
        assert_true(found > 50);
        celltree_release(&cells);
    }
}

/* |grad| of scale * log form at x, with erf, or with its approximation by tanh; 0 where clamped. */
static double form_gradient(const TestScene *test, const CellTree *cells, const Cell *cell, Vec3 x)
{
    double phi = 0;
    Vec3 sum = vec3(0, 0, 0);
    for (uint32_t i = 0; i < cell->count; i++) {
        Vec3 gradient;
        phi +=
            potential_term_gradient(&test->segments[cells->terms[cell->first + i]], x, &gradient);
        sum = vec3_add(sum, gradient);
    }
    if (phi <= LOG_FORM_FLOOR || phi >= LOG_FORM_CEILING)
        return 0;
    return cell->scale * vec3_length(sum) / (phi * sqrt(-2 * log(phi)));
}

static double tanh_erf(double x)
{
    return tanh(x * (x * x * 0.09980966638 + 1.129663422));
}

static double tanh_form(const TestScene *test, const CellTree *cells, const Cell *cell, Vec3 x)
{
    double phi = 0;
    for (uint32_t i = 0; i < cell->count; i++) {
        const FieldSegment *segment = &test->segments[cells->terms[cell->first + i]];
        double k = sqrt(2) / segment->radius_mm;
        Vec3 axis = vec3_normalized(vec3_sub(segment->b, segment->a));
        Vec3 from_a = vec3_sub(x, segment->a);
        double t = vec3_dot(from_a, axis), length = vec3_distance(segment->a, segment->b);
        Vec3 across = vec3_add_scaled(from_a, axis, -t);
        phi += 0.5 * exp(-k * k * vec3_dot(across, across)) *
               (tanh_erf(k * (length - t)) + tanh_erf(k * t));
    }
    return cell->scale * potential_log_form(phi);
}

static double tanh_form_gradient(const TestScene *test, const CellTree *cells, const Cell *cell,
                                 Vec3 x)
{
    double h = 1e-4 * cell->scale;
    Vec3 slope = vec3(tanh_form(test, cells, cell, vec3(x.x + h, x.y, x.z)) -
                          tanh_form(test, cells, cell, vec3(x.x - h, x.y, x.z)),
                      tanh_form(test, cells, cell, vec3(x.x, x.y + h, x.z)) -
                          tanh_form(test, cells, cell, vec3(x.x, x.y - h, x.z)),
                      tanh_form(test, cells, cell, vec3(x.x, x.y, x.z + h)) -
                          tanh_form(test, cells, cell, vec3(x.x, x.y, x.z - h)));
    return vec3_length(slope) / (2 * h);
}

static void gradient_in_a_cell_never_exceeds_its_bound(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 45);
    double worst = 0, worst_tanh = 0;
    for (int run = 0; run < 2 * N_TAME_KINDS; run++) {
        TestScene test;
        make_test_scene((SceneKind)(run % N_TAME_KINDS), &random, &test);
        CellTree cells;
        assert_int_equal(celltree_build(&test.scene, betas[run % 3], &cells, NULL), STATUS_OK);
        for (int i = 0; i < 100000; i++) {
            const Cell *cell = &cells.cells[random_bits(&random) % cells.n_cells];
            double margin = CELL_OVERLAP * cell->accuracy, side = cell->side + margin;
            Vec3 x = vec3(cell->low.x + uniform(&random, -margin, side),
                          cell->low.y + uniform(&random, -margin, side),
                          cell->low.z + uniform(&random, -margin, side));
            double ratio = form_gradient(&test, &cells, cell, x) / cell->max_gradient;
            worst = fmax(worst, ratio);
            assert_true(ratio <= 1 + 1e-12);
            if (i % 8)
                continue;
            ratio = tanh_form_gradient(&test, &cells, cell, x) / cell->max_gradient;
            worst_tanh = fmax(worst_tanh, ratio);
            assert_true(ratio <= 1);
        }
        celltree_release(&cells);
    }
    printf("  largest gradient over its bound: %.4f, with tanh %.4f\n", worst, worst_tanh);
}

static void coincident_segments_reach_the_bound(void **state)
{
    (void)state;
    TestScene test = {.scene = {.segments = test.segments}};
    for (int i = 0; i < 4; i++)
        put_segment(&test, vec3(-8, 0.1, 0.2), vec3(9, 0.1, 0.2), 0.73);
    CellTree cells;
    assert_int_equal(celltree_build(&test.scene, 4, &cells, NULL), STATUS_OK);
    const Cell *cell = cell_at(&cells, vec3(0.5, 0.9, 0.2));
    assert_non_null(cell);
    double largest = 0;
    for (double y = 0.1; y < 1.6; y += 1e-4)
        largest = fmax(largest, form_gradient(&test, &cells, cell, vec3(0.5, y, 0.2)));
    assert_true(largest <= cell->max_gradient);
    assert_true(largest > 0.999 * cell->max_gradient);
    celltree_release(&cells);
}

static void cells_are_disjoint_cubes_with_the_radii_of_their_terms(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 46);
    TestScene test;
    make_test_scene(KIND_TREE, &random, &test);
    CellTree cells, again;
    assert_int_equal(celltree_build(&test.scene, 4, &cells, NULL), STATUS_OK);
    assert_int_equal(celltree_build(&test.scene, 4, &again, NULL), STATUS_OK);
    assert_int_equal(cells.n_terms, again.n_terms);
    assert_memory_equal(cells.terms, again.terms, cells.n_terms * sizeof *cells.terms);
    size_t next = 0;
    for (size_t i = 0; i < cells.n_cells; i++) {
        const Cell *cell = &cells.cells[i];
        assert_int_equal(cell->first, next);
        next += cell->count;
        double smallest = HUGE_VAL;
        for (uint32_t k = 0; k < cell->count; k++) {
            uint32_t term = cells.terms[cell->first + k];
            assert_true(k == 0 || term > cells.terms[cell->first + k - 1]);
            smallest = fmin(smallest, test.segments[term].radius_mm);
        }
        assert_true(cell->scale == smallest / 2);
        assert_true(cell->accuracy >= smallest / 300);
        assert_true(cell->side <= 4 * 300 * cell->accuracy);
        double inset = 0.01 * cell->side;
        Vec3 corner = vec3_add(cell->low, vec3(inset, inset, inset));
        assert_ptr_equal(cell_at(&cells, corner), cell);
    }
    assert_int_equal(next, cells.n_terms);
    celltree_release(&cells);
    celltree_release(&again);
}

static void nothing_has_no_cells(void **state)
{
    (void)state;
    Scene scene = {.model = SCENE_ISOSURFACE};
    CellTree cells;
    assert_int_equal(celltree_build(&scene, 4, &cells, NULL), STATUS_OK);
    assert_int_equal(cells.n_cells, 0);
    celltree_release(&cells);
}

static void refuses_a_scene_of_countless_cells(void **state)
{
    (void)state;
    TestScene test = {.scene = {.segments = test.segments}};
    put_segment(&test, vec3(-48.5, 3, 0), vec3(51.25, 7, 2), 1e-7);
    CellTree cells = {0};
    Err err;
    assert_int_equal(celltree_build(&test.scene, 4, &cells, &err), STATUS_INFEASIBLE);
    assert_non_null(strstr(err.text, "1000000 cells"));
    assert_null(cells.cells);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(term_and_gradient_follow_the_definition),
        cmocka_unit_test(gradient_is_the_slope_of_the_term),
        cmocka_unit_test(term_keeps_its_digits_far_beyond_an_end),
        cmocka_unit_test(bound_holds_all_over_the_box_and_uses_the_true_distance),
        cmocka_unit_test(log_form_is_the_distance_from_a_lone_vessel),
        cmocka_unit_test(every_point_of_the_surface_lies_in_a_cell_that_has_its_terms),
        cmocka_unit_test(gradient_in_a_cell_never_exceeds_its_bound),
        cmocka_unit_test(coincident_segments_reach_the_bound),
        cmocka_unit_test(cells_are_disjoint_cubes_with_the_radii_of_their_terms),
        cmocka_unit_test(nothing_has_no_cells),
        cmocka_unit_test(refuses_a_scene_of_countless_cells),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
