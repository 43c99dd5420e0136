/* Published morphometry of arterial trees, and its comparison with a tree. */
#ifndef CORCAST_DERIVE_MORPHOMETRY_H
#define CORCAST_DERIVE_MORPHOMETRY_H

#include "base/base.h"
#include "derive/statistics.h"
#include <stdbool.h>
#include <stddef.h>

enum {
    PUBLISHED_DAUGHTERS = 16, /* a table has at most the daughters that are 0 to 15 orders lower */
    DAUGHTER_ORDERS = 4       /* daughters that are 0 to 3 orders lower are compared */
};

/* A published mean and its standard error. NAN: not published. */
typedef struct Estimate {
    double mean, se;
} Estimate;

/* One diameter-defined Strahler order of a published table. A value that is not published is NAN,
 * and so is the standard deviation of a single element. */
typedef struct MorphometryRow {
    Spread diameter_mm, length_mm; /* of the elements */
    double elements;               /* number of elements */
    Spread vessels_per_element; /* number of vessels (segments of the literature) of one element */
    Estimate daughters[PUBLISHED_DAUGHTERS]; /* [k]: elements k orders lower off one element */
} MorphometryRow;

/* A published table: row[k] is order k + 1. */
typedef struct Morphometry {
    char *source; /* owned; author, journal, year */
    OrderRatios ratios;
    int fitted_from[3];  /* per ratio: the lowest order that it was fitted to */
    MorphometryRow *row; /* owned */
    size_t n;            /* at least 1 */
} Morphometry;

/* Reads a table of templates/morphometry. Its lines:
 *
 *     source TEXT
 *     ratios NUMBER DIAMETER LENGTH
 *     fitted-from NUMBER DIAMETER LENGTH   (default: 1 1 1)
 *     8 numbers for each order, from 1     ("nan": not published)
 *     daughters ORDER MEAN SE MEAN SE ...  (after its order's line: 0, 1, ... orders lower)
 *     # comment
 *
 * The 8 numbers are: order; mean and standard deviation of the diameter, um; mean and standard
 * deviation of the length, mm; number of elements; mean and standard deviation of the number of
 * segments per element. A line of an order may have 4 numbers more: the mean numbers of daughters
 * 0, 1, 2 and 3 orders lower, without errors.
 *
 * Release *table with morphometry_release. Errors: STATUS_INPUT for any other line, naming file and
 * line, and for a table without a source or without order 1; STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status morphometry_read(Morphometry *table, const char *path, Err *err);
void morphometry_release(Morphometry *table);

/* Returns the diameter, mm, between `order`, from 0, and the next order: half way between mean plus
 * standard deviation of the one and mean minus standard deviation of the other [Jiang, Kassab &
 * Fung 1994, as in derive.h]. It is 0 below order 1, and infinite above the last order. */
double morphometry_bound_mm(const Morphometry *table, int order);

/* The quantities that are compared. */
typedef enum MorphometryMeasure {
    COMPARED_DIAMETER,
    COMPARED_LENGTH,
    COMPARED_VESSELS,          /* vessels per element */
    COMPARED_DAUGHTERS,        /* elements of the same order that branch off one element */
    COMPARED_DAUGHTERS_1_LESS, /* elements one order lower, and so on */
    COMPARED_DAUGHTERS_2_LESS,
    COMPARED_DAUGHTERS_3_LESS,
    COMPARED_NUMBER_RATIO, /* over all orders, like the next two */
    COMPARED_DIAMETER_RATIO,
    COMPARED_LENGTH_RATIO,
    MORPHOMETRY_MEASURES
} MorphometryMeasure;

/* Name and unit ("" for pure numbers) of each. */
extern const struct MorphometryName {
    const char *name, *unit;
} morphometry_names[MORPHOMETRY_MEASURES];

/* A number of the tree and the published number. */
typedef struct MorphometryPair {
    MorphometryMeasure measure;
    int order, published_order; /* 0: over all orders */
    double value;               /* of the tree */
    Spread published;           /* sd is NAN if none is published */
    double se;                  /* standard error of published.mean; NAN if none is published */
    double room;                /* allowed difference */
    bool agrees;                /* |value - published.mean| <= room */
    bool agrees_strictly;       /* agrees with the room that the number has without `se` */
} MorphometryPair;

/* The pairs, by measure and then by rising order. A quantity that only the tree or only the table
 * has is left out. So are the daughters of an order of which only one element was published. */
typedef struct MorphometryComparison {
    MorphometryPair *pair; /* owned; free */
    size_t n;
    size_t agreeing, agreeing_strictly;
} MorphometryComparison;

/* Allowed relative difference from a published number without a standard deviation. */
#define MORPHOMETRY_ROOM 0.25
/* Allowed difference from a published number with a standard error, in standard errors. */
#define MORPHOMETRY_ERRORS 2

/* The orders of a tree that are compared with a table. */
typedef enum MorphometryOrders {
    ORDERS_PUBLISHED, /* by the bounds between the published diameters */
    ORDERS_FOUND,     /* the tree's diameter-defined orders, matched with the published ones */
    MORPHOMETRY_ORDERS
} MorphometryOrders;

extern const char *const morphometry_orders_names[MORPHOMETRY_ORDERS + 1]; /* NULL ends the list */

/* Compares a tree with a table, by both kinds of orders.
 *
 * Published orders: morphometry_bound_mm is the bound between two orders. A vessel has the order of
 * its diameter, or the largest order of its daughters if that is higher.
 *
 * Found orders: a tree rarely covers a whole organ, so order k of the tree is compared with the
 * published order k + shift. Only shifts are tried at which all orders of the tree, or all orders
 * of the table, have a counterpart. The shift with the smallest mean squared logarithm of the ratio
 * of mean diameters is used, the lowest of equals.
 *
 * Horton's ratios of the tree are computed from the orders that also gave the published ratios. A
 * number agrees if it is within the published standard deviation. If there is none, it agrees
 * within MORPHOMETRY_ROOM of the published value or within MORPHOMETRY_ERRORS standard errors,
 * whichever is wider.
 *
 * statistics  those of `tree`.
 * comparison  one per kind of orders; the caller frees each `pair`, also after an error.
 * Errors      STATUS_MEMORY. */
MUST_CHECK Status morphometry_compare(const Tree *tree, const TreeStatistics *statistics,
                                      const Morphometry *table,
                                      MorphometryComparison comparison[MORPHOMETRY_ORDERS],
                                      Err *err);

#endif
