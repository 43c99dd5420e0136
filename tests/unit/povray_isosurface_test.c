/* corcast's repetition of POV-Ray's search for isosurfaces. */
#include "render/render.h"
#include "unit.h"

#include <stdint.h>
#include <stdlib.h>

#include "field_scenes.h"
#include "test_search.h"
#include <stdio.h>

static const CellParams cells = {.beta = 3};

static TestSearch halving_of(const Geometry *geometry)
{
    return testsearch_open(&cell_search, geometry, &cells);
}

/* A ray from 200 mm away through a place near some segment. */
static Ray random_ray(const TestScene *test, Random *random)
{
    const FieldSegment *segment = &test->segments[random_bits(random) % test->geometry.n_segments];
    Vec3 at = vec3_add_scaled(segment->a, vec3_sub(segment->b, segment->a), random_uniform(random));
    at = vec3_add_scaled(at, random_direction(random), 0.8 * segment->radius_mm);
    Vec3 direction = random_direction(random);
    return (Ray){vec3_add_scaled(at, direction, -200), direction};
}

/* The same scene, to be seen as POV-Ray sees it and by proof. */
typedef struct Views {
    TestScene test;
    TestSearch halving, exact;
    size_t seen, grazing;
} Views;

static void views_init(Views *views, SceneKind kind, Random *random)
{
    make_test_scene(kind, random, &views->test);
    views->halving = halving_of(&views->test.geometry);
    views->exact = testsearch_open(&field_search, &views->test.geometry, NULL);
}

static void views_release(Views *views)
{
    testsearch_close(&views->exact);
    testsearch_close(&views->halving);
}

/* Both see the ray's first hit, and at the same place, unless it grazes. */
static void assert_seen_alike(Views *views, Ray ray)
{
    RayHit hit, expected;
    bool found = testsearch_first(&views->halving, ray, 1e-4, INFINITY, &hit);
    bool exact = testsearch_first(&views->exact, ray, 1e-4, INFINITY, &expected);
    double cosine = exact ? -vec3_dot(expected.normal, ray.direction) : 0;
    if (found) /* an error across the wall becomes one along the ray by the smaller of the cosines
                */
        cosine = fmin(cosine, fabs(vec3_dot(hit.normal, ray.direction)));
    if (cosine < 0.05) {
        views->grazing += found || exact;
        return;
    }
    assert_true(found);
    views->seen++;
    double radius = views->test.segments[hit.index].radius_mm;
    double allowed = cell_accuracy(radius) + cell_displacement(radius, ERF_FAST) / cosine;
    assert_true(fabs(hit.t - expected.t) <= allowed);
    assert_true(vec3_dot(hit.normal, expected.normal) > cos(0.2)); /* it turns fast in a crease */
}

static void what_it_sees_is_the_surface_to_its_accuracy(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 61);
    Views views = {0};
    for (int kind = 0; kind < N_TAME_KINDS; kind++) {
        views_init(&views, (SceneKind)kind, &random);
        for (int i = 0; i < 3000; i++)
            assert_seen_alike(&views, random_ray(&views.test, &random));
        views_release(&views);
    }
    printf("  %zu rays seen alike, %zu graze\n", views.seen, views.grazing);
    assert_true(views.seen > 5000 && views.grazing < views.seen / 10);
}

/* A place of the surface in a face of the cell's cube, found on a line in that face. */
static bool surface_on_face(const CellTree *tree, const Cell *cell, Random *random, Vec3 *found)
{
    double overlap = 5 * cell->accuracy;
    double low[3] = {cell->low.x, cell->low.y, cell->low.z};
    double high[3] = {cell->high.x, cell->high.y, cell->high.z};
    int axis = (int)(random_bits(random) % 3), other = (axis + 1) % 3, third = (axis + 2) % 3;
    double a[3], b[3];
    a[axis] = b[axis] = random_bits(random) & 1 ? low[axis] + overlap : high[axis] - overlap;
    a[other] = low[other];
    b[other] = high[other];
    a[third] = uniform(random, low[third], high[third]);
    b[third] = uniform(random, low[third], high[third]);
    Vec3 x = vec3(a[0], a[1], a[2]), y = vec3(b[0], b[1], b[2]);
    bool inside = cell_function(tree, cell, x) < 0;
    if ((cell_function(tree, cell, y) < 0) == inside)
        return false;
    for (int i = 0; i < 50; i++) {
        Vec3 middle = vec3_scale(vec3_add(x, y), 0.5);
        *((cell_function(tree, cell, middle) < 0) == inside ? &x : &y) = middle;
    }
    *found = x;
    return true;
}

