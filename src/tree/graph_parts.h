/* Types and functions that the source files of the graph builder share [graph.h]. Private. */
#ifndef CORCAST_TREE_GRAPH_PARTS_H
#define CORCAST_TREE_GRAPH_PARTS_H

#include "tree/graph.h"

/* A named value for each point, or for each line. */
typedef struct GraphColumn {
    char *name, *unit; /* owned */
    GraphElement of;
    double *value; /* values of the first `n` elements; all later elements have NAN; owned */
    size_t n, capacity;
} GraphColumn;

/* Two points, by number, that the file declares to be one. */
typedef struct GraphJoin {
    size_t a, b;
} GraphJoin;

/* Converts the positions and radii of points and lines to mm, by the graph's options and unit. */
void graph_scale(Graph *graph);

/* Finds the points that are merged.
 *
 * by_position     also merge points that have the same position, within
 *                 ReadOptions.merge_tolerance_mm; otherwise only joined points.
 * representative  receives, per point, the first of the points that it is merged with: the point's
 *                 own number if it is merged with none. A new array, which the caller frees.
 * Errors          STATUS_INPUT if a join refers to a point that does not exist. STATUS_MEMORY.
 * Cost            O(points). */
MUST_CHECK Status graph_merge(const Graph *graph, bool by_position, uint32_t **representative,
                              Err *err);

/* Counts the ends of lines that nearly touch a point of another component, and finds the widest of
 * these gaps, for reading->network (near_ends, near_mm).
 *
 * component  per point: index of its component, from 1; 0 for a point that is left out.
 * reach      per point: for an end, the distance, mm, at which another point counts as near, at
 *            most `max_reach`; 0 for a point that is not an end.
 * Errors     STATUS_MEMORY.
 * Cost       Stops counting after 100 comparisons per point, so that dense points do not take
 *            quadratic time. */
MUST_CHECK Status graph_near_ends(const Graph *graph, const uint32_t *component,
                                  const double *reach, double max_reach, TreeReading *reading,
                                  Err *err);

#endif
