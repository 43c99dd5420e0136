/* Parts of growth that are hard to test in whole trees: the best position on a straight
 * segment, quotas of trees, sizes of territories. */
#include "grow/cco/fermat.h"
#include "grow/forest.h"
#include "grow/territory.h"
#include "unit.h"

#include <stdint.h>

static double sum_at(const Vec3 corner[3], const double weight[3], double t)
{
    Vec3 at = vec3_add_scaled(corner[0], vec3_sub(corner[1], corner[0]), t);
    double sum = 0;
    for (int i = 0; i < 3; i++)
        sum += weight[i] * vec3_distance(at, corner[i]);
    return sum;
}

static void no_point_between_two_corners_is_better_than_the_one_that_is_found(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 2385);
    for (int run = 0; run < 300; run++) {
        Vec3 corner[3];
        double weight[3];
        for (int i = 0; i < 3; i++) {
            corner[i] = vec3(random_uniform(&random), random_uniform(&random),
                             run % 2 ? random_uniform(&random) : 0);
            weight[i] = 0.1 + random_uniform(&random);
        }
        double length = vec3_distance(corner[0], corner[1]);
        const double margin[2] = {0.1 * length, 0.2 * length};
        Vec3 found = fermat_point_between(corner, weight, margin);
        double t = vec3_distance(found, corner[0]) / length;
        assert_true(t >= 0.1 - 1e-12 && t <= 0.8 + 1e-12);
        for (double other = 0.1; other <= 0.8; other += 0.001)
            assert_true(sum_at(corner, weight, t) <= sum_at(corner, weight, other) + 1e-12);
    }
}

/* Between the ends of two legs of 1 and their right angle, (3 - sqrt 3) / 6 from both legs. And
 * above an edge at whose ends, 1 from its middle, two weights of 5 pull against one of 6: at the
 * angle to the upright whose cosine is 6 / 10. */
static void fermats_point_is_where_geometry_puts_it(void **state)
{
    (void)state;
    const Vec3 right_angle[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const double equal[3] = {1, 1, 1};
    Fermat found = fermat_point(right_angle, equal);
    assert_int_equal(found.corner, -1);
    assert_true(vec3_distance(found.place, vec3(0.21132486540518713, 0.21132486540518713, 0)) <
                1e-15);
    const Vec3 isosceles[3] = {{-1, 0, 0.5}, {1, 0, 0.5}, {0, 2, 0.5}};
    const double weight[3] = {5, 5, 6};
    found = fermat_point(isosceles, weight);
    assert_int_equal(found.corner, -1);
    assert_true(vec3_distance(found.place, vec3(0, 0.75, 0.5)) < 1e-15);
}

/* At the point found the weighted unit vectors to the corners cancel; at a corner they do not
 * outweigh it. */
static void weighted_pulls_cancel_at_fermats_point(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 2385);
    int inside = 0;
    for (int run = 0; run < 300; run++) {
        Vec3 corner[3], pull = {0, 0, 0};
        double weight[3];
        for (int i = 0; i < 3; i++) {
            corner[i] = vec3(random_uniform(&random), random_uniform(&random),
                             run % 2 ? random_uniform(&random) : 0);
            weight[i] = 0.1 + random_uniform(&random);
        }
        Fermat found = fermat_point(corner, weight);
        for (int i = 0; i < 3; i++)
            if (i != found.corner)
                pull = vec3_add_scaled(pull, vec3_normalized(vec3_sub(corner[i], found.place)),
                                       weight[i]);
        if (found.corner < 0)
            assert_true(vec3_length(pull) < 1e-9);
        else
            assert_true(vec3_length(pull) <= weight[found.corner] * (1 + 1e-12));
        inside += found.corner < 0;
    }
    assert_true(inside > 60 && inside < 240);
}

static void margins_wider_than_the_segment_leave_the_middle_between_them(void **state)
{
    (void)state;
    const Vec3 corner[3] = {{0, 0, 0}, {2, 0, 0}, {1, 5, 0}};
    const double weight[3] = {1, 1, 1}, margin[2] = {1.75, 1.25};
    Vec3 found = fermat_point_between(corner, weight, margin);
    assert_true(fabs(found.x - 1.25) <= 1e-15 && found.y == 0 && found.z == 0);
}

static void expect_quotas(const double *share, size_t terminals, const size_t expected[3])
{
    Forest forest;
    assert_int_equal(forest_init(&forest, 3, share, terminals, NULL), STATUS_OK);
    for (size_t k = 0; k < 3; k++)
        assert_int_equal(forest.quota[k], expected[k]);
    forest_release(&forest);
}

static void quotas_go_by_largest_remainders_and_leave_no_tree_without_a_terminal(void **state)
{
    (void)state;
    expect_quotas((const double[]){1, 1, 1}, 9, (const size_t[]){3, 3, 3});
    expect_quotas((const double[]){5.2, 2.7, 2.1}, 10, (const size_t[]){5, 3, 2});
    expect_quotas((const double[]){0.25, 0.25, 0.5}, 1001, (const size_t[]){250, 250, 501});
    expect_quotas((const double[]){1e-9, 1, 1e-9}, 10, (const size_t[]){1, 8, 1});
    expect_quotas((const double[]){1e-9, 1, 1e-9}, 3, (const size_t[]){1, 1, 1});
}

