/* The promises of every grown or refined tree, checked from coordinates and radii alone.
 * Nothing here uses the data structures of growth. */
#ifndef CORCAST_TESTS_TREE_PROMISES_H
#define CORCAST_TESTS_TREE_PROMISES_H

#include "tree/tree.h"
#include "unit.h"

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

static inline int32_t *child_counts(const Tree *tree)
{
    int32_t *count;
    assert_int_equal(tree_child_counts(tree, &count, NULL), STATUS_OK);
    return count;
}

static inline void assert_binary(const Tree *tree, size_t terminals)
{
    assert_int_equal(tree->n, 2 * terminals);
    assert_int_equal(tree_check(tree, NULL), STATUS_OK);
    int32_t *children = child_counts(tree);
    size_t ends = 0;
    assert_int_equal(tree->parent[0], TREE_NO_PARENT);
    assert_int_equal(children[0], 1);
    assert_true(tree->radius_mm[0] == tree->radius_mm[1]);
    for (size_t i = 0; i < tree->n; i++) {
        assert_int_equal(tree->id[i], (int32_t)i + 1);
        assert_int_equal(tree->type[i], TREE_VESSEL_TYPE);
        if (i > 0) {
            assert_true(children[i] == 0 || children[i] == 2);
            assert_true(tree_segment_length(tree, i) > 0 && tree->radius_mm[i] > 0);
            ends += children[i] == 0;
        }
    }
    assert_int_equal(ends, terminals);
    free(children);
}

/* Murray's law to 1e-12 at every bifurcation. Shares of the parent's radius, so that no power
 * overflows. */
static inline void assert_murray(const Tree *tree, double gamma)
{
    double *sum = calloc(tree->n, sizeof *sum);
    assert_non_null(sum);
    for (size_t i = 2; i < tree->n; i++)
        sum[tree->parent[i]] += pow(tree->radius_mm[i] / tree->radius_mm[tree->parent[i]], gamma);
    int32_t *children = child_counts(tree);
    for (size_t i = 1; i < tree->n; i++)
        if (children[i])
            assert_true(fabs(sum[i] - 1) <= 1e-12);
    free(children);
    free(sum);
}

/* Poiseuille's law from the inlet, the flow through each terminal by its share: p_term at each, to
 * 1e-9 of the drop. */
static inline void assert_pressures(const Tree *tree)
{
    const double *said = tree->meta.number;
    const double pa = 133.322387415;
    double drop = (said[META_P_PERF] - said[META_P_TERM]) * pa;
    double flow = said[META_Q_PERF] * 1000 / 60, viscosity = said[META_VISCOSITY] * 1e-3;
    int32_t *children = child_counts(tree);
    double *share = calloc(tree->n, sizeof *share), *pressure = calloc(tree->n, sizeof *pressure);
    assert_true(share && pressure);
    for (size_t i = tree->n - 1; i > 0; i--) {
        share[i] += tree->flow_share ? tree->flow_share[i] : children[i] == 0;
        share[tree->parent[i]] += share[i];
    }
    pressure[0] = said[META_P_PERF] * pa;
    for (size_t i = 1; i < tree->n; i++) {
        double r2 = tree->radius_mm[i] * tree->radius_mm[i];
        double fall = 8 * viscosity / pi * tree_segment_length(tree, i) / r2 * flow * share[i] /
                      share[0] / r2;
        pressure[i] = pressure[tree->parent[i]] - fall;
        if (!children[i])
            assert_true(fabs(pressure[i] - said[META_P_TERM] * pa) <= 1e-9 * drop);
    }
    free(share);
    free(children);
    free(pressure);
}

static inline bool share_a_node(const Tree *tree, size_t i, size_t j)
{
    return tree->parent[i] == tree->parent[j] || tree->parent[i] == (int32_t)j ||
           tree->parent[j] == (int32_t)i;
}

static inline double distance_to_segment(Vec3 p, Vec3 a, Vec3 b)
{
    Vec3 u = vec3_sub(b, a);
    double t = vec3_dot(vec3_sub(p, a), u) / vec3_dot(u, u);
    return vec3_distance(p, vec3_add_scaled(a, u, fmin(1, fmax(0, t))));
}

/* By ternary search: the distance of a point from a segment is convex along another segment. */
static inline double segment_distance(Vec3 a, Vec3 b, Vec3 c, Vec3 d)
{
    double low = 0, high = 1;
    Vec3 u = vec3_sub(b, a);
    while (high - low > 1e-9) {
        double left = (2 * low + high) / 3, right = (low + 2 * high) / 3;
        if (distance_to_segment(vec3_add_scaled(a, u, left), c, d) <
            distance_to_segment(vec3_add_scaled(a, u, right), c, d))
            high = right;
        else
            low = left;
    }
    return distance_to_segment(vec3_add_scaled(a, u, low), c, d);
}

/* How many segments are shorter than wide, plus how many pairs without a common node overlap. */
static inline size_t count_violations(const Tree *tree)
{
    size_t count = 0;
    for (size_t i = 1; i < tree->n; i++) {
        Vec3 a = tree->position[tree->parent[i]], b = tree->position[i];
        count += tree_segment_length(tree, i) < 2 * tree->radius_mm[i];
        for (size_t j = 1; j < i; j++) {
            Vec3 c = tree->position[tree->parent[j]], d = tree->position[j];
            double reach = tree->radius_mm[i] + tree->radius_mm[j];
            if (!share_a_node(tree, i, j) &&
                vec3_distance(a, c) < reach + vec3_distance(a, b) + vec3_distance(c, d))
                count += segment_distance(a, b, c, d) < reach;
        }
    }
    return count;
}

#endif
