/* What the files of the graph builder share. */
#ifndef CORCAST_TREE_GRAPH_PARTS_H
#define CORCAST_TREE_GRAPH_PARTS_H

#include "tree/graph.h"

typedef struct GraphColumn {
    char *name, *unit;
    GraphElement of;
    double *value; /* of the first `n` elements */
    size_t n, capacity;
} GraphColumn;

typedef struct GraphJoin {
    size_t a, b;
} GraphJoin;

/* Scales points and lines to mm. */
void graph_scale(Graph *graph);

/* The point that each point becomes, the first of those that are joined or, with `by_place`, lie
 * where it does, in *place (owned). STATUS_INPUT for a join of a point that there is not.
 * O(points). */
MUST_CHECK Status graph_merge(const Graph *graph, bool by_place, uint32_t **place, Err *err);

/* Counts the ends that lie within their reach of a point of another component, and finds the widest
 * of these gaps, in *reading. `part` is the component of each point, 0 of points that are left out;
 * `reach` is 0 for points that are no ends, and at most `most`. Stops counting after 100
 * comparisons per point, so that dense points do not take quadratic time. */
MUST_CHECK Status graph_near_ends(const Graph *graph, const uint32_t *part, const double *reach,
                                  double most, TreeReading *reading, Err *err);

#endif
