/* The growing tree, or forest: binary trees of segments, each with the sums over its subtree from
 * which its radius follows [law.h].
 *
 * Every node but an inlet is the distal end of the segment of the same index. The children of an
 * inlet are root segments: one for a tree that is grown, one or two for a tree that is continued. A
 * segment that is split keeps its index as the distal part.
 *
 * Functions change three kinds of values, and say which they need and which they leave:
 * - the structure (positions, parents, children, tree, origin, given, piece) is always right;
 * - the sums (length, terminals, rho_gamma, cost) are exact after network_resum, which computes all
 *   of them, and after network_refresh, which computes all but the lengths. network_append leaves
 *   them out of date, network_split updates some of them, and so do changes of weights;
 * - the radii (radius, gauge, sensitivity) are those of the last network_refresh, or of when the
 *   segment was made. They age while terminals are added, until the next refresh. */
#ifndef CORCAST_GROW_NETWORK_H
#define CORCAST_GROW_NETWORK_H

#include "base/base.h"
#include "geom/geom.h"
#include "grow/cco/grid.h"
#include "grow/cco/law.h"

/* What the walk towards the root reads of one segment, in one cache line of 64 bytes. */
typedef struct Segment {
    double length;       /* mm */
    double rho_gamma[2]; /* of the daughters [law.h]; 0 where there is none */
    double cost[2];      /* likewise */
    int32_t child[2];    /* -1: none */
    int32_t parent;      /* -1 at the inlet */
    int32_t terminals;
    float radius; /* mm */
    float gauge;  /* [law.h] */
} Segment;

/* The derivatives that price a change of one segment without a walk to the root. */
typedef struct Sensitivity {
    double load;  /* dS_root / d load of the segment, its own cost held fixed */
    double extra; /* the increase of S_root if every segment above this one had one more terminal */
} Sensitivity;

/* What segments need in addition where terminals are unequal, viscosities or exponents differ,
 * several trees grow, or a tree is continued. */
typedef struct Trait {
    /* The flow through the segment relative to that of as many mean terminals, times its viscosity
     * relative to that in radius_scale; of the last weights_update, or of when it was made. */
    double weight;
    double gamma;   /* of the fork at the distal end, likewise */
    double share;   /* of a terminal: its flow relative to the other terminals'; 0 elsewhere */
    int32_t mate;   /* of a terminal: the one it is paired with; -1: none */
    int32_t tree;   /* the index of the inlet that it hangs on */
    int32_t origin; /* the node's index in the tree that is continued; -1: a new node */
    bool given;     /* a segment of that tree, which stays straight */
    bool piece;     /* a given one that makes up a vessel together with others */
} Trait;

/* Segments that keep the radius they had, whatever flows through them [trunk.h]. */
typedef struct Trunk {
    double *radius; /* by segment, mm; 0: it follows the law */
    double *stake;  /* by kept segment: dS_root / d share of the drop of pressure spent on it */
    int32_t *order; /* workspace of trunk_refresh */
} Trunk;

typedef struct Network {
    Law law;             /* where segments have no Trait */
    double radius_scale; /* q N^(1/4), mm^(3/4), the same for any number N of terminals */
    double radius_unit;  /* q, mm^(3/4), for the present number: r = q * gauge * rho [law.h] */
    size_t n, capacity;  /* nodes, spare ones included; and how many there is room for */
    size_t terminals;
    int32_t *inlet; /* nodes */
    size_t inlets;
    Segment *segment;
    Sensitivity *sensitivity;
    Trait *trait;        /* NULL: all weights are 1, there is one tree, and no segment is given */
    Trunk *trunk;        /* NULL: every radius follows the law */
    double fresh_weight; /* the weight that a new terminal's segment gets */
    Vec3 *position;      /* mm */
    int32_t *spare;      /* nodes that are part of no tree, to be used by network_split */
    size_t spares;
    int32_t *tops; /* workspace of network_refresh */
} Network;

typedef struct NetworkSize {
    size_t capacity; /* maximum number of nodes */
    size_t inlets;   /* maximum number of nodes that are inlets */
    bool has_traits; /* segments have a Trait */
} NetworkSize;

/* Makes an empty network. Release it with network_release. Errors: STATUS_MEMORY. */
MUST_CHECK Status network_init(Network *net, Law law, double radius_scale, NetworkSize size,
                               Err *err);
void network_release(Network *net);
/* Has segments keep radii, which the caller then sets: all are 0. STATUS_MEMORY. */
MUST_CHECK Status network_add_trunk(Network *net, Err *err);

/* The index of the tree that segment i belongs to. */
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

/* The radius, mm, that segment i keeps; 0: it has the one that follows. */
static inline double network_kept_radius(const Network *net, int32_t i)
{
    return net->trunk ? net->trunk->radius[i] : 0;
}

