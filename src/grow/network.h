/* The network: a binary tree of segments, or several such trees (a forest), while it grows.
 *
 * Read cco/law.h first: it defines burden, load, cost, gauge, rho_gamma and S_root. Growth
 * minimizes S_root, the target function without a constant factor. Each segment stores sums over
 * its subtree. The radius of the segment follows from them, and so does the change of S_root when a
 * terminal is added. Neither needs a walk through the whole tree.
 *
 * Every node except an inlet is the distal end of the segment with the same index. The children of
 * an inlet are root segments: one for a tree that is grown, one or two for a tree that is
 * continued. When a segment is split, its distal part keeps its index.
 *
 * A segment has three groups of values. Each function states which groups it needs and which it
 * leaves up to date.
 *
 * - Structure (positions, parents, children, tree, mate, origin, given, piece): always up to date.
 * - Sums (length, terminals, rho_gamma, cost): called exact when they are up to date for all
 *   segments. network_resum computes all sums. network_refresh computes all sums except the
 *   lengths. network_append and a change of weights make sums out of date. network_split updates
 *   only the sums near the new terminal.
 * - Radii (radius, gauge, sensitivity): computed by the last network_refresh or, for a segment that
 *   was made later, when it was made. Each new terminal makes them less accurate, until the next
 *   network_refresh.
 *
 *     network_append(&net, -1, inlet);  network_append(&net, 0, terminal);  network_resum(&net);
 *     network_refresh(&net, threads);   (radii are valid)
 *     network_add_spares(&net, 2);      (split.made[0 .. 1] are the last two spare nodes)
 *     network_split(&net, &split, zone);  net.spares -= 2;  network_add_terminals(&net, 1); */
#ifndef CORCAST_GROW_NETWORK_H
#define CORCAST_GROW_NETWORK_H

#include "base/base.h"
#include "geom/geom.h"
#include "grow/cco/grid.h"
#include "grow/cco/law.h"

/* The values that a walk towards the root reads. They fill one cache line of 64 bytes. */
typedef struct Segment {
    double length;       /* mm */
    double rho_gamma[2]; /* per daughter: its rho_gamma [law.h]; 0 where there is no daughter */
    double cost[2];      /* per daughter: its cost [law.h]; 0 where there is no daughter */
    int32_t child[2];    /* -1: none */
    int32_t parent;      /* -1 at an inlet */
    int32_t terminals;   /* number of terminals at and below the distal end */
    float radius;        /* mm */
    float gauge;         /* [law.h] */
} Segment;

/* Derivatives that give the increase of S_root by a change of one segment, without a walk to the
 * root. */
typedef struct Sensitivity {
    double load;  /* dS_root / d load of the segment [Reduced.load]; its cost is held fixed */
    double extra; /* increase of S_root, to first order, if every segment above this one gets one
                   * more terminal */
} Sensitivity;

/* Further values of a segment (its traits). A network has traits if terminals have unequal flows,
 * viscosities or exponents differ, several trees grow, or a tree is continued. */
typedef struct Trait {
    double weight;  /* burden of the segment per terminal below it: (flow / (terminals * mean flow
                     * of a terminal)) * (viscosity / reference viscosity of radius_scale); computed
                     * by the last weights_update, or when the segment was made */
    double gamma;   /* Murray exponent of the bifurcation at the distal end; as old as the weight */
    double share;   /* of a terminal: its flow, in a unit common to all terminals; 0 elsewhere */
    int32_t mate;   /* of a terminal: the terminal that it is paired with; -1: none */
    int32_t tree;   /* index of the inlet of the segment's tree */
    int32_t origin; /* index of the node in the tree that is continued; -1: a new node */
    bool given;     /* the segment is from the tree that is continued; it must stay straight */
    bool piece;     /* the segment is given, and its vessel has further segments */
} Trait;

/* A trunk: the segments that keep their radii from the tree that is continued (kept segments).
 * Pressure drops along them by Poiseuille's law. A subtree that leaves the trunk has the remaining
 * pressure drop, so its gauge [law.h] is (remaining fraction of the drop)^(-1/4). The kept segments
 * of each tree begin at its inlet and are connected. Arrays are owned. */
