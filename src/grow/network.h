/* The growing tree: a binary tree of segments that knows its own hydrodynamics at every moment.
 *
 * Node i > 0 is the distal end of segment i; node 0 is the inlet, its only child the root segment.
 * Segments are split in place: the one that is split keeps its index as the distal part. */
#ifndef CORCAST_GROW_NETWORK_H
#define CORCAST_GROW_NETWORK_H

#include "base/base.h"
#include "geom/geom.h"
#include "grow/grid.h"
#include "grow/law.h"

/* What the walk towards the root needs of one segment, in one cache line. */
typedef struct Segment {
    double length;   /* mm */
    double flare[2]; /* of the daughters; 0 where there is none */
    double cost[2];
    int32_t child[2]; /* -1: none */
    int32_t parent;   /* -1 at the inlet */
    int32_t terminals;
    float radius; /* mm; as of the last refresh, or of the segment's making */
    float gauge;  /* likewise */
} Segment;

/* What pricing a change needs of one segment; as of the last refresh, or of its making. */
typedef struct Sensitivity {
    double load;  /* dS_root / d load, the segment's cost held */
    double extra; /* dS_root for one more terminal on every segment above this one */
} Sensitivity;

/* What a node waits for while changes are carried towards the root. */
typedef struct Arrivals Arrivals;

typedef struct Network {
    Law law;
    double radius_scale; /* q N^(1/4), mm^(3/4) */
    double radius_unit;  /* q, mm^(3/4): r = q * gauge * rho */
    size_t n, capacity;  /* nodes */
    Segment *segment;
    Sensitivity *sensitivity;
    Vec3 *position;   /* mm */
    Arrivals *coming; /* at rest between calls */
} Network;

/* An inlet with room for `terminals`. */
MUST_CHECK Status network_init(Network *net, Law law, double radius_scale, size_t terminals,
                               Vec3 inlet, Err *err);
void network_release(Network *net);

static inline size_t network_terminals(const Network *net)
{
    return net->n / 2;
}

/* What hangs on segment i. */
static inline Below network_below(const Network *net, int32_t i)
{
    const Segment *segment = &net->segment[i];
    return law_gather(&net->law, segment->flare[0] + segment->flare[1],
                      segment->cost[0] + segment->cost[1]);
}

/* Segment i with what hangs on it. */
static inline Reduced network_reduce(const Network *net, int32_t i)
{
    const Segment *segment = &net->segment[i];
    const Below below = network_below(net, i);
    return law_extend(&net->law, segment->terminals, segment->length, &below);
}

static inline Capsule network_capsule(const Network *net, int32_t i)
{
    const Segment *segment = &net->segment[i];
    return (Capsule){net->position[segment->parent], net->position[i], (double)segment->radius};
}

/* The first segment, from the inlet to `terminal`. */
void network_plant(Network *net, Vec3 terminal);

/* Makes room for so many splits. The radii of what they make are those for as many more terminals. */
void network_extend(Network *net, size_t splits);

/* Splits `segment` at `bifurcation` and hangs a new segment to `terminal` there. Its proximal part
 * becomes segment `fresh` - 1 and the new one `fresh`, both among those that network_extend made.
 * What is above does not know of it until network_carry. Threads may split at a time segments that
 * have no node in common. */
void network_split(Network *net, int32_t segment, Vec3 bifurcation, Vec3 terminal, int32_t fresh);

/* Carries all splits since network_extend up to the inlet, on `threads` threads. */
void network_carry(Network *net, size_t splits, int threads);

/* Moves a bifurcation, and brings all sums up to date. */
void network_move(Network *net, int32_t node, Vec3 place);

/* S_root; not finite, or 0, when the radii of the tree span more than a double can hold. */
double network_cost(const Network *net);

/* Brings radius, gauge and sensitivities of all segments up to date. */
void network_refresh(Network *net, int threads);

/* Frees what only growth needs: no more splits and refreshing from here on. */
void network_retire(Network *net);

/* Sums up lengths, flares and costs anew from the positions; parents come before children. */
void network_resum(Network *net);

/* Renumbers the nodes depth first, so that parents come before children and neighbours in the tree
 * are neighbours in memory. On failure `net` is only fit for network_release. */
MUST_CHECK Status network_reorder(Network *net, Err *err);

#endif
