/* Published tables of the morphometry of arterial trees. morphometry_read reads a table, and
 * morphometry_compare compares it with the statistics of a tree. Orders are diameter-defined
 * Strahler orders [derive.h]; vessels and elements are defined in statistics.h. */
#ifndef CORCAST_DERIVE_MORPHOMETRY_H
#define CORCAST_DERIVE_MORPHOMETRY_H

#include "base/base.h"
#include "derive/statistics.h"
#include <stdbool.h>
#include <stddef.h>

enum {
    PUBLISHED_DAUGHTERS = 16, /* a table may have daughters that are 0 to 15 orders lower; published
                               * tables have at most 11 orders */
    DAUGHTER_ORDERS = 4       /* only daughters that are 0 to 3 orders lower are compared */
};

/* A published mean and its standard error. NAN: not published. */
typedef struct Estimate {
    double mean, se;
} Estimate;

/* One order of a published table. A value that is not published is NAN, and so is the standard
 * deviation of a single element. */
typedef struct MorphometryRow {
    Spread diameter_mm, length_mm; /* diameter and length of the elements */
    double elements;               /* number of elements */
    Spread vessels_per_element;    /* number of vessels of one element (the literature: segments) */
    Estimate daughters[PUBLISHED_DAUGHTERS]; /* [k]: number of elements, k orders lower, that branch
                                              * off one element */
} MorphometryRow;

/* A published table. */
typedef struct Morphometry {
    char *source; /* author, journal, year; owned */
    OrderRatios ratios;
    int fitted_from[3];  /* per ratio: the lowest order to which it was fitted */
    MorphometryRow *row; /* row[k] is order k + 1; owned */
    size_t n;            /* number of orders, at least 1 */
} Morphometry;

/* Reads a table, such as those in templates/morphometry. Each line has one of these forms:
 *
 *     source TEXT
 *     ratios NUMBER DIAMETER LENGTH
 *     fitted-from NUMBER DIAMETER LENGTH   (default: 1 1 1)
 *     8 numbers for each order, from 1     ("nan": not published)
 *     daughters ORDER MEAN SE MEAN SE ...  (after the line of ORDER)
 *     # comment
 *
 * The 8 numbers are: order; mean and standard deviation of the diameter, um; mean and standard
 * deviation of the length, mm; number of elements; mean and standard deviation of the number of
 * vessels per element. A line of an order may have 4 more numbers: the mean numbers of daughters
 * 0, 1, 2 and 3 orders lower. A line "daughters" has the mean numbers of daughters 0, 1, 2, ...
 * orders lower, each with its standard error.
 *
 * table    release it with morphometry_release.
 * Errors   STATUS_INPUT for any other line, naming file and line, and for a table without a source
 *          or without order 1; STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status morphometry_read(Morphometry *table, const char *path, Err *err);
void morphometry_release(Morphometry *table);

/* Returns the diameter, mm, between `order`, at least 0, and `order` + 1: the mean of (D + S) of
 * `order` and (D - S) of `order` + 1, where D and S are mean and standard deviation of the diameter
 * [Jiang, Kassab & Fung 1994, as in derive.h]. It is 0 for order 0, and infinite for the last
 * order. */
double morphometry_bound_mm(const Morphometry *table, int order);

/* The quantities that are compared. */
typedef enum MorphometryMeasure {
    COMPARED_DIAMETER,
    COMPARED_LENGTH,
    COMPARED_VESSELS,          /* vessels per element */
    COMPARED_DAUGHTERS,        /* elements of the same order that branch off one element */
    COMPARED_DAUGHTERS_1_LESS, /* elements one order lower that branch off one element */
    COMPARED_DAUGHTERS_2_LESS,
    COMPARED_DAUGHTERS_3_LESS,
    COMPARED_NUMBER_RATIO, /* Horton's ratios, each one number for all orders */
    COMPARED_DIAMETER_RATIO,
    COMPARED_LENGTH_RATIO,
    MORPHOMETRY_MEASURES
} MorphometryMeasure;

/* Per MorphometryMeasure: its name and unit ("" for pure numbers). */
extern const struct MorphometryName {
    const char *name, *unit;
} morphometry_names[MORPHOMETRY_MEASURES];

/* A value of the tree and the published value. */
typedef struct MorphometryPair {
    MorphometryMeasure measure;
    int order, published_order; /* order in the tree and in the table; 0: all orders */
    double value;               /* value of the tree */
    Spread published;           /* published value; sd is NAN if none is published */
    double se;                  /* standard error of published.mean; NAN if none is published */
    double tolerance;           /* allowed difference */
    bool agrees;                /* |value - published.mean| <= tolerance */
    bool agrees_strictly;       /* agrees also with a tolerance without standard errors: the
                                 * published sd or, if none is published, MORPHOMETRY_TOLERANCE
                                 * times the published value */
} MorphometryPair;

/* The pairs of one comparison, by measure and then by rising order. Quantities that only the tree
 * or only the table has are left out. Daughters are left out for an order of which only one element
 * was published. */
typedef struct MorphometryComparison {
    MorphometryPair *pair;              /* owned; release with free() */
    size_t n;                           /* number of pairs */
    size_t agreeing, agreeing_strictly; /* number of pairs that agree, or agree strictly */
} MorphometryComparison;

/* Allowed relative difference from a published number without a standard deviation. Reason for 0.25
 * not recorded. */
#define MORPHOMETRY_TOLERANCE 0.25
/* Allowed difference from a published number with a standard error, in standard errors. Reason for
 * 2 not recorded. */
#define MORPHOMETRY_STANDARD_ERRORS 2

/* The two ways to assign the orders of a tree that are compared with a table. */
typedef enum MorphometryOrders {
    ORDERS_PUBLISHED, /* by the bounds between the published diameters [morphometry_bound_mm] */
    ORDERS_OF_TREE,   /* the tree's own diameter-defined orders, shifted to match the table */
    MORPHOMETRY_ORDERS
} MorphometryOrders;

extern const char *const morphometry_orders_names[MORPHOMETRY_ORDERS + 1]; /* NULL ends the list */

/* Compares a tree with a table, by both kinds of orders.
 *
 * Published orders: morphometry_bound_mm is the bound between two orders. A vessel has the order of
 * its diameter, or the largest order of its daughters if that is higher.
 *
 * Orders of the tree: a tree rarely covers a whole organ, so order k of the tree is compared with
 * the published order k + shift. Only shifts are tried at which all orders of the tree, or all
 * orders of the table, have a counterpart. The shift with the smallest mean squared logarithm of
 * the ratio of mean diameters is used; if several are equal, the lowest of them.
 *
 * Horton's ratios of the tree are computed from the orders `fitted_from` and above, which also gave
 * the published ratios. The tolerance of a value is the published standard deviation. If none is
 * published, it is MORPHOMETRY_TOLERANCE times the published value, or MORPHOMETRY_STANDARD_ERRORS
 * standard errors, whichever is larger.
 *
 * statistics  the statistics of `tree` [derive_statistics].
 * comparison  per MorphometryOrders: receives the pairs; the caller frees each `pair`, also after
 *             an error.
 * Errors      STATUS_MEMORY. */
MUST_CHECK Status morphometry_compare(const Tree *tree, const TreeStatistics *statistics,
                                      const Morphometry *table,
                                      MorphometryComparison comparison[MORPHOMETRY_ORDERS],
                                      Err *err);

#endif
