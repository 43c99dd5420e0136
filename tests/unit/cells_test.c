/* Slow: compares every cell of the octree with brute force. */
#include "field/field.h"
#include "unit.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "field_scenes.h"
#include <stdio.h>

static CellTree cells_of(const TestScene *test, double beta, ErfForm erf)
{
    CellTree cells;
    assert_int_equal(
        celltree_build(&test->geometry, &(CellParams){.beta = beta, .erf = erf}, &cells, NULL),
        STATUS_OK);
    return cells;
}

/* ---- the form of a term ---------------------------------------------------------------------- */

static double odd_polynomial(ErfForm form, double u)
{
    double sum = 0;
    for (int i = ERF_TERMS; i-- > 0;)
        sum = sum * u * u + erf_forms[form][i];
    return sum * u / -2;
}

static void erf_is_as_exact_as_it_says(void **state)
{
    (void)state;
    for (int form = ERF_FAST; form <= ERF_EXACT; form++) {
        double worst = 0, before = 0;
        for (double u = 0; u < 30; u += 1e-4 * SHARE) {
            double value = tanh(odd_polynomial((ErfForm)form, u));
            worst = fmax(worst, fabs(value - erf(u)));
            assert_true(value >= before); /* it does not turn back */
            before = value;
        }
        assert_true(worst <= erf_form_error((ErfForm)form));
        assert_true(worst > 0.9 * erf_form_error((ErfForm)form));
        printf("  erf, %s: largest error %.3g\n", form ? "exact" : "fast", worst);
    }
}

/* (1 + erf u) / 2 of a form, and its slope. */
static double step(ErfForm form, double u, double *slope)
{
    double exponent = -2 * odd_polynomial(form, u), derivative = 0;
    for (int i = ERF_TERMS; i-- > 0;)
        derivative = derivative * u * u + (2 * i + 1) * erf_forms[form][i];
    double value = 1 / (1 + exp(exponent));
    *slope = -derivative * value / (1 + exp(-exponent));
    return value;
}

/* The largest s |A'| / (A sqrt(-2 ln A)) of an axial factor A >= least, over positions and
 * lengths. */
static double axial_steepness(ErfForm form, double least)
{
    double worst = 0, slope, other_slope;
    for (double length = 0.02; length < 40; length *= 1.07)
        for (double t = length / 2; t < length + 7; t += 4e-3 * SHARE) {
            double value = step(form, t, &slope) + step(form, length - t, &other_slope) - 1;
            if (value >= least && value < 1 - 1e-9)
                worst = fmax(worst,
                             fabs(slope - other_slope) / sqrt(2) / value / sqrt(-2 * log(value)));
        }
    return worst;
}

static void the_tail_of_erf_is_no_steeper_than_cells_allow_for(void **state)
{
    (void)state;
    assert_true(axial_steepness(ERF_FAST, 1e-3) <= 1);
    assert_true(axial_steepness(ERF_EXACT, 1e-3) <= 1);
    assert_true(axial_steepness(ERF_FAST, LOG_FORM_FLOOR / 10) <= 1.14);
    assert_true(axial_steepness(ERF_EXACT, LOG_FORM_FLOOR / 10) <= 1.21);
}

static void a_term_in_its_form_is_the_term(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 51);
    for (int i = 0; i < 20000 / SHARE; i++) {
        double radius = pow(10, uniform(&random, -1.4, 0.6));
        Vec3 a = random_point(&random, 70);
        if (i % 3 == 0)
            a.z = 0;
        Vec3 axis = i % 3 ? random_direction(&random) : vec3(0.6, -0.8, 0);
        double length = radius * pow(10, uniform(&random, -1, 1.7));
        FieldSegment segment = {.a = a, .b = vec3_add_scaled(a, axis, length), .radius_mm = radius};
        TermForm form = term_form(&segment);
        Vec3 at = vec3_add_scaled(a, axis, length * uniform(&random, -0.2, 1.2));
        Vec3 x =
            vec3_add_scaled(at, random_direction(&random), 2 * radius * random_uniform(&random));
        double exact = (double)exact_term(&segment, long_vec3(x), NULL);
        for (int erf_form = ERF_FAST; erf_form <= ERF_EXACT; erf_form++) {
            double error = erf_form_error((ErfForm)erf_form);
            assert_true(fabs(term_form_value(&form, TERM_BOTH_ENDS, (ErfForm)erf_form, x) -
                             exact) <= error + 1e-9);
        }
        double c = sqrt(2) / radius, from_a = c * vec3_dot(vec3_sub(x, a), axis);
        double from_b = c * length - from_a;
        TermPart part = from_a < END_REACH   ? (from_b < END_REACH ? TERM_BOTH_ENDS : TERM_START)
                        : from_b < END_REACH ? TERM_END
                                             : TERM_MIDDLE;
        assert_true(fabs(term_form_value(&form, part, ERF_EXACT, x) - exact) <=
                    erf_form_error(ERF_EXACT) + 1e-9);
    }
}

