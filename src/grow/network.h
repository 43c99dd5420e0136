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

typedef struct Network {
    Law law;
    double radius_scale; /* q N^(1/4), mm^(3/4): r = radius_scale / N^(1/4) * gauge * rho */
    size_t n, capacity;  /* nodes */
    Segment *segment;
    Sensitivity *sensitivity;
    Vec3 *position; /* mm */
} Network;

/* An inlet with room for `terminals`. */
MUST_CHECK Status network_init(Network *net, Law law, double radius_scale, size_t terminals,
                               Vec3 inlet, Err *err);
void network_release(Network *net);

static inline size_t network_terminals(const Network *net)
{
    return net->n / 2;
}

/* q: radius = q * gauge * rho. */
double network_radius_unit(const Network *net);

/* Segment i with what hangs on it. */
static inline Reduced network_reduce(const Network *net, int32_t i)
{
    const Segment *segment = &net->segment[i];
    return law_reduce(&net->law, segment->terminals, segment->length,
                      segment->flare[0] + segment->flare[1], segment->cost[0] + segment->cost[1]);
}

static inline Capsule network_capsule(const Network *net, int32_t i)
{
    const Segment *segment = &net->segment[i];
    return (Capsule){net->position[segment->parent], net->position[i], (double)segment->radius};
}

/* The first segment, from the inlet to `terminal`. */
void network_plant(Network *net, Vec3 terminal);

/* Splits `segment` at `bifurcation` and hangs a new segment to `terminal` there. Its proximal part
 * becomes segment n and the new one segment n + 1, n as it was before. */
void network_split(Network *net, int32_t segment, Vec3 bifurcation, Vec3 terminal);

/* S_root; not finite, or 0, when the radii of the tree span more than a double can hold. */
double network_cost(const Network *net);

/* Brings radius, gauge and sensitivities of all segments up to date. */
void network_refresh(Network *net);

/* Sums up lengths, flares and costs anew from the positions; parents come before children. */
void network_resum(Network *net);

/* Renumbers the nodes depth first, so that parents come before children and neighbours in the tree
 * are neighbours in memory. On failure `net` is only fit for network_release. */
MUST_CHECK Status network_reorder(Network *net, Err *err);

#endif
