/* The bounding volume hierarchy, compared with a test of every box. */
#include "geom/geom.h"
#include "unit.h"

#include "base/base.h"
#include <stdint.h>
#include <stdlib.h>

enum { N = 500 };

static Vec3 point(Random *random, double size)
{
    double x = random_uniform(random) * size, y = random_uniform(random) * size;
    return vec3(x, y, random_uniform(random) * size);
}

/* Boxes of all sizes, some of them flat, some of them equal. */
static void make_boxes(Random *random, Box *boxes)
{
    for (size_t i = 0; i < N; i++) {
        Vec3 low = point(random, 97.3), size = point(random, i % 17 == 0 ? 61.7 : 2.3);
        size.z = i % 5 == 0 ? 0 : size.z;
        boxes[i] = i % 11 == 0 && i > 0 ? boxes[i - 1] : (Box){low, vec3_add(low, size)};
    }
}

static BoxTree build(const Box *boxes, size_t n)
{
    BoxTree tree;
    Err err;
    assert_int_equal(boxtree_build(boxes, n, &tree, &err), STATUS_OK);
    return tree;
}

/* How often the walk comes to each box. */
static void count(BoxWalk walk, int *times)
{
    for (size_t i = 0; i < N; i++)
        times[i] = 0;
    for (uint32_t i; boxwalk_next(&walk, &i);)
        times[i]++;
}

static void a_walk_comes_once_to_every_box_that_a_box_meets(void **state)
{
    (void)state;
    Random random;
    Box boxes[N];
    int times[N];
    random_seed(&random, 2385);
    make_boxes(&random, boxes);
    BoxTree tree = build(boxes, N);
    for (int k = 0; k < 300; k++) {
        Vec3 low = point(&random, 97.3);
        Box around = {low, vec3_add(low, point(&random, 13.1))};
        count(boxwalk_box(&tree, around), times);
        for (size_t i = 0; i < N; i++)
            assert_in_range(times[i], box_overlaps(around, boxes[i]), 1);
    }
    boxtree_release(&tree);
}

static void a_walk_comes_once_to_every_box_that_a_segment_meets(void **state)
{
    (void)state;
    Random random;
    Box boxes[N];
    int times[N], visits = 0;
    random_seed(&random, 7193);
    make_boxes(&random, boxes);
    BoxTree tree = build(boxes, N);
    for (int k = 0; k < 300; k++) {
        Vec3 a = point(&random, 97.3), b = vec3_add(a, point(&random, 11.9));
        b.y = k % 3 == 0 ? a.y : b.y;
        count(boxwalk_segment(&tree, a, b), times);
        for (size_t i = 0; i < N; i++) {
            double t0 = 0, t1 = 1;
            bool met = hit_box(a, vec3_inverse(vec3_sub(b, a)), &boxes[i], &t0, &t1);
            assert_in_range(times[i], met, 1);
            visits += times[i];
        }
    }
    assert_true(visits < 300 * N / 10);
    boxtree_release(&tree);
}

static void a_ray_finds_the_nearest_box_whichever_child_comes_first(void **state)
{
    (void)state;
    Random random;
    Box boxes[N];
    random_seed(&random, 41);
    make_boxes(&random, boxes);
    BoxTree tree = build(boxes, N);
    for (int k = 0; k < 600; k++) {
        Vec3 origin = point(&random, 97.3),
             direction = vec3_sub(point(&random, 1), vec3(.5, .5, .5));
        double nearest = INFINITY, found = INFINITY;
        for (size_t i = 0; i < N; i++) {
            double t0 = 0.37, t1 = nearest;
            if (hit_box(origin, vec3_inverse(direction), &boxes[i], &t0, &t1))
                nearest = t0;
        }
        BoxWalk walk;
        boxwalk_start(&walk, &tree, origin, direction, 0.37, k % 2 == 0);
        for (const BoxNode *leaf; (leaf = boxwalk_leaf(&walk, found));)
            for (uint32_t i = leaf->first; i < leaf->first + leaf->n_items; i++) {
                double t0 = 0.37, t1 = found;
                if (hit_box(origin, walk.inverse, &boxes[tree.items[i]], &t0, &t1))
                    found = t0;
            }
        assert_true(found == nearest);
    }
    boxtree_release(&tree);
}

static void boxes_that_coincide_make_a_tree_of_little_depth(void **state)
{
    (void)state;
    Box boxes[N];
    int times[N];
    Vec3 low = vec3(2.385, 7.12, -3.3);
    for (size_t i = 0; i < N; i++)
        boxes[i] = (Box){low, low};
    BoxTree tree = build(boxes, N);
    count(boxwalk_box(&tree, boxes[0]), times);
    for (size_t i = 0; i < N; i++)
        assert_int_equal(times[i], 1);
    boxtree_release(&tree);
    tree = build(boxes, 1);
    uint32_t i;
    BoxWalk walk = boxwalk_segment(&tree, vec3(0, 7.12, -3.3), vec3(9.1, 7.12, -3.3));
    assert_true(boxwalk_next(&walk, &i));
    assert_false(boxwalk_next(&walk, &i));
    boxtree_release(&tree);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_walk_comes_once_to_every_box_that_a_box_meets),
        cmocka_unit_test(a_walk_comes_once_to_every_box_that_a_segment_meets),
        cmocka_unit_test(a_ray_finds_the_nearest_box_whichever_child_comes_first),
        cmocka_unit_test(boxes_that_coincide_make_a_tree_of_little_depth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
