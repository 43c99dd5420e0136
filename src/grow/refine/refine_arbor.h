/* The arbor: a tree during refinement. Read law.h first: it defines S_root, the cost of the tree
 * that refinement lowers, and load, rho_gamma, gauge and q, from which radii follow (radius = q *
 * gauge * load^(1/4)). Each segment stores sums over its subtree.
 *
 * arbor_begin starts a move. A move is arbor_move_node, or arbor_prune followed by arbor_graft. All
 * sums are exact after arbor_move_node and after arbor_graft; between arbor_prune and arbor_graft
 * some sums are out of date. arbor_undo takes the move back.
 *
 * Growth uses another struct for a tree, Network [network.h]. Both structs apply the same law of
 * radii [law.h], but they store different sums per segment. The sums of each struct fill one cache
 * line. A common struct would fill two, and so double the cost of a walk to the root.
 *
 * The first nodes are the inlets, each with one or two root segments. Every other node is the
 * distal end of the segment with the same index, and has no child or two children. Nodes of the
 * Tree with one child are left out, so that a vessel of several segments becomes one straight
 * segment. A bifurcation keeps its index when it is moved, and when it is grafted to another
 * segment.
 *
 *     TRY(arbor_init(&arbor, &tree, err));
 *     arbor_begin(&arbor);  arbor_move_node(&arbor, i, place);       (one move)
 *     if (!(arbor_cost(&arbor) < before))
 *         arbor_undo(&arbor);
 *     arbor_release(&arbor); */
#ifndef CORCAST_GROW_REFINE_REFINE_ARBOR_H
#define CORCAST_GROW_REFINE_REFINE_ARBOR_H

#include "base/base.h"
#include "geom/geom.h"
#include "grow/cco/law.h"
#include "grow/grow.h"
#include "tree/tree.h"

/* The values of a segment that a walk to the root reads. They fill one cache line of 64 bytes.
 *
 * The radius of a segment is allowed if radius * inverse_limit is at most 1. `utilisation` is the
 * maximum of radius * inverse_limit over the segment and all segments below it, divided by q and by
 * the gauge of this segment. All these radii are proportional to q and to the gauge; `utilisation`
 * therefore depends only on the segment and its subtree. The gauge of a root segment is 1. All
 * radii of a tree are therefore allowed if q * utilisation is at most 1 at its root segments. */
typedef struct Branch {
    double length;          /* mm */
    double flow;            /* flow divided by the mean flow of a terminal */
    double rho_gamma, cost; /* sums of the subtree [law.h] */
    double inverse_limit;   /* 1 / (largest allowed radius of the segment, mm); 0: no limit */
    double utilisation;     /* mm^(-3/4); see above */
    int32_t parent;         /* -1 at an inlet */
    int32_t child[2];       /* -1: none */
    uint32_t saved;         /* number of the last move that saved the branch for arbor_undo */
} Branch;

/* The solid of a segment: a tube with hemispherical ends. Fills one cache line. */
typedef struct Shape {
    Vec3 from, to;          /* proximal and distal end, mm */
    double reserved_radius; /* radius, mm, to which the segment may widen without meeting another
                             * segment [refine_clearance.h] */
    uint32_t saved;         /* number of the last move that saved the shape for arbor_undo */
} Shape;

/* Derivatives of the cost of the whole tree, S_root [law.h]. From them follows how S_root changes
 * when one segment changes, without a walk to the root. */
typedef struct Marginal {
    Adjoint adjoint;
    double gauge; /* [law.h] */
    double extra; /* derivative of S_root with respect to an additional flow through all segments
                   * above this one; the unit of flow is the mean flow of a terminal */
} Marginal;

/* The properties of a segment that may depend on its radius. */
typedef struct Local {
    double viscosity; /* viscosity divided by the reference viscosity mu [law.h]: the plasma
                       * viscosity under Pries's law, else the viscosity of the blood */
    double gamma;     /* Murray exponent of the bifurcation at the distal end */
} Local;

/* Maximum number of segments whose position or reserved radius one move may change. The caller must
 * not exceed it; the functions do not check it. A move places up to 6 segments itself; the others
 * are segments that it widens beyond their reservations. clearance_allows rejects a move that would
 * widen more. Reason for 24 not recorded. */
enum { ARBOR_MOVE_SHAPES = 24 };

/* All arrays are owned. Other files may read the members, but only the functions below change them.
 */
