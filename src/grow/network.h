/* The network: the binary tree of segments while it grows, or several such trees (a forest).
 *
 * Each segment stores sums over its subtree, from which its radius follows [cco/law.h]. The
 * sums also give the change of the target when a terminal is added, without a walk through the
 * whole tree.
 *
 * Every node except an inlet is the distal end of the segment with the same index. The children of
 * an inlet are root segments: one for a tree that is grown, one or two for a tree that is
 * continued. When a segment is split, its distal part keeps its index.
 *
 * A segment has three groups of values. Each function states which values it needs and which it
 * leaves valid.
 *
 * - Structure (positions, parents, children, tree, mate, origin, given, piece): always valid.
 * - Sums (length, terminals, rho_gamma, cost): exact after network_resum, which computes all of
 *   them, and after network_refresh, which computes all except the lengths. They are out of date
 *   after network_append and after a change of weights. network_split updates some of them.
 * - Radii (radius, gauge, sensitivity): those of the last network_refresh or, for a later segment,
 *   those from when the segment was made. They grow out of date as terminals are added, until the
 *   next network_refresh.
 *
 *     network_append(&net, -1, inlet);  network_append(&net, 0, terminal);  network_resum(&net);
 *     network_refresh(&net, threads);   (radii are valid)
 *     network_split(&net, &split, zone);  network_grown(&net, 1);   (connects one terminal) */
#ifndef CORCAST_GROW_NETWORK_H
#define CORCAST_GROW_NETWORK_H

#include "base/base.h"
#include "geom/geom.h"
#include "grow/cco/grid.h"
#include "grow/cco/law.h"

/* What the walk towards the root reads of one segment, in one cache line of 64 bytes. */
typedef struct Segment {
    double length;       /* mm */
    double rho_gamma[2]; /* of the daughters [law.h]; 0 where there is no daughter */
    double cost[2];      /* of the daughters; 0 where there is no daughter */
    int32_t child[2];    /* -1: none */
    int32_t parent;      /* -1 at the inlet */
    int32_t terminals;   /* at and below the segment's end */
    float radius;        /* mm */
    float gauge;         /* [law.h] */
} Segment;

/* The derivatives that price a change of one segment without a walk to the root. */
typedef struct Sensitivity {
    double load;  /* dS_root / d load of the segment, its own cost held fixed */
    double extra; /* increase of S_root if every segment above this one had one more terminal */
} Sensitivity;

/* What segments need in addition where terminals are unequal, viscosities or exponents differ,
 * several trees grow, or a tree is continued. */
typedef struct Trait {
    double weight; /* flow through the segment, divided by the flow of as many mean terminals, times
                    * its viscosity, divided by the viscosity in radius_scale; from the last
                    * weights_update, or from when the segment was made */
    double gamma;  /* Murray exponent of the fork at the distal end; as old as the weight */
    double share;  /* of a terminal: its flow relative to the other terminals'; 0 elsewhere */
    int32_t mate;  /* of a terminal: the terminal it is paired with; -1: none */
    int32_t tree;  /* index of the inlet of the segment's tree */
    int32_t origin; /* index of the node in the tree that is continued; -1: a new node */
    bool given;     /* a segment of the tree that is continued, which stays straight */
    bool piece;     /* a given segment that makes up a vessel together with others */
} Trait;

/* A trunk: the segments that keep the radii they had in the tree that is continued. Pressure drops
 * along them by Poiseuille's law. A subtree that leaves the trunk has the rest of the pressure
 * drop, so its gauge [law.h] is (share of the drop that is left)^(-1/4). A trunk begins at an inlet
 * and is connected. Arrays are owned. */
typedef struct Trunk {
    double *radius; /* per segment, mm; 0: the radius follows the law */
    double *stake;  /* per kept segment: derivative of S_root with respect to the share of the
                     * pressure drop that is spent on the segment */
    int32_t *order; /* workspace of trunk_refresh */
} Trunk;