typedef struct Trunk {
    double *radius;    /* per segment, mm; 0: not kept, the radius follows the law */
    double *drop_cost; /* per kept segment: derivative of S_root with respect to the fraction of the
                        * pressure drop that occurs along the segment */
    int32_t *order;    /* workspace of trunk_refresh */
} Trunk;

/* All arrays are owned. */
typedef struct Network {
    Law law;             /* where segments have no Trait */
    double radius_scale; /* q N^(1/4) for N terminals, mm^(3/4); constant, because q is proportional
                          * to N^(-1/4) at a constant total flow */
    double radius_unit;  /* q [law.h], mm^(3/4), at the present number of terminals */
    size_t n, capacity;  /* number of nodes, spare nodes included, and its maximum */
    size_t terminals;
    int32_t *inlet; /* nodes that are inlets */
    size_t inlets;
    Segment *segment;
    Sensitivity *sensitivity;
    Trait *trait; /* NULL: all weights are 1, there is one tree, and no segment is given */
    Trunk *trunk; /* NULL: every radius follows the law */
    double new_terminal_weight; /* weight of a new terminal's segment */
    Vec3 *position;             /* mm */
    int32_t *spare;             /* nodes that are part of no tree, for network_split to use */
    size_t spares;
    int32_t *tops; /* workspace of network_refresh */
} Network;

typedef struct NetworkSize {
    size_t capacity; /* maximum number of nodes */
    size_t inlets;   /* maximum number of nodes that are inlets */
    bool has_traits; /* segments have a Trait */
} NetworkSize;

/* Makes an empty network; `law` and `radius_scale` become the members of these names. Release it
 * with network_release. Errors: STATUS_MEMORY. */
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

/* Returns true if segment i is one of several given segments of a vessel. Such a segment may be
 * shorter than wide. */
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
static inline bool network_is_terminal(const Network *net, int32_t i)
{
    return net->segment[i].child[0] < 0 && net->segment[i].parent >= 0;
}

/* Returns the burden [law.h] that segment i has with `terminals` terminals below it. */
static inline double network_burden(const Network *net, int32_t i, int32_t terminals)
{
    return net->trait ? terminals * net->trait[i].weight : terminals;
}

/* Returns the exponents at node i. */
static inline Law network_law(const Network *net, int32_t i)
{
    return net->trait ? (Law){net->trait[i].gamma, net->law.lambda} : net->law;
}

/* Returns the subtree below segment i. Needs the sums of segment i. */
static inline Subtree network_below(const Network *net, int32_t i)
{
    const Segment *segment = &net->segment[i];
    const Law law = network_law(net, i);
    return law_add_daughters(&law, segment->rho_gamma[0] + segment->rho_gamma[1],
                             segment->cost[0] + segment->cost[1]);
}

/* Returns the values of segment i, which include its subtree. Needs the sums of segment i. */
static inline Reduced network_reduce(const Network *net, int32_t i)
{
    const Segment *segment = &net->segment[i];
    const Subtree below = network_below(net, i);
    const Law law = network_law(net, segment->parent);
    return law_add_segment(&law, network_burden(net, i, segment->terminals), segment->length,
                           &below);
}

/* Appends a node that is a child of `parent`, or an inlet if `parent` is -1. The capacity must not
 * be used up. Returns the index of the node. Sums are out of date until network_resum. */
int32_t network_append(Network *net, int32_t parent, Vec3 position);

/* Adds spare nodes until there are at least `nodes` of them. The capacity must suffice. */
void network_add_spares(Network *net, size_t nodes);

/* The connection of a new terminal: `segment` is split at `bifurcation`, and a new segment leads
 * from there to `terminal`. Positions are in mm. */
typedef struct NetworkSplit {
    int32_t segment;
    Vec3 bifurcation, terminal;
    int32_t made[2]; /* two spare nodes: made[0] becomes the proximal part, made[1] the segment to
                      * the terminal */
} NetworkSplit;

/* Splits a segment and connects a terminal. Afterwards the caller must remove the two nodes from
 * the list of spare nodes, and call network_add_terminals.
 *
 * Needs the radii of the segment. Updates the sums of the three segments that meet at the
 * bifurcation, and adds the new terminal to the sums of up to 8 ancestors. It stops before the
 * first ancestor whose distal end is outside `zone`. The sums of all other ancestors include the
 * terminal only after network_refresh; in their large subtrees, one terminal hardly changes the
 * price of a connection.
 *
 * zone     limits the segments that are changed, mm. Both ends of split->segment must be in it.
 * Threads  Threads may split segments at the same time if their zones have no point in common.
 * Cost     O(1). */
