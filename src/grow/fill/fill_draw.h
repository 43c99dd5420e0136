/* Chooses at random the small vessels that are added to a tree with large vessels (a filling
 * [fill_tree]), as a published table of morphometry describes them. The result is a list of
 * elements with orders, daughters, radii and lengths, but without positions. fill_place.h then
 * gives the elements positions.
 *
 * An element is a chain of segments of the same diameter-defined order [derive.h]. Order 1 is the
 * thinnest. Elements of the given tree are called grown; they have the orders rules.from and above.
 * The filling adds elements of the orders rules.to to rules.from - 1. They are called drawn,
 * because their radii, lengths and daughters are random numbers. The number of daughters of an
 * element follows the connectivity matrix of the table.
 *
 *     TRY(filling_init(&filling, &rules, seed, err));
 *     TRY(filling_add(&filling, grown_element, err));    (once for each grown element)
 *     TRY(filling_draw(&filling, err));                  (then filling_release)
 *
 * The same rules, grown elements and seed give the same elements. No function may be called by two
 * threads on one filling at the same time.
 *
 * Source: Kaimovitz, Lanir & Kassab, Ann. Biomed. Eng. 33 (2005) 1517-1535. */
#ifndef CORCAST_GROW_FILL_FILL_DRAW_H
#define CORCAST_GROW_FILL_FILL_DRAW_H

#include "derive/derive.h"
#include "grow/grow.h"

/* An index that stands for no element. */
enum { NO_ELEMENT = -1 };

/* One element, grown or drawn. Elements refer to each other by their indices in Filling.element.
 *
 * The caller sets order, parent, grown, is_open, present and, for a grown element, radius_mm,
 * widest_mm and grown_mm. filling_add and filling_draw set the other fields.
 *
 * A grown element that is open may get an extension: a chain of new segments at its distal end, so
 * that the length of the whole element agrees with the table. */
typedef struct FillElement {
    int32_t order;    /* from 1, the thinnest, to the highest order of the table */
    int32_t parent;   /* the element that a drawn element branches off; NO_ELEMENT if grown */
    int32_t daughter; /* head of the list of drawn daughters; NO_ELEMENT: no daughter */
    int32_t sister;   /* next element in the parent's list of daughters, which is ordered from the
                       * parent's proximal to its distal end; NO_ELEMENT: the last */
    int32_t peer;     /* next element in the list of all elements of this order, in the order in
                       * which they were added; NO_ELEMENT: the last */
    int32_t segments; /* drawn: number of its segments. grown: number of segments of its extension;
                       * valid once places_fill [fill_place.h] has begun */
    bool grown;
    bool is_open; /* the element is grown and ends in a terminal, so that it can be extended */
    uint16_t present[PUBLISHED_DAUGHTERS]; /* [k]: number of grown daughters k orders lower */
    double radius_mm; /* drawn: radius of all its segments. grown: radius of its last segment */
    double widest_mm; /* largest radius of its segments */
    double grown_mm;  /* grown: length without the extension. drawn: 0 */
    double length_mm; /* drawn: its length. grown: length of its extension; 0: no extension */
} FillElement;

/* The elements of a filling. A drawn element has a larger index than its parent. */
typedef struct Filling {
    FillRules rules;
    Random random;
    FillElement *element;  /* owned */
    size_t n, capacity;    /* number of elements, and allocated length of `element` */
    int32_t *first, *last; /* [k]: first and last element of order k, or NO_ELEMENT; owned */
} Filling;

/* Begins a filling without elements.
 *
 * filling  is overwritten; release it with filling_release, also after an error.
 * rules    must be valid [fill_tree]. Copied; the table and its name are borrowed.
 * seed     of the random numbers; any number.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status filling_init(Filling *filling, const FillRules *rules, uint64_t seed, Err *err);
/* Frees the arrays and zeroes *filling, which may be zeroed before. */
void filling_release(Filling *filling);

/* Appends a copy of an element, which gets the index filling->n - 1. Sets `daughter`, `sister` and
 * `peer` of the copy to NO_ELEMENT, and appends the copy to the list of its order. Does not append
 * it to the parent's list of daughters.
 *
 * Errors   STATUS_INFEASIBLE if there are more than TREE_MAX_ID elements; STATUS_MEMORY. The
 *          filling is then as before. */
MUST_CHECK Status filling_add(Filling *filling, FillElement element, Err *err);

/* Draws the daughters of all grown elements and, recursively, of all drawn elements, down to the
 * order rules.to. Call it once, after all grown elements were added.
 *
 * Number of daughters: an element gets floor(C) or ceil(C) daughters of each order, where C is the
 * mean number of the table. The probability of ceil(C) is such that the mean is C. The daughters
 * that a grown element has already (`present`) are subtracted. A grown element gets only daughters
 * of orders below rules.from.
 *
 * Start of daughters: two daughters of a drawn or open element start at its distal end, the last
 * two in its list. They are of lower orders than the element. If fewer than two lower daughters
 * were drawn, daughters of the highest lower order are added; the mean number of these daughters is
 * therefore above C. The other daughters start along the element, in random order. An exception are
 * elements of the order rules.to: their daughters have the same order, and all start along the
 * element.
 *
 * Sizes: the diameter has a normal distribution, truncated at the bounds of the order
 * [morphometry_bound_mm]. The length has a lognormal distribution. An open grown element is
 * extended to the length that was drawn for it, unless the extension would be shorter than its
 * diameter. A drawn element that is too short for its segments exchanges its length with another
 * drawn element of its order. If no such element is found, it gets the length that it needs.
 *
 * Errors   as filling_add. The filling is then only fit for filling_release. */
MUST_CHECK Status filling_draw(Filling *filling, Err *err);

/* Divides element->length_mm, mm, among element->segments segments by random numbers.
 *
 * Each segment gets a minimum length and a random fraction of the remaining length. The fractions
 * are proportional to numbers from an exponential distribution. The minimum length is the diameter,
 * 2 radius_mm. For the first segment of a drawn element, the minimum is 1.1 to 1.5 times the sum of
 * the element's radius and the parent's largest radius, because this segment begins on the axis of
 * the parent and must reach beyond the parent's wall. The factor rises with the ratio of the
 * daughter's radius to the parent's, because wide daughters branch off at narrower angles.
 *
 * element  one of filling->element, with a length of at least the sum of these minima. Elements
 *          after filling_draw, and grown elements in places_fill, have such a length.
 * length   receives element->segments lengths, mm, from the proximal to the distal end. */
void filling_cut(Filling *filling, const FillElement *element, double *length);

#endif
