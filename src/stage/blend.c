/* From either end of a segment the tree is walked away from it; in a tree each node is reached by
 * one way only, so nothing needs to be remembered but the way ahead. */
#include "stage/blend.h"

#include <stdlib.h>

typedef struct Stop {
    int32_t node, from; /* reached from this neighbour */
    double distance;    /* along the tree, mm */
} Stop;

typedef struct Walk {
    const Tree *tree;
    const int32_t *number;
    int32_t *child, *sibling; /* first child of a node, next child of its parent; -1: none */
    Stop *stack;
    uint32_t *found;
    size_t n_found, capacity;
} Walk;

static Status add_found(Walk *walk, int32_t node, Err *err)
{
    if (walk->number[node] < 0)
        return STATUS_OK;
    TRY(mem_reserve(&walk->found, &walk->capacity, walk->n_found + 1, sizeof *walk->found,
                    "neighbours", err));
    walk->found[walk->n_found++] = (uint32_t)walk->number[node];
    return STATUS_OK;
}

/* Adds the segments at the nodes within `limit` of `start`, without going through `from`. */
static Status walk_away(Walk *walk, int32_t start, int32_t from, double limit, Err *err)
{
    const Tree *tree = walk->tree;
    size_t top = 0;
    walk->stack[top++] = (Stop){start, from, 0};
    while (top) {
        Stop stop = walk->stack[--top];
        int32_t parent = tree->parent[stop.node];
        if (parent >= 0 && parent != stop.from) {
            double further = stop.distance + tree_segment_length(tree, (size_t)stop.node);
            TRY(add_found(walk, stop.node, err));
            if (further <= limit)
                walk->stack[top++] = (Stop){parent, stop.node, further};
        }
        for (int32_t child = walk->child[stop.node]; child >= 0; child = walk->sibling[child]) {
            if (child == stop.from)
                continue;
            double further = stop.distance + tree_segment_length(tree, (size_t)child);
            TRY(add_found(walk, child, err));
            if (further <= limit)
                walk->stack[top++] = (Stop){child, stop.node, further};
        }
    }
    return STATUS_OK;
}

static int compare_numbers(const void *a, const void *b)
{
    uint32_t one = *(const uint32_t *)a, other = *(const uint32_t *)b;
    return (one > other) - (one < other);
}

static Status find_all(Walk *walk, Geometry *geometry, Err *err)
{
    const Tree *tree = walk->tree;
    size_t *first = geometry->blend.first;
    for (size_t i = 0; i < tree->n; i++) {
        int32_t self = walk->number[i], parent = tree->parent[i];
        if (self < 0)
            continue;
        double limit = BLEND_RADII * tree->radius_mm[i];
        size_t begin = walk->n_found;
        first[self] = begin;
        TRY(add_found(walk, (int32_t)i, err));
        TRY(walk_away(walk, parent, (int32_t)i, limit, err));
        TRY(walk_away(walk, (int32_t)i, parent, limit, err));
        qsort(walk->found + begin, walk->n_found - begin, sizeof *walk->found, compare_numbers);
        first[self + 1] = walk->n_found;
    }
    return STATUS_OK;
}

Status blend_find(const Tree *tree, const int32_t *number, Geometry *geometry, Err *err)
{
    Status status;
    Walk walk = {.tree = tree, .number = number};
    TRY_GOTO(mem_calloc(&walk.child, tree->n, sizeof *walk.child, "nodes", err));
    TRY_GOTO(mem_calloc(&walk.sibling, tree->n, sizeof *walk.sibling, "nodes", err));
    TRY_GOTO(mem_calloc(&walk.stack, tree->n + 1, sizeof *walk.stack, "nodes", err));
    TRY_GOTO(mem_calloc(&geometry->blend.first, geometry->n_segments + 1,
                        sizeof *geometry->blend.first, "neighbours", err));
    for (size_t i = 0; i < tree->n; i++)
        walk.child[i] = walk.sibling[i] = -1;
    for (size_t i = tree->n; i-- > 0;)
        if (tree->parent[i] >= 0) {
            walk.sibling[i] = walk.child[tree->parent[i]];
            walk.child[tree->parent[i]] = (int32_t)i;
        }
    TRY_GOTO(find_all(&walk, geometry, err));
    geometry->blend.neighbors = walk.found;
    walk.found = NULL;
done:
    free(walk.child);
    free(walk.sibling);
    free(walk.stack);
    free(walk.found);
    return status;
}
