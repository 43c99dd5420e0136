/* Positions the elements of a filling in the domain. An element is a chain of segments of the same
 * order; a Filling [fill_draw.h] lists elements with radii and lengths, but without positions.
 * Grown elements and segments are those of the given tree. Drawn elements and segments are new; a
 * drawn segment may also extend a grown element. The result is the list of the nodes of the filled
 * tree.
 *
 *     Places places = {.domain = domain, .filling = &filling};     (filling_draw was called)
 *     TRY(places_init(&places, tree, err));                        (then set places.end_node)
 *     TRY(places_fill(&places, params, err));
 *     TRY(places_repair(&places, &broken, err));                   (then places_release)
 *
 * The result depends only on the arguments and on the state of filling->random. Only one thread may
 * use a Places at a time. */
#ifndef CORCAST_GROW_FILL_FILL_PLACE_H
#define CORCAST_GROW_FILL_FILL_PLACE_H

#include "grow/cco/grid.h"
#include "grow/fill/fill_draw.h"

/* The index of no node. */
enum { NO_NODE = -1 };

/* A node of the filled tree, and the segment that ends there. */
typedef struct FillNode {
    Vec3 at;        /* position, mm */
    double radius;  /* radius of the segment, mm */
    int32_t parent; /* NO_NODE for a root. A parent may have a larger index than its child */
    int32_t origin; /* index of the node in the given tree; NO_NODE for a new node */
    bool grown;     /* the segment is a segment of the given tree, or a part of one that was split;
                     * such nodes never move */
} FillNode;

/* A segment that places_search has found, and a ball that contains the segment, mm. */
typedef struct FillNear {
    Vec3 center;
    double radius;
    int32_t segment;
} FillNear;

/* The nodes of the filled tree. Begin with {.domain = ..., .filling = ...}; release with
 * places_release. */
typedef struct Places {
    const Domain *domain; /* borrowed */
    Filling *filling;     /* borrowed; places_fill draws its random numbers from it. For grown
                           * elements, places_fill removes from the lists those daughters that start
                           * along the given segments, and sets `segments` */
    FillNode *node;       /* owned */
    size_t n, capacity;
    Grid grid;           /* finds all segments by position; owned */
    int32_t *end_node;   /* per element: its most distal node so far; NO_NODE: none; owned */
    int32_t *start_node; /* per drawn element: the node at which it branches off; NO_NODE until its
                          * parent has a segment there, and for all grown elements; owned */
    uint32_t *stamp;     /* per node: number of the last search that found its segment; owned */
    uint32_t searches;   /* number of searches so far */
    FillNear *near;      /* the segments that the last search found; owned */
    size_t n_near, near_capacity;
    size_t left_out; /* number of drawn elements of which no segment was placed: the parent has no
                      * node at which the element could start, every direction leaves the domain, or
                      * the capacity for nodes is used up */
    int32_t last_id; /* the largest id in the given tree */
} Places;

/* Frees the owned arrays, also after an error, and zeroes *places. */
void places_release(Places *places);

/* Copies the nodes of the given tree, and allocates capacity for all drawn segments. Requires a
 * call of filling_draw for places->filling. Sets `end_node` and `start_node` to NO_NODE for every
 * element. The caller then sets `end_node` of each grown element to its most distal node. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status places_init(Places *places, const Tree *tree, Err *err);

/* Positions all elements of places->filling, order by order from the highest. Calls
 * params->progress, unless it is NULL, after every 1024 elements. Errors: STATUS_CANCELLED if
 * params->progress returns false; STATUS_MEMORY. *places is then only fit for places_release. */
MUST_CHECK Status places_fill(Places *places, const GrowParams *params, Err *err);

/* Repairs broken segments by moving nodes that are not grown [fill_repair.c]. A drawn segment is
 * broken if it is shorter than its diameter, or if it overlaps a segment with which it shares no
 * node. If two drawn segments overlap, only the segment with the higher node index is broken.
 *
 * broken   receives the number of segments that remain broken; undefined after an error.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status places_repair(Places *places, size_t *broken, Err *err);

/* Enters the segment that ends at node i in the grid. If the segment is in the grid already,
 * updates its position there. Does nothing for a root and for a segment of length 0. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status places_enter(Places *places, int32_t i, Err *err);

/* Finds the segments whose walls may be within `reach` mm of the straight line from `a` to `b`.
 * Stores each segment once in places->near, and their number in places->n_near. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status places_search(Places *places, Vec3 a, Vec3 b, double reach, Err *err);

#endif
