/* The arbor: a tree during refinement. Each segment has the sums over its subtree. The tree is
 * changed one move at a time, and a move can be undone.
 *
 * An arbor is not a Network [network.h], although both apply the same law of radii [law.h]. A
 * Network adds terminals in O(1) and lets sums far up go out of date; its Segment holds the sums of
 * its daughters. An arbor keeps its segments and has exact sums up to the root after every move;
 * its Branch holds its own sums and the largest utilisation of its subtree. Each of the two structs
 * fills one cache line, so that a step of the walk to the root costs one. A common struct would
 * take two.
 *
 * The first nodes are the inlets, each with one or two root segments. Every other node is the
 * distal end of the segment with the same index. Nodes with one child are left out, so that a
 * vessel of several segments becomes one straight segment. Indices are stable: a bifurcation keeps
 * its index when it moves, also when it moves with a subtree to another segment.
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

/* What the walk to the root reads of one segment, in one cache line of 64 bytes.
 *
 * A segment has room for its radius if radius * inverse_limit is at most 1. `utilisation` is the
 * greatest value of radius * inverse_limit of the segment and all segments below it, with radii in
 * units of the segment's own q times gauge [law.h]. Therefore one comparison at the root, of
 * utilisation times q with 1, tests all segments. */
typedef struct Branch {
    double length;          /* mm */
    double flow;            /* relative to the terminals' mean */
    double rho_gamma, cost; /* [law.h] */
    double inverse_limit;   /* 1 / (largest radius, mm, that the segment may have); 0: any radius */
    double utilisation;     /* mm^(-3/4) */
    int32_t parent;         /* -1 at the inlet */
    int32_t child[2];       /* -1: none */
    uint32_t saved;         /* number of the last move that saved the branch */
} Branch;

/* A segment as a solid, in one cache line. */
typedef struct Shape {
    Vec3 from, to;          /* mm */
    double reserved_radius; /* mm; to which the segment may widen without meeting another segment
                             * [refine_clearance.h] */
    uint32_t saved;         /* number of the last move that saved the shape */
} Shape;

/* The derivatives of S_root that price a change of a segment without a walk to the root. */
typedef struct Marginal {
    Adjoint adjoint;
    double gauge; /* [law.h] */
    double extra; /* increase of S_root if all segments above carried one more unit of flow */
} Marginal;

/* The properties of a segment that may depend on its radius. */
typedef struct Local {
    double viscosity; /* relative to the reference viscosity of radius_unit [law.h] */
    double gamma;     /* Murray exponent of the fork at its distal end */
} Local;

/* Maximum number of segments whose position or reserved radius one move may change. Reason for 24
 * not recorded. */
enum { ARBOR_MOVE_SHAPES = 24 };

/* All arrays are owned. Members are read by other files, and changed only by the functions below.
 */
typedef struct Arbor {
    Law law;       /* if `local` is not NULL, only its lambda is valid at every node */
    size_t n;      /* number of nodes */
    size_t inlets; /* number of inlets, which are the nodes 0 to inlets - 1 */
    size_t terminals;
    int32_t *node;      /* per node: its index in the Tree that the arbor was made from */
    int32_t *tree;      /* per node: the inlet of its tree; NULL: there is one inlet */
    double radius_unit; /* q [law.h], mm^(3/4) */
    Branch *branch;     /* per segment */
    Shape *shape;       /* per segment */
    Marginal *marginal; /* per segment: as of the last arbor_refresh, or of its last move */
    Local *local;       /* per segment: as of the last arbor_iterate_local; NULL if both are constant */
    LogCurve gamma;     /* Murray exponent as a function of the radius in mm */
    bool pries;         /* viscosity follows the radius by Pries's law */
    double hematocrit;  /* for Pries's law */
    int32_t pruned;     /* the segment that arbor_prune has cut off; 0: none */
    int32_t stale; /* while a segment is pruned: the lowest segment whose sums still include it, or
                    * the inlet */
    /* The values before the present move of all that the move has changed; `move` is its number: */
    uint32_t move;
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
    int32_t grafted; /* the bifurcation that arbor_graft has given the Local of its host; 0: none */
    Local saved_local;
} Arbor;

/* Checks that parameters, tree and domain are as refine_tree [grow.h] requires. `domain` may be
 * NULL: vessels may be anywhere. Errors: STATUS_USAGE for parameters, STATUS_INPUT for a tree that
 * cannot be refined; STATUS_MEMORY. */
MUST_CHECK Status refine_check(const RefineParams *params, const Domain *domain, const Tree *tree,
                               Err *err);

/* Makes an arbor from a tree that refine_check accepts. Its sums are exact, and viscosities and
 * exponents agree with the radii. Release *arbor with arbor_release. Errors: STATUS_INFEASIBLE as
 * arbor_iterate_local; STATUS_MEMORY. */
MUST_CHECK Status arbor_init(Arbor *arbor, const Tree *tree, Err *err);
/* Frees the arrays and zeroes *arbor, which may be zeroed before. */
void arbor_release(Arbor *arbor);