/* The terminal that terminal i is paired with; -1: none. */
static inline int32_t network_mate(const Network *net, int32_t i)
{
    return net->trait ? net->trait[i].mate : -1;
}

/* Makes a pair of two terminals of a network with traits. */
static inline void network_pair(Network *net, int32_t i, int32_t j)
{
    net->trait[i].mate = j;
    net->trait[j].mate = i;
}

/* Whether node i is a terminal. */
static inline bool network_is_end(const Network *net, int32_t i)
{
    return net->segment[i].child[0] < 0 && net->segment[i].parent >= 0;
}

/* The burden of segment i [law.h] if it carried the flow of `terminals` terminals. */
static inline double network_burden(const Network *net, int32_t i, int32_t terminals)
{
    return net->trait ? terminals * net->trait[i].weight : terminals;
}

/* The law at node i. */
static inline Law network_law(const Network *net, int32_t i)
{
    return net->trait ? (Law){net->trait[i].gamma, net->law.lambda} : net->law;
}

/* What hangs on the distal end of segment i. Needs its sums. */
static inline Below network_below(const Network *net, int32_t i)
{
    const Segment *segment = &net->segment[i];
    const Law law = network_law(net, i);
    return law_gather(&law, segment->rho_gamma[0] + segment->rho_gamma[1],
                      segment->cost[0] + segment->cost[1]);
}

/* Segment i together with what hangs on it. Needs its sums. */
static inline Reduced network_reduce(const Network *net, int32_t i)
{
    const Segment *segment = &net->segment[i];
    const Below below = network_below(net, i);
    const Law law = network_law(net, segment->parent);
    return law_extend(&law, network_burden(net, i, segment->terminals), segment->length, &below);
}

/* Segment i as a solid. Needs its radius. */
static inline Capsule network_capsule(const Network *net, int32_t i)
{
    const Segment *segment = &net->segment[i];
    return (Capsule){net->position[segment->parent], net->position[i], (double)segment->radius};
}

/* Appends a node that hangs on `parent`, or an inlet if that is -1, and returns its index. Sums are
 * out of date until network_resum. */
int32_t network_append(Network *net, int32_t parent, Vec3 position);

/* Adds spare nodes until there are at least `nodes`. */
void network_spare(Network *net, size_t nodes);

/* The connection of a new terminal: `segment` is split at `bifurcation`, and a new segment leads
 * from there to `terminal`. Positions are in mm. */
typedef struct Split {
    int32_t segment;
    Vec3 bifurcation, terminal;
    int32_t made[2]; /* two spare nodes: the proximal part becomes segment made[0], the new segment
                      * made[1] */
} Split;

/* Splits a segment. Then the caller must remove the two nodes from the list of spare nodes, and
 * call network_grown.
 *
 * Needs the segment's radii and sensitivities of the last refresh. Leaves the sums of the three
 * segments right. Adds the new terminal to the sums of the nearest 8 ancestors (LEVELS), up to the
 * first ancestor whose distal end is outside `zone`; further up, the sums do not include it until
 * network_refresh.
 *
 * Threads  Threads may split at the same time if their zones have no point in common and both ends
 *          of each one's segment are in its own zone.
 * Cost     O(1). */
void network_split(Network *net, const Split *split, Box zone);

/* Adds to the number of terminals, which share the same flow: changes radius_unit. */
void network_grown(Network *net, size_t terminals);

/* Moves the bifurcation `node`, and brings the sums of the three segments that meet there and of
 * all above up to date, exactly. Needs right sums; leaves radii as they are. O(depth). */
void network_move(Network *net, int32_t node, Vec3 place);

/* S_root [law.h], the sum over all trees. Not finite, or 0, when radii span more than a double can
 * hold. Needs right sums, or is of the last refresh. */
double network_cost(const Network *net);

/* Brings the sums of all segments but lengths up to date, then their radii, gauges and
 * sensitivities. O(n). The result is the same for any number of threads. */
void network_refresh(Network *net, int threads);

/* Frees what only growth needs: network_split, network_spare and network_refresh must not be called
 * from here on. */
void network_retire(Network *net);

/* The node after `i` in post-order (daughters before their mother), which begins with
 * network_first_upward of an inlet and ends with that inlet. */
int32_t network_next_upward(const Network *net, int32_t i);
/* The first of `i` and all below it in post-order. O(depth). */
int32_t network_first_upward(const Network *net, int32_t i);

/* Computes all sums anew, lengths included, from positions and weights; counts the terminals.
 * Leaves radii as they are. O(n). */
void network_resum(Network *net);

/* Renumbers the nodes depth first, tree after tree, so that parents come before children and
 * neighbours in the tree are neighbours in memory; drops the spare nodes. Keeps sums and radii;
 * what holds indices of nodes (a grid) must be made anew. O(n). On failure, STATUS_MEMORY, `net` is
 * only fit for network_release. */
MUST_CHECK Status network_reorder(Network *net, Err *err);

#endif