/* ---- cells ----------------------------------------------------------------------------------- */

static double potential(const TestScene *test, Vec3 x)
{
    const Blend *blend = &test->geometry.blend;
    const IndexLists *members = &blend->members;
    double sum = 0, largest = 0;
    for (size_t i = 0; i < test->geometry.n_segments; i++)
        sum += potential_term(&test->segments[i], x);
    for (size_t group = 0; group < blend->n_groups; group++) {
        sum = 0;
        for (uint32_t i = members->first[group]; i < members->first[group + 1]; i++)
            sum += potential_term(&test->segments[members->items[i]], x);
        largest = fmax(largest, sum);
    }
    return blend->n_groups ? largest : sum;
}

/* A chain whose segments blend where they meet, and a stranger that runs through its middle. */
static void make_graph_scene(Random *random, TestScene *test)
{
    uint32_t nodes[MAX_SEGMENTS][2];
    make_test_scene(KIND_CHAIN, random, test);
    const FieldSegment *middle = &test->segments[7];
    Vec3 beside = vec3_scale(random_normal_to(random, vec3_sub(middle->b, middle->a)), 0.4);
    put_segment(test, vec3_add(middle->a, beside), vec3_add(middle->b, beside), 0.31);
    uint32_t n = (uint32_t)test->geometry.n_segments;
    for (uint32_t i = 0; i < n; i++) {
        nodes[i][0] = i + 1 == n ? n : i;
        nodes[i][1] = i + 1;
    }
    nodes[n - 1][0] = n;
    nodes[n - 1][1] = n + 1;
    const VesselTree tree = {
        .segments = test->segments, .nodes = nodes, .n_segments = n, .n_nodes = n + 2};
    assert_int_equal(vesseltree_blend(&tree, &test->geometry.blend, NULL), STATUS_OK);
    assert_true(test->geometry.blend.n_groups > 3);
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

static bool holds(const Cell *cell, Vec3 x)
{
    return x.x >= cell->low.x && x.x <= cell->high.x && x.y >= cell->low.y && x.y <= cell->high.y &&
           x.z >= cell->low.z && x.z <= cell->high.z;
}

static const double betas[] = {1.9, 4, 6.5};

/* Finds places of the surface and holds the cells there to it. */
static void hold_cells_to_surface(const TestScene *test, double beta, ErfForm erf, Random *random,
                                  double *worst)
{
    CellTree cells = cells_of(test, beta, erf);
    int found = 0;
    for (int i = 0; i < 1500 / SHARE; i++) {
        const FieldSegment *segment =
            &test->segments[random_bits(random) % test->geometry.n_segments];
        Vec3 x, from = vec3_add_scaled(segment->a, vec3_sub(segment->b, segment->a),
                                       random_uniform(random));
        if (!find_surface(test, from, random_direction(random), 0.1 * segment->radius_mm, &x))
            continue;
        int cells_there = 0;
        for (size_t k = 0; k < cells.n_cells; k++) {
            const Cell *cell = &cells.cells[k];
            if (!holds(cell, x))
                continue;
            cells_there++;
            uint32_t largest = cell_largest_term(&cells, cell, x);
            assert_true(cell->largest == CELL_MIXED || cell->largest == largest);
            double allowed =
                cell->max_gradient * cell_displacement(test->segments[largest].radius_mm, erf);
            double off = fabs(cell_function(&cells, cell, x)) / allowed;
            *worst = fmax(*worst, off);
            assert_true(off <= 1);
        }
        assert_true(cells_there > 0);
        found++;
    }
    assert_true(found > 50 / SHARE);
    celltree_release(&cells);
}

static void the_surface_lies_in_cells_whose_functions_are_zero_there(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 44);
    double worst[] = {0, 0};
    for (int run = 0; run < 2 * N_TAME_KINDS; run++) {
        TestScene test;
        make_test_scene((SceneKind)(run % N_TAME_KINDS), &random, &test);
        ErfForm erf = (ErfForm)(run / N_TAME_KINDS);
        hold_cells_to_surface(&test, betas[run % 3], erf, &random, &worst[erf]);
    }
    printf("  displacement over its bound: fast %.3f, exact %.3f\n", worst[0], worst[1]);
}