static void a_territory_counts_the_points_that_are_nearest_whatever_the_threads(void **state)
{
    (void)state;
    Domain domain;
    Network net;
    assert_int_equal(domain_parse(&domain, "rect:30,10", NULL), STATUS_OK);
    assert_int_equal(network_init(&net, (Law){3, 2}, 1, (NetworkSize){8, 1, false}, NULL),
                     STATUS_OK);
    int32_t inlet = network_append(&net, -1, vec3(0, 5, 0));
    int32_t fork = network_append(&net, inlet, vec3(0, 0, 0));
    int32_t left = network_append(&net, fork, vec3(-10, 0, 0));
    int32_t right = network_append(&net, fork, vec3(4, 1, 0));
    network_resum(&net);
    double one[4], many[4];
    assert_int_equal(territory_count(&net, &(TerritoryParams){&domain, NULL, 5000, 1}, one, NULL),
                     STATUS_OK);
    assert_int_equal(territory_count(&net, &(TerritoryParams){&domain, NULL, 5000, 3}, many, NULL),
                     STATUS_OK);
    assert_memory_equal(one, many, sizeof one);
    assert_true(one[inlet] == 0 && one[fork] == 0);
    /* The points as near to (-10, 0) as to (4, 1) meet y = 0, the middle, at x = (17 - 100) /
     * 28. */
    double left_part = (15 - 83.0 / 28) / 30, total = one[left] + one[right];
    assert_true(fabs(one[left] / total - left_part) <= 2e-3);
    network_release(&net);
    domain_release(&domain);
}

/* Where in a box, its bounds included, a cell's bounds more often than chance has it. */
static Vec3 random_place(Random *random, const Grid *grid, Box box)
{
    double t[3], size[3] = {box.high.x - box.low.x, box.high.y - box.low.y, box.high.z - box.low.z};
    for (int axis = 0; axis < 3; axis++) {
        t[axis] = random_uniform(random) * size[axis];
        if (random_uniform(random) < 0.3)
            t[axis] = fmin(round(t[axis] / grid->edge) * grid->edge, size[axis]);
    }
    return vec3_add(box.low, vec3(t[0], t[1], t[2]));
}

static void expect_nearest(const char *spec, size_t segments, double longest)
{
    enum { LIMIT = 8 };
    Domain domain;
    Random random;
    Grid grid = {0};
    assert_int_equal(domain_parse(&domain, spec, NULL), STATUS_OK);
    Box box = domain.bounds;
    assert_int_equal(grid_reset(&grid, box, (double)segments, segments, 1, NULL), STATUS_OK);
    random_seed(&random, 2385);
    for (size_t i = 0; i < segments; i++) {
        Vec3 a = random_place(&random, &grid, box), b = random_place(&random, &grid, box);
        Vec3 to = vec3_add_scaled(a, vec3_sub(b, a), longest * random_uniform(&random));
        GridItem item = grid_item(&grid, (Capsule){a, to, 0.1 * grid.edge}, 0.05 * grid.edge);
        assert_int_equal(grid_add(&grid, 0, (int32_t)i, i % 2, item, NULL), STATUS_OK);
    }
    int quick = 0;
    for (int k = 0; k < 2000; k++) {
        Near one[LIMIT], many[LIMIT];
        Vec3 point = random_place(&random, &grid, box);
        assert_int_equal(grid_nearest(&grid, point, INFINITY, LIMIT, one), LIMIT);
        double last = sqrt((double)one[LIMIT - 1].distance2);
        assert_false(grid_nearest_quick(&grid, point, 0.99 * last, LIMIT, many));
        if (!grid_nearest_quick(&grid, point, 1.1 * last + 1e-5, LIMIT, many))
            continue;
        quick++;
        assert_memory_equal(one, many, sizeof one);
    }
    assert_true(quick > 1900);
    grid_release(&grid);
    domain_release(&domain);
}

static void the_quick_search_finds_what_the_other_finds(void **state)
{
    (void)state;
    expect_nearest("disc:50", 3000, 0.03);
    expect_nearest("disc:50", 300, 0.4);
    expect_nearest("ball:50", 3000, 0.05);
    expect_nearest("rect:30,10", 1000, 0.02);
    expect_nearest("rect:1,2000", 40, 0.02);
    expect_nearest("rect:20,1000", 300, 0.001);
    expect_nearest("box:1,1,2000", 40, 0.02);
    expect_nearest("box:20,30,1000", 300, 0.001);
    expect_nearest("box:1,400,900", 1000, 0.02);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_point_between_two_corners_is_better_than_the_one_that_is_found),
        cmocka_unit_test(fermats_point_is_where_geometry_puts_it),
        cmocka_unit_test(weighted_pulls_cancel_at_fermats_point),
        cmocka_unit_test(margins_wider_than_the_segment_leave_the_middle_between_them),
        cmocka_unit_test(quotas_go_by_largest_remainders_and_leave_no_tree_without_a_terminal),
        cmocka_unit_test(the_quick_search_finds_what_the_other_finds),
        cmocka_unit_test(a_territory_counts_the_points_that_are_nearest_whatever_the_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