/* Sets the parent and the position, mm, of every node, and computes all sums. parent[i] is -1 for
 * an inlet. Does not update reserved radii, which the caller must do. Cost: O(n). */
void arbor_arrange(Arbor *arbor, const int32_t *parent, const Vec3 *place);
/* Computes the sums of all segments, lengths included. Cost: O(n). */
void arbor_sum(Arbor *arbor);
/* If viscosity or gamma depend on the radius: computes them and the radii in turn until they agree
 * to 1e-13, and computes all sums. Otherwise does nothing. Errors: STATUS_INFEASIBLE if vessels are
 * too narrow for blood to pass by Pries's law, or if gamma changes too fast with the radius. */
MUST_CHECK Status arbor_iterate_local(Arbor *arbor, Err *err);
/* Updates the marginals of all segments. Requires exact sums. Cost: O(n). */
void arbor_refresh(Arbor *arbor);

static inline bool arbor_is_inlet(const Arbor *arbor, int32_t i)
{
    return (size_t)i < arbor->inlets;
}

/* Returns the first segment in depth-first order. */
static inline int32_t arbor_first(const Arbor *arbor)
{
    return arbor->branch[0].child[0];
}

/* Returns true if segments i and j are of the same tree. */
static inline bool arbor_is_same_tree(const Arbor *arbor, int32_t i, int32_t j)
{
    return !arbor->tree || arbor->tree[i] == arbor->tree[j];
}

/* Returns the viscosity in segment i relative to the reference. */
static inline double arbor_viscosity(const Arbor *arbor, int32_t i)
{
    return arbor->local ? arbor->local[i].viscosity : 1;
}

/* Returns the law at node i. */
static inline Law arbor_law(const Arbor *arbor, int32_t i)
{
    return arbor->local ? (Law){arbor->local[i].gamma, arbor->law.lambda} : arbor->law;
}

/* Returns S_root; 0 or not finite if the radii span more than a double can hold. */
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

/* Returns the subtree below segment i. */
static inline Subtree arbor_below(const Arbor *arbor, int32_t i)
{
    const int32_t *child = arbor->branch[i].child;
    if (child[0] < 0)
        return (Subtree){0};
    const Branch *left = &arbor->branch[child[0]], *right = &arbor->branch[child[1]];
    const Law law = arbor_law(arbor, i);
    return law_add_daughters(&law, left->rho_gamma + right->rho_gamma, left->cost + right->cost);
}

/* Returns segment i together with the subtree below it. */
Reduced arbor_reduce(const Arbor *arbor, int32_t i);
/* Returns the marginal of segment i, from its parent's present sums and stored marginal.
 * Cost: O(1). */
Marginal arbor_marginal(const Arbor *arbor, int32_t i);

/* Returns the radius of segment i, mm, with its gauge of the last arbor_refresh. Cost: O(1). */
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

/* Returns true if segment i is part of the tree. The segment that is pruned and the segment to the
 * bifurcation that it came from are not. */
static inline bool arbor_contains(const Arbor *arbor, int32_t i)
{
    return arbor->pruned == 0 || (i != arbor->pruned && i != arbor->branch[arbor->pruned].parent);
}

/* Returns true if two different segments have a common node. */
bool arbor_are_joined(const Arbor *arbor, int32_t i, int32_t j);

/* Begins a move. All changes that the functions below make can be undone until the next move
 * begins. */
void arbor_begin(Arbor *arbor);
/* Restores the arbor as it was at arbor_begin, to the last bit. */
void arbor_undo(Arbor *arbor);

/* Moves the bifurcation at the end of segment i to `place`, mm, and updates all sums to the root.
 * Cost: O(depth). */
void arbor_move_node(Arbor *arbor, int32_t i, Vec3 place);
/* Cuts segment i off with all below it, together with the bifurcation that it comes from. Its
 * sibling then begins where the parent segment began. Neither the bifurcation nor the segment is
 * part of the tree until arbor_graft. Cost: O(1); sums further up still include the segment. */
void arbor_prune(Arbor *arbor, int32_t i);
/* Splits segment `host` at `place`, mm, and connects segment i, which is pruned, there.
 * Cost: O(depth). */
void arbor_graft(Arbor *arbor, int32_t i, int32_t host, Vec3 place);

/* Sets reserved_radius and inverse_limit of segment i. Then the caller must call arbor_sum_from
 * for it. */
void arbor_reserve(Arbor *arbor, int32_t i, double reserved_radius, double inverse_limit);
/* Computes the sums of segment i and of all segments above it. Cost: O(depth). */
void arbor_sum_from(Arbor *arbor, int32_t i);

/* Makes a tree of the arbor, with the radii that follow from the law of radii [law.h]. Copies the
 * node types, flow shares and pairs of terminals of `was`, the tree that the arbor was made from.
 * Does not copy its metadata and its other columns.
 *
 * tree     receives the tree; release it with tree_release.
 * Errors   STATUS_INFEASIBLE if a radius is beyond the range of a double; STATUS_MEMORY. */
MUST_CHECK Status arbor_to_tree(const Arbor *arbor, const Tree *was, Tree *tree, Err *err);

#endif