static void the_surface_of_the_graph_lies_in_cells_too(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 45);
    double worst = 0;
    for (int run = 0; run < 4; run++) {
        TestScene test;
        make_graph_scene(&random, &test);
        hold_cells_to_surface(&test, betas[run % 3], (ErfForm)(run % 2), &random, &worst);
        indexlists_release(&test.geometry.blend.members);
        indexlists_release(&test.geometry.blend.groups);
    }
    printf("  displacement over its bound: %.3f\n", worst);
}

static Vec3 random_place_in(const Cell *cell, Random *random)
{
    return vec3(uniform(random, cell->low.x, cell->high.x),
                uniform(random, cell->low.y, cell->high.y),
                uniform(random, cell->low.z, cell->high.z));
}

/* |grad| of the cell's function over its bound. */
static double steepness(const CellTree *cells, const Cell *cell, Vec3 x)
{
    double h = 1e-4 * cell->accuracy;
    Vec3 rise = {cell_function(cells, cell, vec3(x.x + h, x.y, x.z)) -
                     cell_function(cells, cell, vec3(x.x - h, x.y, x.z)),
                 cell_function(cells, cell, vec3(x.x, x.y + h, x.z)) -
                     cell_function(cells, cell, vec3(x.x, x.y - h, x.z)),
                 cell_function(cells, cell, vec3(x.x, x.y, x.z + h)) -
                     cell_function(cells, cell, vec3(x.x, x.y, x.z - h))};
    return vec3_length(rise) / (2 * h) / cell->max_gradient;
}

static void gradient_in_a_cell_never_exceeds_its_bound(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 45);
    double worst = 0;
    for (int run = 0; run < 2 * N_TAME_KINDS; run++) {
        TestScene test;
        make_test_scene((SceneKind)(run % N_TAME_KINDS), &random, &test);
        CellTree cells = cells_of(&test, betas[run % 3], (ErfForm)(run / N_TAME_KINDS));
        for (int i = 0; i < 60000 / SHARE; i++) {
            const Cell *cell = &cells.cells[random_bits(&random) % cells.n_cells];
            double ratio = steepness(&cells, cell, random_place_in(cell, &random));
            worst = fmax(worst, ratio);
            assert_true(ratio <= 1 + 1e-6);
        }
        celltree_release(&cells);
    }
    printf("  largest gradient over its bound: %.4f\n", worst);
}

static void coincident_segments_reach_the_bound(void **state)
{
    (void)state;
    TestScene test = {.geometry = {.segments = test.segments}};
    for (int i = 0; i < 4; i++)
        put_segment(&test, vec3(-8, 0.1, 0.2), vec3(9, 0.1, 0.2), 0.73);
    CellTree cells = cells_of(&test, 4, ERF_FAST);
    double largest = 0;
    for (size_t i = 0; i < cells.n_cells; i++)
        for (double y = 0.1; y < 1.6; y += 1e-3)
            if (holds(&cells.cells[i], vec3(0.5, y, 0.2)))
                largest = fmax(largest, steepness(&cells, &cells.cells[i], vec3(0.5, y, 0.2)));
    assert_true(largest <= 1 + 1e-6);
    assert_true(largest > 0.98);
    celltree_release(&cells);
}

static void a_long_vessel_is_made_of_tubes(void **state)
{
    (void)state;
    TestScene test = {.geometry = {.segments = test.segments}};
    put_segment(&test, vec3(-38.5, 0.11, 0.23), vec3(49, 0.42, -0.71), 0.73);
    CellTree cells = cells_of(&test, 3, ERF_FAST);
    size_t tubes = 0;
    for (size_t i = 0; i < cells.n_cells; i++) {
        const Cell *cell = &cells.cells[i];
        if (!cell_is_tube(&cells, cell))
            continue;
        tubes++;
        assert_true(cell->max_gradient * 0.73 / 2 / cell->scale < 1.001);
        Vec3 x = box_center((Box){cell->low, cell->high});
        Vec3 from_a = vec3_sub(x, test.segments[0].a);
        Vec3 axis = vec3_normalized(vec3_sub(test.segments[0].b, test.segments[0].a));
        double distance = vec3_length(vec3_cross(from_a, axis));
        assert_true(fabs(cell_function(&cells, cell, x) / cell->scale * 0.365 - (distance - 0.73)) <
                    1e-9);
    }
    assert_true((double)tubes > 0.9 * (double)cells.n_cells);
    celltree_release(&cells);
}

