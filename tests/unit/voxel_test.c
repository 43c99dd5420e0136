/* The filled fraction of voxels, labels, and grids. */
#include "unit.h"
#include "voxel/cover.h"
#include "voxel/grid.h"
#include "voxel/voxel.h"

#include "base/base.h"
#include "test_scene.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static double number(Random *random, double low, double high)
{
    return low + (high - low) * random_uniform(random);
}

static Vec3 point(Random *random, double size)
{
    double x = number(random, -size, size), y = number(random, -size, size);
    return vec3(x, y, number(random, -size, size));
}

static const VoxelCell cell = {.center = {0.31, -0.17, 0.43}, .half = {0.41, 0.53, 0.47}};

/* About the cell, from far thinner to far thicker than it. */
static Body random_body(Random *random)
{
    double radius = exp(number(random, log(0.004), log(40)));
    Vec3 across = vec3_normalized(point(random, 1));
    Vec3 near =
        vec3_add_scaled(vec3_add(cell.center, point(random, 0.6)), across, radius > 1 ? radius : 0);
    if (random_uniform(random) < 0.3)
        return body_make(near, near, radius, 1);
    Vec3 along = vec3_cross(across, vec3_normalized(point(random, 1)));
    if (random_uniform(random) < 0.2)
        along = vec3(0, number(random, 0.1, 2), 0);
    double back = number(random, 0, 2);
    return body_make(vec3_add_scaled(near, along, -back),
                     vec3_add_scaled(near, along, exp(number(random, -3, 4))), radius, 1);
}

static double part_of_eighths(const Body *body, const VoxelCell *whole, int depth)
{
    Vec3 half = vec3_scale(whole->half, 0.5);
    double part = 0;
    if (depth == 0)
        return body_fraction(body, whole);
    for (int i = 0; i < 8; i++) {
        Vec3 move = {i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z};
        VoxelCell eighth = {vec3_add(whole->center, move), half};
        part += part_of_eighths(body, &eighth, depth - 1);
    }
    return part / 8;
}

static bool is_inside(const Body *body, Vec3 x)
{
    Vec3 from = vec3_sub(x, body->start);
    double along = vec3_dot(from, body->axis);
    return along >= 0 && along <= body->length &&
           vec3_length(vec3_add_scaled(from, body->axis, -along)) <= body->radius;
}

/* The part of the cell's points, `side` along each axis, that are in one of the bodies. */
static double part_by_points(const Body *bodies, int n, int side)
{
    int inside = 0;
    for (int i = 0; i < side * side * side; i++) {
        Vec3 at = vec3((2 * (i % side) + 1.0) / side - 1, (2 * (i / side % side) + 1.0) / side - 1,
                       (2 * (i / side / side) + 1.0) / side - 1);
        Vec3 x =
            vec3_add(cell.center, vec3(at.x * cell.half.x, at.y * cell.half.y, at.z * cell.half.z));
        bool found = false;
        for (int k = 0; k < n && !found; k++)
            found = is_inside(&bodies[k], x);
        inside += found;
    }
    return (double)inside / (side * side * side);
}

static void part_of_a_body_is_exactly_that_of_the_eighths_of_the_cell(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 11);
    double worst[2] = {0};
    int partly = 0;
    for (int i = 0; i < 4000; i++) {
        Body body = random_body(&random);
        double part = body_fraction(&body, &cell), eighths = part_of_eighths(&body, &cell, 2);
        double *off = &worst[body_is_ball(&body)];
        *off = fmax(*off, fabs(part - eighths));
        partly += part > 0.01 && part < 0.99;
    }
    assert_true(partly > 1000);
    assert_true(worst[0] < 1e-6);
    assert_true(worst[1] < 1e-6);
}

static void part_of_a_body_is_that_of_points_in_it(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 12);
    double worst = 0;
    for (int i = 0; i < 60; i++) {
        Body body = random_body(&random);
        worst = fmax(worst, fabs(body_fraction(&body, &cell) - part_by_points(&body, 1, 40)));
    }
    assert_true(worst < 0.008);
}

