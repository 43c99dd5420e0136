/* Published morphometry of arterial trees, and how a tree compares with it. */
#ifndef CORCAST_DERIVE_MORPHOMETRY_H
#define CORCAST_DERIVE_MORPHOMETRY_H

#include "base/base.h"
#include "derive/statistics.h"
#include <stdbool.h>
#include <stddef.h>

/* How many orders below its own a published table says the daughters of an element of: 0 .. 3. */
enum { DAUGHTERS_SAID = 4 };

/* One diameter-defined Strahler order of a published table. Whatever is not published is NAN; so is
 * a standard deviation of a single element. */
typedef struct MorphometryRow {
    Spread diameter_mm, length_mm; /* of the elements */
    double elements;
    Spread vessels_per_element;
    double daughters[DAUGHTERS_SAID]; /* by k: elements k orders lower that spring from one */
} MorphometryRow;

/* A published table: row[k] is order k + 1. */
typedef struct Morphometry {
    char *source; /* owned; author, journal, year */
    OrderRatios ratios;
    int fitted_from[3];  /* the lowest order that each of the ratios was fitted to */
    MorphometryRow *row; /* owned */
    size_t n;            /* at least 1 */
} Morphometry;

/* Reads a file of templates/morphometry: "source TEXT", "ratios NUMBER DIAMETER LENGTH",
 * "fitted-from NUMBER DIAMETER LENGTH" (1 each where there is no such line), and a line of 12
 * numbers for each order from 1 on (micrometres, millimetres; "nan" where nothing is published);
 * '#' starts a comment line. In *table (owned; morphometry_release). STATUS_INPUT
 * naming file and line on anything else. */
MUST_CHECK Status morphometry_read(Morphometry *table, const char *path, Err *err);
void morphometry_release(Morphometry *table);

/* What is compared. */
typedef enum MorphometryMeasure {
    COMPARED_DIAMETER,
    COMPARED_LENGTH,
    COMPARED_VESSELS,          /* vessels of an element */
    COMPARED_DAUGHTERS,        /* elements of the same order that spring from one */
    COMPARED_DAUGHTERS_1_LESS, /* of one order less, and so on */
    COMPARED_DAUGHTERS_2_LESS,
    COMPARED_DAUGHTERS_3_LESS,
    COMPARED_NUMBER_RATIO, /* of all orders, as the two that follow */
    COMPARED_DIAMETER_RATIO,
    COMPARED_LENGTH_RATIO,
    MORPHOMETRY_MEASURES
} MorphometryMeasure;

/* Name and unit ("" for pure numbers) of each. */
extern const struct MorphometryName {
    const char *name, *unit;
} morphometry_names[MORPHOMETRY_MEASURES];

/* One number of the tree beside the published one. */
typedef struct MorphometryPair {
    MorphometryMeasure measure;
    int order, published_order; /* 0: of all orders */
    double value;               /* the tree's */
    Spread published;           /* sd NAN where none is published */
    double room;                /* how far the two may be apart */
    bool agrees;                /* |value - published.mean| <= room */
} MorphometryPair;

/* The comparison: pairs measure by measure, orders upwards. Only what both have is compared. */
typedef struct MorphometryComparison {
    MorphometryPair *pair; /* owned; free */
    size_t n;
    size_t agreeing;
} MorphometryComparison;

/* How far a number may be from a published one without a standard deviation, as a part of it. */
#define MORPHOMETRY_ROOM 0.25

/* Compares a tree's diameter-defined orders with a table. A tree is rarely a whole organ's, so its
 * order k stands beside the published order k + shift, with the shift for which the squared
 * logarithms of the ratios of their mean diameters have the least mean over the orders that both
 * have, of which there are to be as many as can be. Ratios are those of the orders that both have
 * and that gave the published ones. Numbers agree within the published standard deviation, or where
 * there is none within MORPHOMETRY_ROOM of the published value. */
MUST_CHECK Status morphometry_compare(const TreeStatistics *statistics, const Morphometry *table,
                                      MorphometryComparison *comparison, Err *err);

#endif
