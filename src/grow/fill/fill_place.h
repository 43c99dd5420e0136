/* Gives the elements of a filling [fill_draw.h] positions in the domain, and so makes the nodes of
 * the filled tree.
 *
 *     Places places = {.domain = domain, .filling = &filling};     (filling_draw was called)
 *     TRY(places_init(&places, tree, err));                        (then set places.end)
 *     TRY(places_fill(&places, params, err));
 *     TRY(places_repair(&places, &broken, err));                   (then places_release)
 *
 * The result depends only on the arguments and on the state of filling->random. One thread at a
 * time may use a Places. */
#ifndef CORCAST_GROW_FILL_FILL_PLACE_H
#define CORCAST_GROW_FILL_FILL_PLACE_H

#include "grow/cco/grid.h"
#include "grow/fill/fill_draw.h"

/* The index of no node. */
enum { NO_NODE = -1 };

/* A node of the filled tree, and the segment that ends there. */
typedef struct FillNode {
    Vec3 at;        /* mm */
    double radius;  /* of the segment, mm */
    int32_t parent; /* NO_NODE for a root. A parent may have a larger index than its child */
    int32_t origin; /* the node of the tree that is filled; NO_NODE for a new node */
    bool grown;     /* the segment is a segment of the tree that is filled, or a part of one; such
                     * nodes never move */
} FillNode;

/* A segment that places_search found, and a ball that contains its wall, mm. */
typedef struct FillNear {
    Vec3 center;
    double radius;
    int32_t segment;
} FillNear;

/* The nodes of the filled tree. Begin with {.domain = ..., .filling = ...}; release with
 * places_release. */
typedef struct Places {
    const Domain *domain; /* borrowed */
    Filling *filling;     /* borrowed; places_fill draws random numbers from it, and changes the
                           * lists of daughters and `segments` of grown elements */
    FillNode *node;       /* owned */
    size_t n, capacity;
    Grid grid;       /* of all segments; owned */
    int32_t *end;    /* per element: its most distal node so far; NO_NODE: none; owned */
    int32_t *start;  /* per element: the node at which it branches off; NO_NODE: not known yet, the
                      * element is left out, or it is grown; owned */
    uint32_t *stamp; /* per node: number of the last search that found its segment; owned */
    uint32_t searches; /* number of searches so far */
    FillNear *near;    /* the segments that the last search found; owned */
    size_t n_near, near_capacity;
    size_t left_out; /* number of drawn elements of which no segment has a place: their start does
                      * not exist, no direction stays in the domain, or all spare nodes are used.
                      * An element that ends early for such a reason does not count. */
    int32_t last_id; /* the largest id of the tree that is filled */
} Places;

/* Frees what *places owns, also after an error, and zeroes it. */
void places_release(Places *places);

/* Copies the nodes of a tree, whose segments all count as grown. Requires a filling that
 * filling_draw has drawn. Sets `end` and `start` to NO_NODE for every element. The caller then sets
 * `end` of each grown element to its most distal node. Errors: STATUS_MEMORY. */
MUST_CHECK Status places_init(Places *places, const Tree *tree, Err *err);

/* Positions all elements of places->filling, order by order from the highest. Calls
 * params->progress, unless it is NULL, after every 1024 elements. Errors: STATUS_CANCELLED if
 * params->progress returns false; STATUS_MEMORY. *places is then only fit for places_release. */
MUST_CHECK Status places_fill(Places *places, const GrowParams *params, Err *err);

/* Repairs broken segments by moving nodes that are not grown [fill_repair.c]. A drawn segment is
 * broken if it is shorter than wide, or if it overlaps a segment with which it shares no node. Of
 * two drawn segments that overlap, only the later one counts.
 *
 * broken   receives the number of segments that remain broken; undefined after an error.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status places_repair(Places *places, size_t *broken, Err *err);

/* Enters the segment that ends at node i into the grid, or moves it there after one of its ends
 * moved. Does nothing for a root and for a segment of length 0. Errors: STATUS_MEMORY. */
MUST_CHECK Status places_enter(Places *places, int32_t i, Err *err);

/* Sets near[0] to near[n_near - 1] to the segments whose walls may be within `reach` mm of the line
 * from `a` to `b`, each once. Errors: STATUS_MEMORY. */
MUST_CHECK Status places_search(Places *places, Vec3 a, Vec3 b, double reach, Err *err);

#endif
