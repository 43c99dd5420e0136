/* Finds the smallest distance between the walls of vessels of different trees, and checks that it
 * is at least the clearance. It shares no code with growth, whose result it checks.
 *
 * A bounding volume hierarchy holds the box of each segment's tube. Each segment finds the tubes
 * within reach of its own box, and computes the distance of the two axes minus both radii. The
 * distance of two axes is the smallest of five distances: the one between the nearest points of the
 * two lines, if both points are on the segments, and those from each of the four ends to the other
 * segment. */
#include "grow/grow.h"

#include <stdlib.h>

/* Returns the squared distance of a point from a segment, mm^2. */
static double end_distance2(Vec3 end, Vec3 a, Vec3 b)
{
    Vec3 along = vec3_sub(b, a);
    double length2 = vec3_dot(along, along);
    double t = length2 > 0 ? vec3_dot(vec3_sub(end, a), along) / length2 : 0;
    Vec3 off = vec3_sub(end, vec3_add_scaled(a, along, fmin(1, fmax(0, t))));
    return vec3_dot(off, off);
}

/* Returns the squared distance of the lines through both segments, mm^2; INFINITY if the nearest
 * points of the lines are not on both segments. */
static double inner_distance2(Vec3 a, Vec3 b, Vec3 c, Vec3 d)
{
    Vec3 u = vec3_sub(b, a), v = vec3_sub(d, c), w = vec3_sub(c, a), normal = vec3_cross(u, v);
    double normal2 = vec3_dot(normal, normal);
    if (!(normal2 > 0))
        return INFINITY;
    double s = vec3_dot(vec3_cross(w, v), normal) / normal2;
    double t = vec3_dot(vec3_cross(w, u), normal) / normal2;
    if (s < 0 || s > 1 || t < 0 || t > 1)
        return INFINITY;
    double height = vec3_dot(w, normal);
    return height * height / normal2;
}

/* Returns the distance of the segments from a to b and from c to d, mm. */
static double axis_distance(Vec3 a, Vec3 b, Vec3 c, Vec3 d)
{
    double least2 = inner_distance2(a, b, c, d);
    least2 = fmin(least2, fmin(end_distance2(a, c, d), end_distance2(b, c, d)));
    return sqrt(fmin(least2, fmin(end_distance2(c, a, b), end_distance2(d, a, b))));
}

static Box box_of(const Tree *tree, size_t i)
{
    double radius = tree->radius_mm[i];
    size_t above = tree_is_segment(tree, i) ? (size_t)tree->parent[i] : i;
    return box_with_ball(box_with_ball(box_empty(), tree->position[above], radius),
                         tree->position[i], radius);
}

/* The state of the search. */
typedef struct ApartSearch {
    const Tree *tree;
    BoxTree boxes; /* of the segments */
    int32_t *root; /* per node: the root of its tree; owned */
    double within; /* mm; larger distances are not looked for */
    double apart;  /* mm; the least distance so far */
    size_t pair[2];
} ApartSearch;

/* Compares segment i with the segments of other trees that have a lower index. */
static void compare(ApartSearch *search, size_t i)
{
    const Tree *tree = search->tree;
    uint32_t j;
    Vec3 a = tree->position[tree->parent[i]], b = tree->position[i];
    for (BoxWalk walk = boxwalk_box(&search->boxes, box_padded(box_of(tree, i), search->within));
         boxwalk_next(&walk, &j);) {
        if (j >= i || !tree_is_segment(tree, j) || search->root[j] == search->root[i])
            continue;
        double distance = axis_distance(a, b, tree->position[tree->parent[j]], tree->position[j]) -
                          tree->radius_mm[i] - tree->radius_mm[j];
        if (distance >= search->within || distance >= search->apart)
            continue;
        search->apart = distance;
        search->pair[0] = j;
        search->pair[1] = i;
    }
}

Status trees_wall_distance(const Tree *tree, double within, double *apart, size_t pair[2], Err *err)
{
    ApartSearch search = {.tree = tree, .within = within, .apart = INFINITY};
    Box *box = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&box, tree->n, sizeof *box, "boxes", err));
    TRY_GOTO(mem_calloc(&search.root, tree->n, sizeof *search.root, "roots", err));
    for (size_t i = 0; i < tree->n; i++) {
        box[i] = box_of(tree, i);
        search.root[i] = tree_is_segment(tree, i) ? search.root[tree->parent[i]] : (int32_t)i;
    }
    TRY_GOTO(boxtree_build(box, tree->n, &search.boxes, err));
    for (size_t i = 0; i < tree->n; i++)
        if (tree_is_segment(tree, i))
            compare(&search, i);
    *apart = search.apart;
    pair[0] = search.pair[0];
    pair[1] = search.pair[1];
done:
    boxtree_release(&search.boxes);
    free(box);
    free(search.root);
    return status;
}

Status trees_prove_clearance(const Tree *tree, double clearance, double within, const char *advice,
                             double *apart, Err *err)
{
    size_t pair[2];
    TRY(trees_wall_distance(tree, within, apart, pair, err));
    if (*apart >= clearance)
        return STATUS_OK;
    int32_t ids[] = {tree->id[pair[0]], tree->id[pair[1]]};
    if (clearance > 0)
        return err_set(err, STATUS_INFEASIBLE,
                       "`clearance_mm` %g cannot be kept: the vessels that end in nodes %d and %d, "
                       "of different trees, are %.4g mm apart%s",
                       clearance, ids[0], ids[1], *apart, advice);
    return err_set(
        err, STATUS_INFEASIBLE,
        "the trees cannot be kept apart: the vessels that end in nodes %d and %d overlap "
        "by %.4g mm%s",
        ids[0], ids[1], -*apart, advice);
}
