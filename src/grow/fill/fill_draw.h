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

/* An element: a chain of segments of one order. A grown element belongs to the tree that is filled.
 * All other elements are drawn: random numbers determine them. The filling may extend a grown
 * element at its distal end. */
typedef struct FillElement {
    int32_t order;    /* from 1 */
    int32_t parent;   /* drawn: the element that it branches off; grown: NO_ELEMENT */
    int32_t daughter; /* first drawn daughter; NO_ELEMENT: none */
    int32_t sister;   /* next drawn daughter of the same parent, along the parent from its proximal
                       * to its distal end; NO_ELEMENT: none */
    int32_t peer;     /* the element of the same order that was added next; NO_ELEMENT: none */
    int32_t segments; /* drawn: number of its segments; grown: number of segments of its extension,
                       * from places_fill on */
    bool grown;
    bool is_open; /* grown, and its most distal segment is a terminal, so that it can be extended */
    uint16_t present[PUBLISHED_DAUGHTERS]; /* [k]: number of grown daughters k orders lower */
    double radius_mm; /* drawn: radius of all its segments; grown: radius of its most distal one */
    double widest_mm; /* largest radius of its segments */
    double grown_mm;  /* grown: length without the extension; drawn: 0 */
    double length_mm; /* drawn: its length; grown: length of its extension, 0: none */
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
 * An element gets floor(C) or ceil(C) daughters of each order, where C is the mean number of the
 * table. The probability of ceil(C) is such that the mean is C. The daughters that a grown element
 * has already are subtracted. A grown element of order rules.from or above gets daughters below
 * rules.from only.
 *
 * The last two daughters of a drawn or open element start at its distal end and are of lower orders
 * than the element. If fewer than two lower daughters were drawn, daughters of the highest lower
 * order are added, so that the mean number of these daughters exceeds C. The other daughters start
 * along the element, in random order. Elements of the lowest order, rules.to, have daughters along
 * them but none at the distal end.
 *
 * The diameter is normally distributed within the bounds of the order. The length has a lognormal
 * distribution. An open grown element is extended to the length that was drawn for it, unless the
 * extension were shorter than wide. A drawn element that is too short for its segments exchanges
 * its length with another one of its order; if none is found, it gets the length that it needs.
 *
 * Errors   as filling_add. */
MUST_CHECK Status filling_draw(Filling *filling, Err *err);

/* Divides element->length_mm among element->segments segments, whose lengths are set in `length`.
 *
 * Each segment gets a minimum length and a random share of the remaining length, from an
 * exponential distribution. The minimum is the diameter 2 radius_mm. For the first segment of a
 * drawn element, it is 1.1 to 1.5 times the sum of the element's radius and the parent's largest
 * radius, because this segment must leave its parent. Requires a length of at least the sum of
 * these minima: filling_draw and places_fill see to it. */
void filling_cut(Filling *filling, const FillElement *element, double *length);

#endif