/* All arrays are owned. */
typedef struct Network {
    Law law;             /* where segments have no Trait */
    double radius_scale; /* q N^(1/4), mm^(3/4), the same for any number N of terminals */
    double radius_unit;  /* q, mm^(3/4), for the present number: r = q * gauge * rho [law.h] */
    size_t n, capacity;  /* nodes, spare nodes included */
    size_t terminals;
    int32_t *inlet; /* nodes */
    size_t inlets;
    Segment *segment;
    Sensitivity *sensitivity;
    Trait *trait;        /* NULL: all weights are 1, there is one tree, and no segment is given */
    Trunk *trunk;        /* NULL: every radius follows the law */
    double fresh_weight; /* weight of a new terminal's segment */
    Vec3 *position;      /* mm */
    int32_t *spare;      /* nodes that are part of no tree, for network_split to use */
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
/* Frees all arrays and zeroes *net. */
void network_release(Network *net);
/* Adds a trunk whose radii are all 0; the caller sets them. Errors: STATUS_MEMORY. */
MUST_CHECK Status network_add_trunk(Network *net, Err *err);

/* Returns the index of the tree that segment i belongs to. */
static inline int32_t network_tree(const Network *net, int32_t i)
{
    return net->trait ? net->trait[i].tree : 0;
}

/* Returns true if segment i must stay straight. */
static inline bool network_is_given(const Network *net, int32_t i)
{
    return net->trait && net->trait[i].given;
}

/* Returns true if segment i is a piece of a vessel. A piece may be shorter than wide. */
static inline bool network_is_piece(const Network *net, int32_t i)
{
    return net->trait && net->trait[i].piece;
}

/* Returns the radius, mm, that segment i keeps; 0: its radius follows the law. */
static inline double network_kept_radius(const Network *net, int32_t i)
{
    return net->trunk ? net->trunk->radius[i] : 0;
}

/* Returns the terminal that terminal i is paired with; -1: none. */
static inline int32_t network_mate(const Network *net, int32_t i)
{
    return net->trait ? net->trait[i].mate : -1;
}

/* Pairs two terminals of a network with traits. */
static inline void network_pair(Network *net, int32_t i, int32_t j)
{
    net->trait[i].mate = j;
    net->trait[j].mate = i;
}

/* Returns true if node i is a terminal. */
static inline bool network_is_end(const Network *net, int32_t i)
{
    return net->segment[i].child[0] < 0 && net->segment[i].parent >= 0;
}

/* Returns the burden of segment i [law.h] if it carried the flow of `terminals` terminals. */
static inline double network_burden(const Network *net, int32_t i, int32_t terminals)
{
    return net->trait ? terminals * net->trait[i].weight : terminals;
}

/* Returns the law at node i. */
static inline Law network_law(const Network *net, int32_t i)
{
    return net->trait ? (Law){net->trait[i].gamma, net->law.lambda} : net->law;
}

/* Returns the subtree below segment i. Needs its sums. */
static inline Below network_below(const Network *net, int32_t i)
{
    const Segment *segment = &net->segment[i];
    const Law law = network_law(net, i);
    return law_gather(&law, segment->rho_gamma[0] + segment->rho_gamma[1],
                      segment->cost[0] + segment->cost[1]);
}

/* Returns segment i together with the subtree below it. Needs its sums. */
static inline Reduced network_reduce(const Network *net, int32_t i)
{
    const Segment *segment = &net->segment[i];
    const Below below = network_below(net, i);
    const Law law = network_law(net, segment->parent);
    return law_extend(&law, network_burden(net, i, segment->terminals), segment->length, &below);
}

/* Appends a node that is a child of `parent`, or an inlet if `parent` is -1. There must be capacity
 * for it. Returns its index. Sums are out of date until network_resum. */
int32_t network_append(Network *net, int32_t parent, Vec3 position);

/* Adds spare nodes until there are at least `nodes`. There must be capacity for them. */
void network_spare(Network *net, size_t nodes);

/* The connection of a new terminal: `segment` is split at `bifurcation`, and a new segment leads
 * from there to `terminal`. Positions are in mm. */
typedef struct NetworkSplit {
    int32_t segment;
    Vec3 bifurcation, terminal;
    int32_t made[2]; /* two spare nodes: the proximal part becomes segment made[0], the new segment
                      * made[1] */
} NetworkSplit;

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
void network_split(Network *net, const NetworkSplit *split, Box zone);

/* Adds to the number of terminals. They share the same flow, so radius_unit changes. */
void network_grown(Network *net, size_t terminals);

/* Moves the bifurcation `node` to `place`, mm. Updates the sums of the three segments that meet
 * there and of all segments above, exactly. Requires exact sums; leaves radii as they are. Cost:
 * O(depth). */
void network_move(Network *net, int32_t node, Vec3 place);

/* Returns S_root [law.h], summed over all trees; 0 or not finite if the radii span more than a
 * double can hold. The result is as exact as the sums. */
double network_cost(const Network *net);

/* Updates the sums of all segments, except lengths; then their radii, gauges and sensitivities. The
 * result does not depend on the number of threads. Cost: O(n). */
void network_refresh(Network *net, int threads);

/* Frees what only growth needs. From here on, network_split, network_spare and network_refresh must
 * not be called. */
void network_retire(Network *net);

/* Returns the node after `i` in post-order (daughters before their mother). The order begins with
 * network_first_upward of an inlet and ends with that inlet. */
int32_t network_next_upward(const Network *net, int32_t i);
/* Returns the first node in post-order of `i` and all nodes below it. Cost: O(depth). */
int32_t network_first_upward(const Network *net, int32_t i);

/* Computes all sums, lengths included, from positions and weights, and counts the terminals. Leaves
 * radii as they are. Cost: O(n). */
void network_resum(Network *net);

/* Renumbers the nodes depth first, tree after tree: parents come before children, and neighbours in
 * the tree are neighbours in memory. Drops the spare nodes. Keeps sums and radii. What holds
 * indices of nodes, such as a grid, must be made again.
 *
 * Errors   STATUS_MEMORY; `net` is then only fit for network_release.
 * Cost     O(n). */
MUST_CHECK Status network_reorder(Network *net, Err *err);

/* ---- the trunk ---- */

/* The greatest share of the drop of pressure that may be spent along a trunk. */
#define TRUNK_MOST_SPENT 0.999

/* Returns the share of the whole drop of pressure that is spent along the first `part`, in [0, 1],
 * of the kept segment i if it carries the flow of `terminals` terminals. Needs its length. */
static inline double trunk_spent(const Network *net, int32_t i, int32_t terminals, double part)
{
    double unit = net->radius_unit / net->trunk->radius[i], unit2 = unit * unit;
    return unit2 * unit2 * network_burden(net, i, terminals) * net->segment[i].length * part;
}

/* Returns the gauge below a segment of gauge `gauge` on which a share `spent` of the drop is spent.
 * While a tree grows, what is spent counts as TRUNK_MOST_SPENT at most. */
double trunk_gauge(double gauge, double spent);

/* Computes gauge, radius and sensitivity of segment i, which sums up to `reduced`, from those of
 * the kept segment `parent`. Part of network_refresh and network_split. */
void trunk_set_daughter(Network *net, int32_t i, const Reduced *reduced, int32_t parent);

/* Updates gauges and stakes of all kept segments. Part of network_refresh. Requires exact sums.
 * Cost: O(kept segments). */
void trunk_refresh(Network *net);

/* Returns the largest share of the pressure drop that is spent on the path from an inlet to the end
 * of a kept segment; 0 if there is none. *where receives that segment; unchanged if there is none.
 * `spent` is a workspace of one number per node. Nodes must be in depth-first order. */
double trunk_most_spent(const Network *net, double *spent, size_t *where);

#endif
