/* A tree under refinement: segments that know what hangs on them, changed one move at a time, each
 * of which can be undone.
 *
 * Node i > 0 is the distal end of segment i; node 0 is the inlet, its only child the root segment.
 * Indices are those of the Tree it was made from and stay: a bifurcation that moves, or that moves
 * elsewhere with a subtree, is the same node. */
#ifndef CORCAST_GROW_REFINE_ARBOR_H
#define CORCAST_GROW_REFINE_ARBOR_H

#include "base/base.h"
#include "geom/geom.h"
#include "grow/cco/law.h"
#include "tree/tree.h"

/* What the walk to the root needs of one segment, in one cache line. */
typedef struct Branch {
    double length;          /* mm */
    double flow;            /* in units of the terminals' mean */
    double rho_gamma, cost; /* [law.h] */
    /* Radii must not outgrow the room they were given [refine_clearance.h]. The segment's radius
     * times `inverse_limit` must be at most 1, and so must `utilisation` times q and the gauge: it
     * is the greatest such product of the segment and all below it. */
    double inverse_limit, utilisation; /* 1/mm; pure times mm^(1/4) */
    int32_t parent;                    /* -1 at the inlet */
    int32_t child[2];                  /* -1: none */
    uint32_t saved;                    /* the move that has saved it */
} Branch;

/* A segment as a body, in one cache line. */
typedef struct Shape {
    Vec3 from, to;          /* mm */
    double reserved_radius; /* mm; the radius that no other vessel comes in the way of */
    uint32_t saved;
} Shape;

/* How S_root, to first order, depends on the segment at one place in the tree. */
typedef struct Marginal {
    Adjoint adjoint;
    double gauge; /* [law.h] */
    double extra; /* dS_root for one more unit of flow through all segments above */
} Marginal;

enum { ARBOR_MOVE_SHAPES = 24 };

typedef struct Arbor {
    Law law;
    size_t n;
    double radius_unit; /* q, mm^(3/4) */
    Branch *branch;
    Shape *shape;
    Marginal *marginal; /* of each segment; as of the last arbor_refresh, or of its last move */
    /* Of each segment, over the reference, as of the last arbor_update_viscosity; NULL where it is
     * constant. */
    double *viscosity;
    double hematocrit;
    int32_t pruned; /* the segment that arbor_prune has cut off; 0: none */
    /* What the present move has changed, as it was before: */
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
    int32_t grafted; /* the bifurcation that took over its host's viscosity; 0: none */
    double saved_viscosity;
} Arbor;

/* Makes *arbor (owned; arbor_release) from a tree that refine_check accepts. */
MUST_CHECK Status arbor_init(Arbor *arbor, const Tree *tree, Err *err);
void arbor_release(Arbor *arbor);

/* Connects and places all nodes anew; reservations are the caller's. place[0] is the inlet. */
void arbor_arrange(Arbor *arbor, const int32_t *parent, const Vec3 *place);
/* Sums up all segments anew. */
void arbor_sum(Arbor *arbor);
/* Where viscosity follows the radius, computes both in turn until they agree to 1e-13, and sums up
 * anew. STATUS_INFEASIBLE where vessels are too narrow for that. */
MUST_CHECK Status arbor_update_viscosity(Arbor *arbor, Err *err);
/* Brings the marginal of all segments up to date. */
void arbor_refresh(Arbor *arbor);

static inline int32_t arbor_root(const Arbor *arbor)
{
    return arbor->branch[0].child[0];
}

/* How viscous the blood in segment i is, over the reference. */
static inline double arbor_viscosity(const Arbor *arbor, int32_t i)
{
    return arbor->viscosity ? arbor->viscosity[i] : 1;
}

/* S_root; not finite, or 0, when the radii span more than a double can hold. */
static inline double arbor_cost(const Arbor *arbor)
{
    return arbor->branch[arbor_root(arbor)].cost;
}

/* The segment after `i` in depth-first order, which begins with the root segment; 0 after the
 * last. */
int32_t arbor_next(const Arbor *arbor, int32_t i);

/* What hangs on the distal end of segment i. */
static inline Below arbor_below(const Arbor *arbor, int32_t i)
{
    const int32_t *child = arbor->branch[i].child;
    if (child[0] < 0)
        return (Below){0};
    const Branch *left = &arbor->branch[child[0]], *right = &arbor->branch[child[1]];
    return law_gather(&arbor->law, left->rho_gamma + right->rho_gamma, left->cost + right->cost);
}

/* Segment i with what hangs on it. */
Reduced arbor_reduce(const Arbor *arbor, int32_t i);
/* The marginal of segment i from what its parent is now and that one's marginal. */
Marginal arbor_marginal(const Arbor *arbor, int32_t i);

/* The radius of segment i, mm, as of the last arbor_refresh. */
double arbor_radius_seen(const Arbor *arbor, int32_t i);
/* The same as of now. O(depth). */
double arbor_radius(const Arbor *arbor, int32_t i);
/* A segment whose radius times its inverse_limit is above 1, and that radius in *radius; 0 when
 * there is none. O(depth). */
int32_t arbor_find_overuse(const Arbor *arbor, double *radius);

static inline int32_t arbor_sibling(const Arbor *arbor, int32_t i)
{
    const Branch *parent = &arbor->branch[arbor->branch[i].parent];
    return parent->child[parent->child[0] == i];
}

/* Whether segment i is `top` or below it. */
bool arbor_is_below(const Arbor *arbor, int32_t i, int32_t top);
/* False for a segment that is pruned and for the bifurcation that it came from. */
static inline bool arbor_has(const Arbor *arbor, int32_t i)
{
    return arbor->pruned == 0 || (i != arbor->pruned && i != arbor->branch[arbor->pruned].parent);
}

/* Whether two different segments have a node in common. */
bool arbor_are_joined(const Arbor *arbor, int32_t i, int32_t j);

/* A move begins, and is over when the next one begins. */
void arbor_begin(Arbor *arbor);
void arbor_undo(Arbor *arbor);

/* Moves the bifurcation at the end of segment i. */
void arbor_shift(Arbor *arbor, int32_t i, Vec3 place);
/* Cuts the segment and all below it off, together with the bifurcation it comes from: its sibling
 * now begins where the parent did. Neither that bifurcation nor the segment is part of the tree
 * until arbor_graft. */
void arbor_prune(Arbor *arbor, int32_t i);
/* Splits `host` at `place` and hangs what was pruned there. */
void arbor_graft(Arbor *arbor, int32_t i, int32_t host, Vec3 place);

/* Gives segment i `reserved_radius` and `inverse_limit` [refine_clearance.h]. The caller resums
 * from there. */
void arbor_reserve(Arbor *arbor, int32_t i, double reserved_radius, double inverse_limit);
/* Sums up anew from segment i to the inlet. */
void arbor_sum_from(Arbor *arbor, int32_t i);

#endif
