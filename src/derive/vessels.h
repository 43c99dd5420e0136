/* Divides a tree into vessels: paths of segments from a root or branching to the next branching or
 * terminal. Private to the module derive. Call vessels_init first.
 *
 * In a grown tree each segment is a vessel. In a measured tree a vessel is a chain of many short
 * segments. The literature publishes numbers of vessels, which it calls segments. */
#ifndef CORCAST_DERIVE_VESSELS_H
#define CORCAST_DERIVE_VESSELS_H

#include "derive/derive.h"
#include "tree/tree.h"

enum { NO_VESSEL = -1 };

/* The vessels of a tree, parents before daughters. All arrays are owned, and have an entry per
 * vessel unless stated. */
typedef struct Vessels {
    size_t n;
    VesselRow *row;    /* start, end and length_mm; the other members are 0 */
    int32_t *parent;   /* index of the parent vessel; NO_VESSEL if the vessel starts at a root */
    int32_t *level;    /* bifurcation level [derive.h] */
    int32_t *strahler; /* Strahler order; 0 in a network with links, where orders are not defined
                        * [derive.h] */
    double *radius_mm; /* mean of the radii of the vessel's segments, weighted by length; if all
                        * lengths are 0, the radius of the first segment */
    int32_t *of_node;  /* per node of the tree: the vessel of its segment; NO_VESSEL at roots */
} Vessels;

/* Finds the vessels of a tree. Release *vessels with vessels_release. Errors: STATUS_MEMORY. */
MUST_CHECK Status vessels_init(Vessels *vessels, const Tree *tree, Err *err);
void vessels_release(Vessels *vessels);

/* Returns the vessels as a Lineage [derive.h], which borrows their arrays. */
static inline Lineage vessels_lineage(const Vessels *vessels)
{
    return (Lineage){vessels->parent, vessels->radius_mm, vessels->n};
}

/* The result of assigning orders by diameter. */
typedef struct DiameterOrders {
    int rounds;     /* number of rounds, including the last */
    bool converged; /* the last round changed at most 1 % of the orders, as in the source
                     * [derive.h]; false: stopped after 100 rounds */
} DiameterOrders;

/* Computes the diameter-defined Strahler order of each vessel [derive.h], from 1 without gaps.
 * *order has an entry per vessel and is owned by the caller. Errors: STATUS_MEMORY. */
MUST_CHECK Status vessels_diameter_orders(const Vessels *vessels, int32_t **order,
                                          DiameterOrders *result, Err *err);

#endif