typedef struct Arbor {
    Law law;       /* gamma and lambda. If `local` is not NULL, law.gamma is not used, because each
                    * node has its own gamma in `local` */
    size_t n;      /* number of nodes */
    size_t inlets; /* number of inlets, which are the nodes 0 to inlets - 1 */
    size_t terminals;
    int32_t *node;      /* per node: its index in the Tree that the arbor was made from */
    int32_t *tree;      /* per node: the inlet of its tree; NULL: there is one inlet */
    double radius_unit; /* q [law.h], mm^(3/4) */
    Branch *branch;     /* per segment */
    Shape *shape;       /* per segment */
    Marginal *marginal; /* per segment: of the last arbor_refresh, or of the segment's last move */
    Local *local;      /* per segment: of the last arbor_iterate_local; NULL: viscosity and gamma do
                        * not depend on the radius */
    LogCurve gamma;    /* Murray exponent as a function of the radius in mm */
    bool pries;        /* viscosity follows the radius by Pries's law */
    double hematocrit; /* for Pries's law */
    int32_t pruned;    /* the segment that arbor_prune has cut off; 0: none */
    int32_t stale;     /* while a segment is pruned: the lowest segment above it whose sums still
                        * include the pruned segment; an inlet if there is no such segment */
    /* The present move, and the old values of the branches and shapes that it has changed: */
    uint32_t move; /* number of the move */
    struct SavedBranch {
        Branch was;
        int32_t i;
    } * saved_branch; /* each segment at most once */
    size_t n_saved_branches;
    struct SavedShape {
        Shape was;
        int32_t i;
    } saved_shape[ARBOR_MOVE_SHAPES];
    int n_saved_shapes;
    int32_t grafted;   /* the bifurcation to which arbor_graft has copied the Local of another
                        * segment; 0: none */
    Local saved_local; /* old Local of `grafted` */
} Arbor;

/* Checks that parameters, tree and domain are as refine_tree [grow.h] requires. `domain` may be
 * NULL: vessels may be anywhere. Errors: STATUS_USAGE for parameters, STATUS_INPUT for a tree that
 * cannot be refined; STATUS_MEMORY. */
MUST_CHECK Status refine_check(const RefineParams *params, const Domain *domain, const Tree *tree,
                               Err *err);

/* Makes an arbor from a tree that refine_check has accepted, and calls arbor_iterate_local. Gamma,
 * lambda, the viscosity law and the hematocrit are those of tree->meta. After an error *arbor is
 * unchanged. Release *arbor with arbor_release. Errors: those of arbor_iterate_local;
 * STATUS_MEMORY. */
MUST_CHECK Status arbor_init(Arbor *arbor, const Tree *tree, Err *err);
/* Frees the arrays and zeroes *arbor, which may be zeroed before. */
void arbor_release(Arbor *arbor);

/* Sets parent and position (`place`, mm) of every node, and computes all sums. parent[i] is -1 for
 * an inlet. The caller must update the reserved radii afterwards. Cost: O(n). */
void arbor_arrange(Arbor *arbor, const int32_t *parent, const Vec3 *place);
/* Computes the sums of all segments, lengths included. Cost: O(n). */
void arbor_sum(Arbor *arbor);
/* Updates arbor->local, the marginals and all sums, if viscosity or gamma depend on the radius.
 * Computes viscosities, gammas and radii in turn, until no viscosity changes by more than 1e-13 of
 * its value and no gamma by more than 1e-13. Does nothing if arbor->local is NULL. After an error
 * the values of arbor->local and the sums are undefined.
 *
 * Errors  STATUS_INFEASIBLE if vessels are too narrow for blood to pass by Pries's law, or if the
 *         iteration does not converge, because gamma or viscosity change too fast with the
 *         radius. */
MUST_CHECK Status arbor_iterate_local(Arbor *arbor, Err *err);
/* Updates the marginals of all segments. Requires exact sums. Cost: O(n). */
void arbor_refresh(Arbor *arbor);

static inline bool arbor_is_inlet(const Arbor *arbor, int32_t i)
{
    return (size_t)i < arbor->inlets;
}

/* Returns the first segment in depth-first order, over all trees. */
static inline int32_t arbor_first(const Arbor *arbor)
{
    return arbor->branch[0].child[0];
}

/* Returns true if segments i and j belong to the same tree. */
static inline bool arbor_is_same_tree(const Arbor *arbor, int32_t i, int32_t j)
{
    return !arbor->tree || arbor->tree[i] == arbor->tree[j];
}

/* Returns the viscosity in segment i relative to the reference. */
static inline double arbor_viscosity(const Arbor *arbor, int32_t i)
{
    return arbor->local ? arbor->local[i].viscosity : 1;
}

/* Returns the exponents at node i. */
static inline Law arbor_law(const Arbor *arbor, int32_t i)
{
    return arbor->local ? (Law){arbor->local[i].gamma, arbor->law.lambda} : arbor->law;
}

/* Returns S_root [law.h], summed over all trees; 0 or not finite if the radii exceed the range of a
 * double. */
static inline double arbor_cost(const Arbor *arbor)
{
    double cost = 0;
    for (size_t k = 0; k < arbor->inlets; k++) {
        const int32_t *child = arbor->branch[k].child;
        cost += arbor->branch[child[0]].cost;
        if (child[1] >= 0)
            cost += arbor->branch[child[1]].cost;
    }
    return cost;
}

