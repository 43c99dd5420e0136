/* Draws the elements of a filling from a published table: their orders, daughters, radii and
 * lengths, without positions.
 *
 *     TRY(filling_init(&filling, &rules, seed, err));
 *     TRY(filling_add(&filling, grown_element, err));    (once for each grown element)
 *     TRY(filling_draw(&filling, err));                  (then filling_release)
 *
 * Source: Kaimovitz, Lanir & Kassab, Ann. Biomed. Eng. 33 (2005) 1517-1535. */
#ifndef CORCAST_GROW_FILL_FILL_DRAW_H
#define CORCAST_GROW_FILL_FILL_DRAW_H

#include "derive/derive.h"
#include "grow/grow.h"

enum { NO_ELEMENT = -1 };

/* An element: a chain of segments of one order. */
typedef struct FillElement {
    int32_t order;    /* from 1 */
    int32_t parent;   /* the element that it branches off; NO_ELEMENT for a grown element */
    int32_t daughter; /* its first drawn daughter; NO_ELEMENT: none */
    int32_t sister;   /* next daughter of the same parent, in their order along it; NO_ELEMENT */
    int32_t peer;     /* the element of the same order that was added next; NO_ELEMENT: none */
    int32_t segments; /* of a drawn element: number of segments that it is cut into */
    bool grown;       /* the element is part of the tree that is filled */
    bool is_open;     /* grown, and its last segment is a terminal */
    uint16_t present[PUBLISHED_DAUGHTERS]; /* grown daughters by the number of orders below */
    double radius_mm;                      /* of a grown element: the radius at its distal end */
    double widest_mm;                      /* its largest radius */
    double grown_mm;                       /* length that was grown; 0 for a drawn element */
    double length_mm;                      /* length that the filling adds */
} FillElement;

/* The elements of a filling. A drawn element comes after its parent. */
typedef struct Filling {
    FillRules rules;
    Random random;
    FillElement *element; /* owned */
    size_t n, capacity;
    int32_t *first, *last; /* per order, from 0: its first and last element; owned */
} Filling;

/* Begins a filling. `rules` are valid [fill_tree]. Release *filling with filling_release, also
 * after an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status filling_init(Filling *filling, const FillRules *rules, uint64_t seed, Err *err);
void filling_release(Filling *filling);

/* Adds an element, with the index filling->n - 1. Sets `daughter`, `sister` and `peer`. Errors:
 * STATUS_INFEASIBLE if there are more than TREE_MAX_ID elements; STATUS_MEMORY. */
MUST_CHECK Status filling_add(Filling *filling, FillElement element, Err *err);

/* Draws the daughters of all elements, of the daughters, and so on, down to the order rules.to.
 *
 * An element of order n gets floor(C) or ceil(C) daughters of each order, C being the mean number
 * of the table. The probability of ceil(C) is such that the mean is C. A grown element has
 * daughters already: they are subtracted, and a grown element of an order from rules.from on gets
 * daughters below rules.from only. The last two daughters close the element and are of lower
 * orders; the others are along it, in random order. Elements of the lowest order end without
 * daughters.
 *
 * The diameter is normally distributed within the bounds of the order. The length has a lognormal
 * distribution. An open grown element is extended to the length that was drawn for it, unless the
 * extension were shorter than wide. A drawn element that is too short for its segments exchanges
 * its length with another one of its order; if none is found, it gets the length that it needs.
 *
 * Errors   as filling_add. */
MUST_CHECK Status filling_draw(Filling *filling, Err *err);

/* Cuts the length of a drawn element into element->segments lengths, which are set in `length`.
 * Each is the width of the element, the first of them the sum of the element's and the parent's
 * radius, and a share of the remaining length by an exponential distribution. All are shorter in
 * proportion if there is not enough length. */
void filling_cut(Filling *filling, const FillElement *element, double *length);

#endif
