/* Statistics of a tree by bifurcation level and by order. */
#ifndef CORCAST_DERIVE_STATISTICS_H
#define CORCAST_DERIVE_STATISTICS_H

#include "base/base.h"
#include "tree/tree.h"
#include <stdbool.h>
#include <stddef.h>

/* A vessel is the chain of segments between two branchings, which the morphometric literature calls
 * a segment; its radius is the mean weighted by length. An element is a series of vessels of the
 * same order, each continued by the thickest daughter of its order; its length is their sum and its
 * radius their mean. */

/* Mean and standard deviation, that of a sample (n - 1); 0 for one value, NAN for none. */
typedef struct Spread {
    double mean, sd;
} Spread;

/* The vessels of one bifurcation level, or the elements of one order. */
typedef struct StatisticsRow {
    int number;                  /* the level, or the order */
    size_t vessels;              /* of that level or order */
    size_t elements;             /* at a level every vessel is one */
    Spread radius_mm, length_mm; /* of the elements */
} StatisticsRow;

typedef struct StatisticsTable {
    StatisticsRow *row; /* owned; upwards, levels and orders without vessels left out */
    size_t n;
} StatisticsTable;

/* How number, diameter and length of the elements go with their order n, from straight lines
 * through the logarithms of their numbers and means by least squares, all orders weighing alike
 * [Horton, Geol. Soc. Am. Bull. 56 (1945) 275-370]: numbers as ratio^-n, diameters and lengths as
 * ratio^n. NAN with fewer than two orders; a mean of 0 is left out. */
typedef struct OrderRatios {
    double number, diameter, length;
} OrderRatios;

/* One number at each of some bifurcations. */
typedef struct BifurcationSpread {
    size_t count;
    double mean, sd, median; /* NAN when count is 0 */
} BifurcationSpread;

typedef struct TreeStatistics {
    size_t vessels;
    double volume_mm3; /* sum of pi r^2 l over the segments */
    StatisticsTable by_level, by_strahler, by_diameter_strahler;
    OrderRatios strahler_ratios, diameter_strahler_ratios;
    int diameter_rounds;            /* of assignment */
    bool diameter_orders_converged; /* false when they were given up */
    /* Connectivity of the diameter orders [Jiang, Kassab & Fung 1994, as in derive.h]:
     * entry (m - 1) n + k - 1, n = by_diameter_strahler.n, is the mean number of elements of order
     * k that spring from an element of order m. Owned. */
    double *daughters;
    BifurcationSpread symmetry;   /* radius of the thinnest daughter over that of the thickest */
    BifurcationSpread area_ratio; /* sum of r^2 of the daughters over that of the parent */
} TreeStatistics;

/* Fills *statistics (owned; statistics_release). Bifurcations whose thickest daughter, or whose
 * parent, has no radius are left out of the ratio concerned; so is a root in the area ratio. */
MUST_CHECK Status derive_statistics(const Tree *tree, TreeStatistics *statistics, Err *err);
void statistics_release(TreeStatistics *statistics);

/* The ratios over the rows numbered `first` to `last` alone. */
OrderRatios statistics_ratios(const StatisticsTable *table, int first, int last);

#endif