static void no_seam_shows_between_cells_at_any_magnification(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 62);
    Views views = {0};
    for (int kind = 0; kind < N_TAME_KINDS; kind++) {
        views_init(&views, (SceneKind)kind, &random);
        CellTree tree;
        assert_int_equal(celltree_build(&views.test.geometry, &cells, &tree, NULL), STATUS_OK);
        for (int i = 0; i < 2500; i++) {
            const Cell *cell = &tree.cells[random_bits(&random) % tree.n_cells];
            Vec3 at;
            if (!surface_on_face(&tree, cell, &random, &at))
                continue;
            for (double spread = 1e-2; spread > 1e-9; spread *= 0.05) {
                Vec3 aim = vec3_add_scaled(at, random_direction(&random), spread * 8 * cell->scale);
                Vec3 direction = random_direction(&random);
                if (i & 1) /* along an axis, as in the views from the front, top and left */
                    direction = i & 2 ? vec3(0, 0, -1) : vec3(1, 0, 0);
                Ray ray = {vec3_add_scaled(aim, direction, -200), direction};
                assert_seen_alike(&views, ray);
            }
        }
        celltree_release(&tree);
        views_release(&views);
    }
    printf("  %zu rays at faces of cells seen alike, %zu graze\n", views.seen, views.grazing);
    assert_true(views.seen > 10000);
}

static void a_hit_is_behind_the_wall_by_less_than_the_accuracy(void **state)
{
    (void)state;
    TestScene test = {.geometry = {.segments = test.segments}};
    put_segment(&test, vec3(-38.5, 0, 0), vec3(49, 0, 0), 0.73);
    TestSearch halving = halving_of(&test.geometry);
    for (double y = -0.7; y < 0.7; y += 0.0137) {
        Ray ray = {vec3(2.385, y, 30), vec3(0, 0, -1)};
        RayHit hit;
        assert_true(testsearch_first(&halving, ray, 1e-4, INFINITY, &hit));
        double wall = 30 - sqrt(0.73 * 0.73 - y * y);
        assert_true(hit.t >= wall - 1e-9 && hit.t < wall + cell_accuracy(0.73) + 1e-9);
        assert_int_equal(hit.index, 0);
    }
    testsearch_close(&halving);
}

static void a_shadow_ray_leaves_its_own_wall_alone(void **state)
{
    (void)state;
    TestScene test = {.geometry = {.segments = test.segments}};
    put_segment(&test, vec3(-38.5, 0, 0), vec3(49, 0, 0), 0.73);
    put_segment(&test, vec3(-38.5, 0, 5), vec3(49, 0, 5), 0.41);
    TestSearch halving = halving_of(&test.geometry);
    double inside = 0.5 * cell_accuracy(0.73);
    Vec3 start = vec3(2.385, 0, 0.73 - inside);
    assert_true(testsearch_any(&halving, (Ray){start, vec3(0, 0, 1)}, 1e-3, 60));
    assert_false(testsearch_any(&halving, (Ray){start, vec3(0, 0, 1)}, 1e-3, 3.5));
    assert_false(testsearch_any(&halving, (Ray){start, vec3_normalized(vec3(0, 1, 1))}, 1e-3, 60));
    assert_true(testsearch_any(&halving, (Ray){start, vec3(0, 0, -1)}, 1e-3, 60));
    /* Nearly along the wall it is met again, as POV-Ray has it. */
    assert_true(
        testsearch_any(&halving, (Ray){start, vec3_normalized(vec3(0, 1, 0.05))}, 1e-3, 60));
    testsearch_close(&halving);
}

static void an_empty_scene_shows_nothing(void **state)
{
    (void)state;
    const Geometry geometry = {.model = SCENE_ISOSURFACE};
    TestSearch halving = halving_of(&geometry);
    RayHit hit;
    Ray ray = {vec3(0, 0, 30), vec3(0, 0, -1)};
    assert_false(testsearch_first(&halving, ray, 1e-4, INFINITY, &hit));
    assert_false(testsearch_any(&halving, ray, 1e-3, 60));
    testsearch_close(&halving);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_it_sees_is_the_surface_to_its_accuracy),
        cmocka_unit_test(no_seam_shows_between_cells_at_any_magnification),
        cmocka_unit_test(a_hit_is_behind_the_wall_by_less_than_the_accuracy),
        cmocka_unit_test(a_shadow_ray_leaves_its_own_wall_alone),
        cmocka_unit_test(an_empty_scene_shows_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
