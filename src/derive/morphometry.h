/* Published morphometry of arterial trees, and its comparison with a tree. */
#ifndef CORCAST_DERIVE_MORPHOMETRY_H
#define CORCAST_DERIVE_MORPHOMETRY_H

#include "base/base.h"
#include "derive/statistics.h"
#include <stdbool.h>
#include <stddef.h>

/* A published table has the daughters of an element that are 0 to 3 orders lower. */
enum { DAUGHTER_ORDERS = 4 };

/* One diameter-defined Strahler order of a published table. A value that is not published is NAN,
 * and so is the standard deviation of a single element. */
typedef struct MorphometryRow {
    Spread diameter_mm, length_mm; /* of the elements */
    double elements;
    Spread vessels_per_element;
    /* [k]: elements k orders lower that branch off one element. */
    double daughters[DAUGHTER_ORDERS];
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
 *     12 numbers for each order, from 1    (micrometres, millimetres; "nan": not published)
 *     # comment
 *
 * Release *table with morphometry_release. Errors: STATUS_INPUT for any other line, naming file and
 * line; STATUS_IO, STATUS_MEMORY. */
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
    double room;                /* allowed difference */
    bool agrees;                /* |value - published.mean| <= room */
} MorphometryPair;

/* The pairs, by measure and then by rising order. Quantities that only one of the two has are left
 * out. */
typedef struct MorphometryComparison {
    MorphometryPair *pair; /* owned; free */
    size_t n;
    size_t agreeing;
} MorphometryComparison;

/* Allowed relative difference from a published number without a standard deviation. */
#define MORPHOMETRY_ROOM 0.25

/* Compares a tree's diameter-defined orders with a table.
 *
 * A tree rarely covers a whole organ, so order k of the tree is compared with the published
 * order k + shift. Among the shifts for which the most orders have a counterpart, the shift is the
 * one with the least mean squared logarithm of the ratio of mean diameters. Horton's ratios of the
 * tree are computed from the orders that also gave the published ratios. A number agrees if it is
 * within the published standard deviation; if there is none, within MORPHOMETRY_ROOM of the
 * published value.
 *
 * comparison  its `pair` is owned by the caller.
 * Errors      STATUS_MEMORY. */
MUST_CHECK Status morphometry_compare(const TreeStatistics *statistics, const Morphometry *table,
                                      MorphometryComparison *comparison, Err *err);

#endif