static void thin_vessel_in_a_cell_has_its_volume(void **state)
{
    (void)state;
    for (double radius = 1e-2; radius > 1e-5; radius /= 7) {
        Body tube = body_make(vec3(0.2, -0.3, 0.3), vec3(0.41, 0.13, 0.61), radius, 1);
        double volume = body_fraction(&tube, &cell) * cell_volume(&cell);
        assert_true(fabs(volume / (acos(-1) * radius * radius * tube.length) - 1) < 1e-6);
    }
}

static void part_of_a_union_is_that_of_points_in_it(void **state)
{
    (void)state;
    enum { BODIES = 4 };
    const uint32_t list[BODIES] = {0, 1, 2, 3};
    Random random;
    random_seed(&random, 13);
    CoverWorkspace room = {0};
    double worst = 0, sum2 = 0;
    assert_int_equal(cover_reserve(&room, BODIES, NULL), STATUS_OK);
    for (int i = 0; i < 200; i++) {
        Body bodies[BODIES];
        double radius = exp(number(&random, log(0.1), log(3)));
        Vec3 node = vec3_add(cell.center, point(&random, radius));
        bodies[3] = body_make(node, node, radius, 0);
        for (uint32_t k = 0; k < 3; k++)
            bodies[k] = body_make(node, vec3_add_scaled(node, point(&random, 1), 4 * radius),
                                  radius * number(&random, 0.6, 1), k);
        double off =
            cover_fraction(bodies, list, BODIES, &cell, &room) - part_by_points(bodies, BODIES, 40);
        worst = fmax(worst, fabs(off));
        sum2 += off * off;
    }
    cover_release(&room);
    assert_true(worst < 0.012);
    assert_true(sqrt(sum2 / 200) < 0.003);
}

/* The part of a union by eighths of eighths of the cell. */
static double union_of_eighths(const Body *bodies, const uint32_t *list, size_t n,
                               const VoxelCell *whole, int depth, CoverWorkspace *room)
{
    Vec3 half = vec3_scale(whole->half, 0.5);
    double part = 0;
    if (depth == 0)
        return cover_fraction(bodies, list, n, whole, room);
    for (int i = 0; i < 8; i++) {
        Vec3 move = {i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z};
        VoxelCell eighth = {vec3_add(whole->center, move), half};
        part += union_of_eighths(bodies, list, n, &eighth, depth - 1, room);
    }
    return part / 8;
}

/* A direction: every fourth one is an axis, every fourth one lies in a plane across an axis. */
static Vec3 direction(Random *random)
{
    Vec3 way = point(random, 1);
    double kind = random_uniform(random);
    if (kind < 0.25)
        return vec3(way.x > 0 ? 1 : -1, 0, 0);
    if (kind < 0.5)
        way.z = 0;
    return vec3_normalized(way);
}

/* Of forks and bends of all widths, docs/VOXELS.md says how far the part of one voxel may be off.
 */
static void the_part_of_one_voxel_is_off_by_no_more_than_is_said(void **state)
{
    (void)state;
    enum { BODIES = 4, FORKS = 400 };
    const uint32_t list[BODIES] = {0, 1, 2, 3};
    const VoxelCell cube = {.center = {0.31, -0.17, 0.43}, .half = {0.5, 0.5, 0.5}};
    Random random;
    random_seed(&random, 17);
    CoverWorkspace room = {0};
    double worst = 0, sum2 = 0;
    assert_int_equal(cover_reserve(&room, BODIES, NULL), STATUS_OK);
    for (int i = 0; i < FORKS; i++) {
        Body bodies[BODIES];
        double radius = exp(number(&random, log(0.1), log(3)));
        Vec3 node = vec3_add(cube.center, point(&random, 0.5 + 0.7 * radius));
        bodies[3] = body_make(node, node, radius, 0);
        for (uint32_t k = 0; k < 3; k++)
            bodies[k] = body_make(node, vec3_add_scaled(node, direction(&random), 4 * radius),
                                  k ? radius * number(&random, 0.3, 1) : radius, k);
        double off = cover_fraction(bodies, list, BODIES, &cube, &room) -
                     union_of_eighths(bodies, list, BODIES, &cube, 2, &room);
        worst = fmax(worst, fabs(off));
        sum2 += off * off;
    }
    cover_release(&room);
    assert_true(worst < 0.03);
    assert_true(sqrt(sum2 / FORKS) < 0.0015);
}