static void cells_come_in_order_with_what_they_promise(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 46);
    TestScene test;
    make_test_scene(KIND_TREE, &random, &test);
    CellTree cells = cells_of(&test, 4, ERF_FAST), again = cells_of(&test, 4, ERF_FAST);
    assert_int_equal(cells.n_terms, again.n_terms);
    assert_memory_equal(cells.terms, again.terms, cells.n_terms * sizeof *cells.terms);
    size_t next = 0;
    for (size_t i = 0; i < cells.n_cells; i++) {
        const Cell *cell = &cells.cells[i];
        assert_int_equal(cell->first, next);
        next += cell->count;
        double smallest = HUGE_VAL, largest = 0;
        for (uint32_t k = 0; k < cell->count; k++) {
            uint32_t segment = cells.terms[cell->first + k].segment;
            assert_true(k == 0 || segment > cells.terms[cell->first + k - 1].segment);
            smallest = fmin(smallest, test.segments[segment].radius_mm);
            largest = fmax(largest, test.segments[segment].radius_mm);
        }
        int exponent;
        assert_true(frexp(cell->scale, &exponent) == 0.5);
        assert_true(cell->scale <= smallest / 8 && cell->scale > smallest / 16);
        assert_true(cell->accuracy <= cell_accuracy(largest));
        assert_true(cell->high.x - cell->low.x <= 4 * 300 * cell->accuracy * 1.1);
    }
    assert_int_equal(next, cells.n_terms);
    celltree_release(&cells);
    celltree_release(&again);
}

static void accuracy_follows_the_radius_but_for_shadows(void **state)
{
    (void)state;
    assert_true(fabs(cell_accuracy(2.385) - 0.00795) < 1e-9);
    assert_true(cell_accuracy(0.1) >= 1e-3);
    assert_true(cell_accuracy(0.006) <= 1e-4);
    for (double radius = 1e-4; radius < 10; radius *= 1.013)
        assert_true(cell_accuracy(radius * 1.013) >= cell_accuracy(radius));
}

/* How far a cell reaches below the part of its cube with which it begins, whose corners are at
 * multiples of `side`, over its accuracy. */
static double reach_of(const Cell *cell, double side)
{
    double reach = ceil(cell->low.x / side) * side - cell->low.x;
    return reach / cell->accuracy;
}

static void
cells_reach_a_little_more_than_five_accuracies_beyond_the_parts_of_their_cubes(void **state)
{
    (void)state;
    TestScene test = {.geometry = {.segments = test.segments}};
    put_segment(&test, vec3(-7.5, 0.11, 0.23), vec3(9, 2.42, -1.71), 0.73);
    CellTree cells = cells_of(&test, 3, ERF_FAST);
    double least = HUGE_VAL, most = 0;
    for (size_t i = 0; i < cells.n_cells; i++) {
        double reach = reach_of(&cells.cells[i], 0.5 * 0.73);
        least = fmin(least, reach);
        most = fmax(most, reach);
    }
    assert_true(least >= 5 && most < 5.05 && most > least);
    celltree_release(&cells);
}

static bool is_single(double x)
{
    return (double)(float)x == x;
}

/* POV-Ray keeps corner and size of boxes, and of boxes about several boxes, in single precision. */
static void single_precision_holds_boxes_and_boxes_about_them(void **state)
{
    (void)state;
    TestScene test = {.geometry = {.segments = test.segments}};
    put_segment(&test, vec3(-48.5, 0.11, 0.23), vec3(-48.3, 0.12, -0.71), 0.0033);
    put_segment(&test, vec3(49.2, -51.3, 0.23), vec3(49, -50.4, -0.71), 0.0173);
    CellTree cells = cells_of(&test, 3, ERF_FAST);
    for (size_t i = 0; i < cells.n_cells; i++) {
        Vec3 low = cells.cells[i].low, high = cells.cells[i].high;
        Vec3 size = vec3_sub(high, low), most = vec3_sub(high, cells.cells[0].low);
        assert_true(is_single(low.x) && is_single(low.y) && is_single(low.z));
        assert_true(is_single(high.x) && is_single(high.y) && is_single(high.z));
        assert_true(is_single(size.x) && is_single(size.y) && is_single(size.z));
        assert_true(is_single(most.x) && is_single(most.y) && is_single(most.z));
    }
    celltree_release(&cells);
}

/* Else POV-Ray may find the wall at the same place in both, and which one is seen would depend on
 * the order in which it looks at them. */
