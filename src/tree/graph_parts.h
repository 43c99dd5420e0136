/* Types and functions that the source files of the graph builder share [graph.h]. Private to the
 * module tree. */
#ifndef CORCAST_TREE_GRAPH_PARTS_H
#define CORCAST_TREE_GRAPH_PARTS_H

#include "tree/graph.h"

/* A named value for each point, or for each line. */
typedef struct GraphColumn {
    char *name, *unit; /* owned */
    GraphElement of;
    double *value; /* values of the first `n` elements; those of later elements are NAN and not
                    * stored; owned */
    size_t n, capacity;
} GraphColumn;

/* The indices of two points that the file declares to be the same point. */
typedef struct GraphJoin {
    size_t a, b;
} GraphJoin;

/* Converts the positions and radii of points and lines to mm, by the graph's options and unit. */
void graph_scale(Graph *graph);

/* Finds the points that are merged.
 *
 * by_position     true: merges joined points, and points whose positions are equal within
 *                 ReadOptions.merge_tolerance_mm. false: merges only joined points.
 * representative  receives a new array, which the caller frees: per point, the lowest index among
 *                 the points that are merged with it, itself included.
 * Errors          STATUS_INPUT if a join refers to a point that does not exist. STATUS_MEMORY.
 * Cost            O(points). */
MUST_CHECK Status graph_merge(const Graph *graph, bool by_position, uint32_t **representative,
                              Err *err);

/* Counts the ends of lines that nearly touch a point of another component, and finds the widest of
 * these gaps. Sets near_ends and near_mm of reading->network.
 *
 * component  per point: index of its component, from 1; 0 for a point that is left out.
 * reach      per point: if the point is an end of a line, the distance, mm, at most `max_reach`,
 *            within which another point counts as near; else 0.
 * Errors     STATUS_MEMORY.
 * Cost       Stops after 100 comparisons per point, on average over all points, so that dense
 *            points do not take quadratic time. The count is then a lower bound. */
MUST_CHECK Status graph_near_ends(const Graph *graph, const uint32_t *component,
                                  const double *reach, double max_reach, TreeReading *reading,
                                  Err *err);

#endif
