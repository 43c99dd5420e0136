/* The tree as vessels: what lies between one branching of the tree and the next.
 *
 * In a grown tree each segment is a vessel; in a measured one a vessel is a chain of many short
 * segments, and only vessels can be compared with the literature, which calls them segments. */
#ifndef CORCAST_DERIVE_VESSELS_H
#define CORCAST_DERIVE_VESSELS_H

#include "tree/tree.h"

enum { NO_VESSEL = -1 };

typedef struct Vessel {
    int32_t parent; /* the vessel it comes from; NO_VESSEL where it leaves a root */
    int32_t start;  /* the node it comes from */
    int32_t level, strahler;
    double radius_mm; /* of its segments, weighted by length; that of the first when all are of 0 */
    double length_mm;
} Vessel;

typedef struct Vessels {
    Vessel *vessel; /* owned; parents first */
    size_t n;
    int32_t *of_node; /* owned; the vessel of each segment, NO_VESSEL at roots */
} Vessels;

/* Fills *vessels (owned; vessels_release). */
MUST_CHECK Status vessels_init(Vessels *vessels, const Tree *tree, Err *err);
void vessels_release(Vessels *vessels);

/* For each vessel, the thickest of those that come from it and have its order, the first of
 * several, in *heir (owned, n entries); NO_VESSEL where there is none. */
MUST_CHECK Status vessels_heirs(const Vessels *vessels, const int32_t *order, int32_t **heir,
                                Err *err);

/* How the assignment of orders by diameter ended. */
typedef struct DiameterOrders {
    int rounds;     /* of assignment, the one that changed too little to go on included */
    bool converged; /* false: given up after 100 rounds */
} DiameterOrders;

/* The diameter-defined Strahler order of each vessel, from 1 without gaps, in *order (owned, n
 * entries); derive.h says what it is. */
MUST_CHECK Status vessels_diameter_orders(const Vessels *vessels, int32_t **order,
                                          DiameterOrders *result, Err *err);

#endif