void network_split(Network *net, const NetworkSplit *split, Box zone);

/* Adds `terminals` to the number of terminals. All terminals share one total flow, so radius_unit
 * changes. */
void network_add_terminals(Network *net, size_t terminals);

/* Moves the bifurcation `node` to `place`, mm. Requires exact sums, and leaves them exact. Does not
 * change radii. Cost: O(depth). */
void network_move(Network *net, int32_t node, Vec3 place);

/* Returns S_root [law.h], summed over all trees, from the present sums. The result is 0 or not
 * finite if the radii exceed the range of a double. */
double network_cost(const Network *net);

/* Computes the sums of all segments, except the lengths, and then all radii. The result does not
 * depend on the number of threads. Cost: O(n). */
void network_refresh(Network *net, int threads);

/* Frees the arrays that only growth uses. Afterwards network_split, network_add_spares and
 * network_refresh must not be called. */
void network_free_workspace(Network *net);

/* Returns the node after `i` in post-order, in which children come before their parent. `i` is not
 * an inlet. The order of a tree begins with network_first_upward(inlet) and ends with the inlet. */
int32_t network_next_upward(const Network *net, int32_t i);
/* Returns the first node, in post-order, of the subtree whose top is node i. Cost: O(depth). */
int32_t network_first_upward(const Network *net, int32_t i);

/* Computes all sums, lengths included, from positions and weights, and counts the terminals. Does
 * not change radii. Cost: O(n). */
void network_resum(Network *net);

/* Renumbers the nodes depth first, tree after tree: parents come before children, and neighbours in
 * the tree are neighbours in memory. Removes the spare nodes. Keeps sums and radii. The caller must
 * rebuild data that holds indices of nodes, such as a grid.
 *
 * Errors   STATUS_MEMORY; `net` is then only fit for network_release.
 * Cost     O(n). */
MUST_CHECK Status network_reorder(Network *net, Err *err);

/* ---- the trunk ---- */

/* The largest fraction of the pressure drop that may occur along a trunk. The rest remains for the
 * subtrees that leave the trunk. A subtree with a thousandth of the pressure drop has radii 5.6
 * times as large as with all of it. */
#define TRUNK_MOST_SPENT 0.999

/* Returns the fraction of the whole pressure drop that occurs along a part of the kept segment i.
 * `part`, in [0, 1], is the length of this part divided by the segment's length; the part begins at
 * the proximal end. `terminals` is the number of terminals below the segment. Needs the segment's
 * length. */
static inline double trunk_drop_fraction(const Network *net, int32_t i, int32_t terminals,
                                         double part)
{
    double unit = net->radius_unit / net->trunk->radius[i], unit2 = unit * unit;
    return unit2 * unit2 * network_burden(net, i, terminals) * net->segment[i].length * part;
}

/* Returns the gauge of the daughters of a kept segment. `gauge` is the segment's own gauge, and
 * `spent` is the fraction of the pressure drop that occurs along the segment. At least 1 -
 * TRUNK_MOST_SPENT of the drop is always assumed to remain. */
double trunk_gauge(double gauge, double spent);

/* Sets gauge, radius and sensitivity of segment i, a daughter of the kept segment `parent`.
 * `reduced` has the values of segment i. Called by network_refresh and network_split. */
void trunk_set_daughter(Network *net, int32_t i, const Reduced *reduced, int32_t parent);

/* Updates gauge and drop_cost of all kept segments. Called by network_refresh. Requires exact sums.
 * Cost: O(kept segments). */
void trunk_refresh(Network *net);

/* Returns the largest fraction of the pressure drop that occurs on a path from an inlet to the end
 * of a kept segment; 0 if no segment is kept. *where receives this segment; it is unchanged if no
 * segment is kept. `spent` is a workspace of one number per node. Nodes must be in depth-first
 * order. */
double trunk_most_spent(const Network *net, double *spent, size_t *where);

#endif
