/* The growing tree, or forest: binary trees of segments that know their own hydrodynamics at every
 * moment.
 *
 * Every node but an inlet is the distal end of the segment of its index; what hangs on an inlet are
 * root segments, one where the tree is grown. Segments are split in place: the one that is split
 * keeps its index as the distal part. */
#ifndef CORCAST_GROW_NETWORK_H
#define CORCAST_GROW_NETWORK_H

#include "base/base.h"
#include "geom/geom.h"
#include "grow/cco/grid.h"
#include "grow/cco/law.h"

/* What the walk towards the root needs of one segment, in one cache line. */
typedef struct Segment {
    double length;       /* mm */
    double rho_gamma[2]; /* of the daughters; 0 where there is none */
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

/* What sets segments apart where terminals are unequal, viscosities differ, or several trees
 * grow. */
typedef struct Trait {
    /* The segment's flow over that of as many mean terminals, times its viscosity over that of
     * radius_scale; as of the last refresh, or of its making. */
    double weight;
    double share;   /* of a terminal: of the flow, relative to the others'; 0 elsewhere */
    int32_t tree;   /* which of the inlets it hangs on */
    int32_t origin; /* the node's index in the tree that growth started from; -1: none */
    bool given;     /* on a segment of that tree, which stays straight */
    bool piece;     /* on one of several that make up a vessel of that tree; given, too */
} Trait;

typedef struct Network {
    Law law;
    double radius_scale; /* q N^(1/4), mm^(3/4) */
    double radius_unit;  /* q, mm^(3/4): r = q * gauge * rho */
    size_t n, capacity;  /* nodes, spare ones included */
    size_t terminals;
    int32_t *inlet; /* nodes */
    size_t inlets;
    Segment *segment;
    Sensitivity *sensitivity;
    Trait *trait;        /* NULL: all weights are 1, there is one tree, and nothing is given */
    double fresh_weight; /* of a new terminal's segment */
    Vec3 *position;      /* mm */
    int32_t *spare;      /* nodes that are part of no tree */
    size_t spares;
    int32_t *tops; /* workspace */
} Network;

/* Room for so many nodes, of them so many inlets; `traits`: whether segments have them. */
MUST_CHECK Status network_init(Network *net, Law law, double radius_scale, size_t capacity,
                               size_t inlets, bool traits, Err *err);
void network_release(Network *net);

/* The tree that segment i is of. */
static inline int32_t network_tree(const Network *net, int32_t i)
{
    return net->trait ? net->trait[i].tree : 0;
}

/* Whether segment i must stay straight. */
static inline bool network_is_given(const Network *net, int32_t i)
{
    return net->trait && net->trait[i].given;
}

/* Whether segment i is a piece of a vessel, which may be shorter than wide. */
static inline bool network_is_piece(const Network *net, int32_t i)
{
    return net->trait && net->trait[i].piece;
}

/* Whether node i is a terminal. */
static inline bool network_is_end(const Network *net, int32_t i)
{
    return net->segment[i].child[0] < 0 && net->segment[i].parent >= 0;
}

/* What `terminals` more on segment i add to its load, over its length. */
static inline double network_burden(const Network *net, int32_t i, int32_t terminals)
{
    return net->trait ? terminals * net->trait[i].weight : terminals;
}

/* What hangs on segment i. */
static inline Below network_below(const Network *net, int32_t i)
{
    const Segment *segment = &net->segment[i];
    return law_gather(&net->law, segment->rho_gamma[0] + segment->rho_gamma[1],
                      segment->cost[0] + segment->cost[1]);
}

/* Segment i with what hangs on it. */
static inline Reduced network_reduce(const Network *net, int32_t i)
{
    const Segment *segment = &net->segment[i];
    const Below below = network_below(net, i);
    return law_extend(&net->law, network_burden(net, i, segment->terminals), segment->length,
                      &below);
}

static inline Capsule network_capsule(const Network *net, int32_t i)
{
    const Segment *segment = &net->segment[i];
    return (Capsule){net->position[segment->parent], net->position[i], (double)segment->radius};
}

/* Appends a node that hangs on `parent`, or for -1 an inlet, and returns it. All sums are due. */
int32_t network_append(Network *net, int32_t parent, Vec3 position);

/* Sees to it that at least so many nodes are spare. */
void network_spare(Network *net, size_t nodes);

/* Splits `segment` at `bifurcation` and hangs a new segment to `terminal` there. Its proximal part
 * becomes segment made[0] and the new one made[1], which are spare. What is above learns of it for
 * a few levels, while distal ends are in `zone`, all from network_refresh. The caller takes the two
 * off the spare nodes and tells network_grown. Threads may split at a time in zones without common
 * points, segments whose ends are in their own. */
void network_split(Network *net, int32_t segment, Vec3 bifurcation, Vec3 terminal,
                   const int32_t made[2], Box zone);

/* Tells that so many terminals were added: radii from here on are those for as many more. */
void network_grown(Network *net, size_t terminals);

/* Moves a bifurcation, and brings all sums up to date. */
void network_move(Network *net, int32_t node, Vec3 place);

/* S_root, over all trees; not finite, or 0, when radii span more than a double can hold. */
double network_cost(const Network *net);

/* Brings the sums of all segments up to date, and radii, gauges and sensitivities. */
void network_refresh(Network *net, int threads);

/* Frees what only growth needs: no more splits and refreshing from here on. */
void network_retire(Network *net);

/* The node after `i` in the order in which daughters come before their mother, which begins with
 * network_first_upward of the inlet and ends with the inlet. */
int32_t network_next_upward(const Network *net, int32_t i);
/* The first of `i` and all below it in that order. */
int32_t network_first_upward(const Network *net, int32_t i);

/* Sums up lengths, terminals, flares and costs anew from positions and weights. */
void network_resum(Network *net);

/* Renumbers the nodes depth first, tree after tree, so that parents come before children and
 * neighbours in the tree are neighbours in memory, and none is spare. On failure `net` is only fit
 * for network_release. */
MUST_CHECK Status network_reorder(Network *net, Err *err);

#endif
