/* Statistics of a tree by bifurcation level and by order. */
#ifndef CORCAST_DERIVE_STATISTICS_H
#define CORCAST_DERIVE_STATISTICS_H

#include "base/base.h"
#include "tree/tree.h"
#include <stdbool.h>
#include <stddef.h>

/* A vessel is the chain of segments between two branchings. The morphometric literature calls it a
 * segment. Its radius is the mean of the segments' radii, weighted by length. An element is a
 * series of vessels of the same order, each continued by its thickest daughter of that order. The
 * length of an element is the sum of the vessels' lengths, and its radius the mean of their radii.
 */

/* Mean and standard deviation (of a sample: n - 1). sd is 0 for one value, and NAN for none. */
typedef struct Spread {
    double mean, sd;
} Spread;

/* The vessels of one bifurcation level, or the elements of one order. */
typedef struct StatisticsRow {
    int number;                  /* the level, or the order */
    size_t vessels;              /* of that level or order */
    size_t elements;             /* at a level, every vessel is an element */
    Spread radius_mm, length_mm; /* of the elements */
} StatisticsRow;

typedef struct StatisticsTable {
    StatisticsRow *row; /* by rising number; only levels and orders with vessels; owned */
    size_t n;
} StatisticsTable;

/* Horton's ratios of the elements: number ~ ratio^-n, diameter and length ~ ratio^n for order n.
 * They are fitted by least squares to the logarithms of numbers and means, with equal weights for
 * all orders [Horton, Geol. Soc. Am. Bull. 56 (1945) 275-370]. A mean of 0 is left out. A ratio is
 * NAN if there are fewer than two orders. */
typedef struct OrderRatios {
    double number, diameter, length;
} OrderRatios;

/* The distribution of a number over bifurcations. */
typedef struct BifurcationSpread {
    size_t count;
    double mean, sd, median; /* NAN if count is 0 */
} BifurcationSpread;

/* A vessel, as a row of a table. */
typedef struct VesselRow {
    int32_t start, end; /* nodes: its ends; equal in a vessel that closes a loop alone */
    double radius_mm, length_mm;
    double chord_mm; /* distance between its ends */
} VesselRow;

typedef struct TreeStatistics {
    size_t vessels;
    VesselRow *vessel; /* per vessel; owned */
    uint8_t *degree;   /* per node: number of segments that meet there, at most 255; 0 for a node
                        * with a link, which is the same point as another node; owned */
    size_t nodes_of_degree[READ_MAX_DEGREE + 1]; /* the last entry counts higher degrees, too */
    bool has_orders;   /* false for a network with links: without Strahler orders, symmetry and area
                        * ratio, because its vessels have no daughters */
    double volume_mm3; /* sum of pi r^2 l over the segments */
    StatisticsTable by_level, by_strahler, by_diameter_strahler;
    OrderRatios strahler_ratios, diameter_strahler_ratios;
    int diameter_rounds;            /* rounds of assigning diameter orders */
    bool diameter_orders_converged; /* false if the rounds were stopped */
    /* Connectivity of the diameter orders [Jiang, Kassab & Fung 1994, as in derive.h]. Entry
     * (m - 1) n + k - 1, with n = by_diameter_strahler.n, is the mean number of elements of order k
     * that branch off an element of order m. Owned. */
    double *daughters;
    BifurcationSpread symmetry;   /* radius of the thinnest daughter over that of the thickest */
    BifurcationSpread area_ratio; /* sum of r^2 of the daughters over that of the parent */
} TreeStatistics;

/* Computes the statistics of a tree. The symmetry leaves out bifurcations whose thickest daughter
 * has no radius; the area ratio leaves out roots, and bifurcations whose parent has no radius.
 * Release *statistics with statistics_release. Errors: STATUS_MEMORY. */
MUST_CHECK Status derive_statistics(const Tree *tree, TreeStatistics *statistics, Err *err);
void statistics_release(TreeStatistics *statistics);

/* Computes the elements of the orders that n bounds of diameter define. A vessel has the order 1 +
 * the number of bounds below its diameter, or the largest order of its daughters if that is higher.
 *
 * elements   receives a row for each order that has vessels; the caller frees `row`.
 * daughters  receives the connectivity as in TreeStatistics, where n is the last row's order;
 *            owned by the caller.
 * Errors     STATUS_MEMORY. */
MUST_CHECK Status statistics_by_bounds(const Tree *tree, const double *bound_mm, size_t n,
                                       StatisticsTable *elements, double **daughters, Err *err);

/* Computes the ratios from the rows with numbers `first` to `last`. */
OrderRatios statistics_ratios(const StatisticsTable *table, int first, int last);

#endif