static void thin_vessels_that_meet_in_a_cell_have_their_volume(void **state)
{
    (void)state;
    const uint32_t list[3] = {0, 1, 2};
    CoverWorkspace room = {0};
    assert_int_equal(cover_reserve(&room, 3, NULL), STATUS_OK);
    for (double radius = 1e-2; radius > 1e-3; radius /= 3) {
        Vec3 node = vec3(0.33, -0.1, 0.47), bend = vec3(0.2, -0.37, 0.29);
        Body bodies[3] = {body_make(bend, node, radius, 0),
                          body_make(node, vec3(0.41, 0.13, 0.61), radius, 0),
                          body_make(node, node, radius, 0)};
        double length = bodies[0].length + bodies[1].length;
        double volume = cover_fraction(bodies, list, 3, &cell, &room) * cell_volume(&cell);
        assert_true(fabs(volume / (acos(-1) * radius * radius * length) - 1) < 2 * radius);
    }
    cover_release(&room);
}

/* Bends and forks of vessels from a twentieth to a thousandth of the voxel: what a voxel of eighths
 * has, to a part of the vessels themselves. */
static void thin_vessels_in_a_large_cell_are_found_at_every_depth(void **state)
{
    (void)state;
    enum { BODIES = 4 };
    const uint32_t list[BODIES] = {0, 1, 2, 3};
    Random random;
    random_seed(&random, 19);
    CoverWorkspace room = {0};
    assert_int_equal(cover_reserve(&room, BODIES, NULL), STATUS_OK);
    for (int i = 0; i < 40; i++) {
        Body bodies[BODIES];
        double radius = exp(number(&random, log(0.001), log(0.05)));
        Vec3 node = vec3_add(cell.center, point(&random, 0.2));
        bodies[3] = body_make(node, node, radius, 0);
        double tubes = 0;
        for (uint32_t k = 0; k < 3; k++) { /* no two of them nearly parallel */
            Vec3 way = vec3_add_scaled(vec3(k == 0, k == 1, k == 2), point(&random, 1), 0.3);
            bodies[k] = body_make(node, vec3_add_scaled(node, way, 0.2), radius, k);
            tubes += acos(-1) * radius * radius * bodies[k].length;
        }
        double part = cover_fraction(bodies, list, BODIES, &cell, &room) * cell_volume(&cell);
        /* Three tubes overlap about their node by no more than four balls. */
        double overlap = 4 * 4.0 / 3 * acos(-1) * radius * radius * radius;
        if (part > 1.01 * tubes + overlap || part < 0.99 * tubes - overlap)
            fail_msg("radius %g: %g of tubes of %g, overlap %g", radius, part, tubes, overlap);
    }
    cover_release(&room);
}

/* Two bodies at one place, in both orders of their ids and of the list. */
static void of_equal_shares_the_lowest_id_owns_a_cell(void **state)
{
    (void)state;
    Body bodies[3];
    for (uint32_t k = 0; k < 3; k++) {
        Vec3 across = vec3(0.9 * k, 0, 0);
        bodies[k] = body_make(vec3_add(cell.center, k < 2 ? vec3(0, 0, 0) : across),
                              vec3(0.4, 1, 2), 0.2, k);
    }
    for (int order = 0; order < 2; order++) {
        uint32_t ids[3] = {order ? 9 : 5, order ? 5 : 9, 1};
        const Bodies all = {.body = bodies, .n = 3, .ids = ids};
        const uint32_t lists[2][3] = {{0, 1, 2}, {2, 1, 0}};
        assert_int_equal(ids[cell_owner(&all, lists[0], 3, &cell)], 5);
        assert_int_equal(ids[cell_owner(&all, lists[1], 3, &cell)], 5);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(part_of_a_body_is_exactly_that_of_the_eighths_of_the_cell),
        cmocka_unit_test(part_of_a_body_is_that_of_points_in_it),
        cmocka_unit_test(thin_vessel_in_a_cell_has_its_volume),
        cmocka_unit_test(part_of_a_union_is_that_of_points_in_it),
        cmocka_unit_test(the_part_of_one_voxel_is_off_by_no_more_than_is_said),
        cmocka_unit_test(thin_vessels_in_a_large_cell_are_found_at_every_depth),
        cmocka_unit_test(of_equal_shares_the_lowest_id_owns_a_cell),
        cmocka_unit_test(thin_vessels_that_meet_in_a_cell_have_their_volume),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