static void no_boxes_that_overlap_begin_and_end_in_the_same_planes(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 47);
    for (int kind = 0; kind < N_TAME_KINDS; kind++) {
        TestScene test;
        make_test_scene((SceneKind)kind, &random, &test);
        CellTree cells = cells_of(&test, 6, ERF_FAST);
        size_t pairs = 0;
        for (size_t i = 0; i < cells.n_cells; i++)
            for (size_t k = i + 1; k < cells.n_cells; k++) {
                const Cell *a = &cells.cells[i], *b = &cells.cells[k];
                bool apart = a->low.x > b->high.x || b->low.x > a->high.x || a->low.y > b->high.y ||
                             b->low.y > a->high.y || a->low.z > b->high.z || b->low.z > a->high.z;
                pairs += !apart;
                assert_true(apart || ((a->low.x != b->low.x || a->high.x != b->high.x) &&
                                      (a->low.y != b->low.y || a->high.y != b->high.y) &&
                                      (a->low.z != b->low.z || a->high.z != b->high.z)));
            }
        assert_true(pairs > 10);
        celltree_release(&cells);
    }
}

static void cells_are_not_split_without_a_given_beta_while_radii_are_alike(void **state)
{
    (void)state;
    TestScene test = {.geometry = {.segments = test.segments}};
    put_segment(&test, vec3(-7, 0, 0), vec3(7, 0, 0), 0.73);
    CellTree cells = cells_of(&test, 0, ERF_FAST);
    double widest = 0;
    for (size_t i = 0; i < cells.n_cells; i++)
        widest = fmax(widest, cells.cells[i].high.x - cells.cells[i].low.x);
    assert_true(fabs(widest / 0.73 - 4) < 0.1);
    celltree_release(&cells);
}

/* About a vessel of radius 0.73 in cubes of 2.92 mm, whose quarters end 0.73 mm from its axis. */
static void boxes_end_where_the_surface_does(void **state)
{
    (void)state;
    TestScene test = {.geometry = {.segments = test.segments}};
    put_segment(&test, vec3(-7, 0.002, -0.001), vec3(7, 0.002, -0.001), 0.73);
    CellTree cells = cells_of(&test, 4, ERF_FAST);
    assert_true(cells.n_cells > 12);
    for (size_t i = 0; i < cells.n_cells; i++) {
        const Cell *cell = &cells.cells[i];
        double most = 2 * 0.73 + 7 * cell->accuracy;
        assert_true(cell->high.y < most && cell->low.y > -most);
        assert_true(cell->high.z < most && cell->low.z > -most);
    }
    celltree_release(&cells);
}

static void nothing_has_no_cells(void **state)
{
    (void)state;
    TestScene test = {.geometry = {.model = SCENE_ISOSURFACE}};
    CellTree cells = cells_of(&test, 4, ERF_FAST);
    assert_int_equal(cells.n_cells, 0);
    celltree_release(&cells);
}

static void refuses_a_scene_of_countless_cells(void **state)
{
    (void)state;
    if (SHARE > 1)
        return; /* a million cells take a sanitizer nine seconds */
    TestScene test = {.geometry = {.segments = test.segments}};
    put_segment(&test, vec3(-48.5, 3, 0), vec3(51.25, 7, 2), 1e-7);
    CellTree cells = {0};
    Err err;
    assert_int_equal(celltree_build(&test.geometry, &(CellParams){.beta = 4}, &cells, &err),
                     STATUS_INFEASIBLE);
    assert_non_null(strstr(err.text, "1000000 cells"));
    assert_null(cells.cells);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(erf_is_as_exact_as_it_says),
        cmocka_unit_test(the_tail_of_erf_is_no_steeper_than_cells_allow_for),
        cmocka_unit_test(a_term_in_its_form_is_the_term),
        cmocka_unit_test(the_surface_lies_in_cells_whose_functions_are_zero_there),
        cmocka_unit_test(the_surface_of_the_graph_lies_in_cells_too),
        cmocka_unit_test(gradient_in_a_cell_never_exceeds_its_bound),
        cmocka_unit_test(coincident_segments_reach_the_bound),
        cmocka_unit_test(a_long_vessel_is_made_of_tubes),
        cmocka_unit_test(cells_come_in_order_with_what_they_promise),
        cmocka_unit_test(accuracy_follows_the_radius_but_for_shadows),
        cmocka_unit_test(
            cells_reach_a_little_more_than_five_accuracies_beyond_the_parts_of_their_cubes),
        cmocka_unit_test(single_precision_holds_boxes_and_boxes_about_them),
        cmocka_unit_test(no_boxes_that_overlap_begin_and_end_in_the_same_planes),
        cmocka_unit_test(cells_are_not_split_without_a_given_beta_while_radii_are_alike),
        cmocka_unit_test(boxes_end_where_the_surface_does),
        cmocka_unit_test(nothing_has_no_cells),
        cmocka_unit_test(refuses_a_scene_of_countless_cells),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