/* Returns the segment after `i` in depth-first order, tree after tree; 0 after the last. */
int32_t arbor_next(const Arbor *arbor, int32_t i);

/* Returns the sums over the subtree below segment i, without the segment itself [law.h]; zeros for
 * a terminal. Segment i may not be an inlet. */
static inline Subtree arbor_below(const Arbor *arbor, int32_t i)
{
    const int32_t *child = arbor->branch[i].child;
    if (child[0] < 0)
        return (Subtree){0};
    const Branch *left = &arbor->branch[child[0]], *right = &arbor->branch[child[1]];
    const Law law = arbor_law(arbor, i);
    return law_add_daughters(&law, left->rho_gamma + right->rho_gamma, left->cost + right->cost);
}

/* Returns the load, the cost and the other values of segment i [Reduced, law.h], which include its
 * subtree. Segment i may not be an inlet. Cost: O(1). */
Reduced arbor_reduce(const Arbor *arbor, int32_t i);
/* Returns the marginal of segment i, computed from the present sums and the stored marginal of its
 * parent. Cost: O(1). */
Marginal arbor_marginal(const Arbor *arbor, int32_t i);

/* Returns the radius of segment i, mm, computed with the gauge in its stored marginal: exact after
 * arbor_refresh, approximate after later moves elsewhere in the tree. Cost: O(1). */
double arbor_stored_radius(const Arbor *arbor, int32_t i);
/* Returns the present radius of segment i, mm. Cost: O(depth). */
double arbor_radius(const Arbor *arbor, int32_t i);
/* Returns a segment whose radius exceeds its limit (1 / inverse_limit), and sets *radius to the
 * segment's present radius, mm. Returns 0 if no segment does; *radius is then undefined. Cost:
 * O(depth). */
int32_t arbor_find_overuse(const Arbor *arbor, double *radius);

/* Returns the other daughter of the bifurcation at which segment i begins. Segment i may not be a
 * root segment. */
static inline int32_t arbor_sibling(const Arbor *arbor, int32_t i)
{
    const Branch *parent = &arbor->branch[arbor->branch[i].parent];
    return parent->child[parent->child[0] == i];
}

/* Returns true if segment i is `top` or below it. */
bool arbor_is_below(const Arbor *arbor, int32_t i, int32_t top);

/* Returns true if segment i is part of the tree. A pruned segment is not, nor is the segment to the
 * bifurcation from which it was cut off. */
static inline bool arbor_contains(const Arbor *arbor, int32_t i)
{
    return arbor->pruned == 0 || (i != arbor->pruned && i != arbor->branch[arbor->pruned].parent);
}

/* Returns true if two different segments have a common node. */
bool arbor_are_joined(const Arbor *arbor, int32_t i, int32_t j);

/* Begins a move. arbor_undo can undo all changes by the functions below until the next move begins.
 */
void arbor_begin(Arbor *arbor);
/* Restores the arbor as it was at arbor_begin, to the last bit. */
void arbor_undo(Arbor *arbor);

/* Moves the bifurcation at the end of segment i to `place`, mm, and updates all sums to the root.
 * Cost: O(depth). */
void arbor_move_node(Arbor *arbor, int32_t i, Vec3 place);
/* Cuts off segment i, its subtree, and the bifurcation at which it begins. The sibling of segment i
 * then begins where the parent segment began. The bifurcation and segment i are not part of the
 * tree until arbor_graft. Segment i may not be a root segment. Updates the sums of the sibling and
 * of the next three segments above, because the cut subtree matters most to the prices of
 * connections near it. The sums of the segments from arbor->stale to the root remain out of date
 * until arbor_graft. Cost: O(1). */
void arbor_prune(Arbor *arbor, int32_t i);
/* Splits segment `host` at `place`, mm, and connects the pruned segment i there. `host` must be
 * part of the tree [arbor_contains], and not below segment i. Updates all sums. Cost: O(depth). */
void arbor_graft(Arbor *arbor, int32_t i, int32_t host, Vec3 place);

/* Sets reserved_radius and inverse_limit of segment i. Afterwards the caller must call
 * arbor_sum_from for this segment. */
void arbor_reserve(Arbor *arbor, int32_t i, double reserved_radius, double inverse_limit);
/* Computes the sums of segment i and of all segments above it. Cost: O(depth). */
void arbor_sum_from(Arbor *arbor, int32_t i);

/* Makes a tree of the arbor, with radii by law.h.
 *
 * was      the tree that the arbor was made from. Its node types, flow shares and pairs of
 *          terminals are copied; its metadata and other columns are not.
 * tree     receives the tree; release it with tree_release.
 * Errors   STATUS_INFEASIBLE if a radius is beyond the range of a double; STATUS_MEMORY. */
MUST_CHECK Status arbor_to_tree(const Arbor *arbor, const Tree *was, Tree *tree, Err *err);

#endif
