/* The tree as vessels, each the path between two branchings. Private to the module derive.
 *
 * In a grown tree each segment is a vessel. In a measured tree a vessel is a chain of many short
 * segments. The literature calls vessels segments, and only they can be compared with it. */
#ifndef CORCAST_DERIVE_VESSELS_H
#define CORCAST_DERIVE_VESSELS_H

#include "tree/tree.h"

enum { NO_VESSEL = -1 };

typedef struct Vessel {
    int32_t parent;   /* index of the parent vessel; NO_VESSEL if it starts at a root */
    int32_t start;    /* the node at which it starts */
    int32_t end;      /* the place at which it ends */
    int32_t level;    /* bifurcation level [derive.h] */
    int32_t strahler; /* Strahler order; 0 in a network with links */
    double radius_mm; /* mean of its segments' radii, weighted by length; if all lengths are 0, the
                       * first segment's radius */
    double length_mm;
} Vessel;

typedef struct Vessels {
    Vessel *vessel; /* owned; parents first */
    size_t n;
    int32_t *of_node; /* owned; per node: the vessel of its segment; NO_VESSEL at roots */
} Vessels;

/* Finds the vessels of a tree. Release *vessels with vessels_release. Errors: STATUS_MEMORY. */
MUST_CHECK Status vessels_init(Vessels *vessels, const Tree *tree, Err *err);
void vessels_release(Vessels *vessels);

/* Finds, for each vessel, its thickest daughter of the same order (the first of several), or
 * NO_VESSEL. *heir has an entry per vessel and is owned by the caller. Errors: STATUS_MEMORY. */
MUST_CHECK Status vessels_heirs(const Vessels *vessels, const int32_t *order, int32_t **heir,
                                Err *err);

/* The result of assigning orders by diameter. */
typedef struct DiameterOrders {
    int rounds;     /* number of rounds, including the last, which changed too little to go on */
    bool converged; /* false: stopped after 100 rounds */
} DiameterOrders;

/* Computes the diameter-defined Strahler order of each vessel [derive.h], from 1 without gaps.
 * *order has an entry per vessel and is owned by the caller. Errors: STATUS_MEMORY. */
MUST_CHECK Status vessels_diameter_orders(const Vessels *vessels, int32_t **order,
                                          DiameterOrders *result, Err *err);

/* Computes the order of each vessel by bounds of diameter [statistics_by_bounds]. *order has an
 * entry per vessel and is owned by the caller. Errors: STATUS_MEMORY. */
MUST_CHECK Status vessels_bounded_orders(const Vessels *vessels, const double *bound_mm, size_t n,
                                         int32_t **order, Err *err);

#endif
