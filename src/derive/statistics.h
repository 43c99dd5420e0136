/* Computes statistics of a tree by bifurcation level and by order: derive_statistics.
 *
 * A vessel is the chain of segments between two bifurcations, roots or terminals. The morphometric
 * literature calls it a segment. Its radius is the mean of the segments' radii, weighted by length.
 * An element is a series of vessels of the same order, each continued by its thickest daughter of
 * that order. The length of an element is the sum of the vessels' lengths, and its radius the mean
 * of their radii. Levels and orders are defined in derive.h. */
#ifndef CORCAST_DERIVE_STATISTICS_H
#define CORCAST_DERIVE_STATISTICS_H

#include "base/base.h"
#include "tree/tree.h"
#include <stdbool.h>
#include <stddef.h>

/* Mean and standard deviation (of a sample: n - 1). sd is 0 for one value. NAN: not known. */
typedef struct Spread {
    double mean, sd;
} Spread;

/* The vessels of one bifurcation level, or the elements of one order. */
typedef struct StatisticsRow {
    int number;                  /* the level, or the order */
    size_t vessels;              /* number of vessels of the level or order */
    size_t elements;             /* number of elements; at a level, every vessel is an element */
    Spread radius_mm, length_mm; /* radius and length of the elements */
} StatisticsRow;

/* The rows of all levels, or of all orders. */
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

/* The distribution of a quantity over the bifurcations. */
typedef struct BifurcationSpread {
    size_t count;            /* number of bifurcations that have the quantity */
    double mean, sd, median; /* NAN if count is 0 */
} BifurcationSpread;

/* A vessel, as a row of a table. */
typedef struct VesselRow {
    int32_t start, end; /* indices of the nodes at its ends; equal if the vessel alone is a loop */
    double radius_mm, length_mm;
    double chord_mm; /* distance between its ends */
} VesselRow;

/* The result of derive_statistics. */
typedef struct TreeStatistics {
    size_t vessels;    /* number of vessels */
    VesselRow *vessel; /* per vessel; owned */
    uint8_t *degree;   /* per node: number of segments that meet there, at most 255; 0 for a node
                        * with a link, which is the same point as another node; owned */
    size_t nodes_of_degree[READ_MAX_DEGREE + 1]; /* the last entry counts higher degrees, too */
    bool has_orders;   /* false for a network with links, whose vessels have no daughters: it has no
                        * Strahler orders, symmetry and area ratio */
    double volume_mm3; /* sum of pi r^2 l over the segments */
    StatisticsTable by_level, by_strahler, by_diameter_strahler;
    OrderRatios strahler_ratios, diameter_strahler_ratios;
    int diameter_rounds;            /* number of rounds in which diameter orders were assigned */
    bool diameter_orders_converged; /* false: stopped after 100 rounds */
    /* Connectivity of the diameter orders [Jiang, Kassab & Fung 1994, as in derive.h]. Entry (m -
     * 1) n + k - 1 is the mean number of elements of order k that branch off an element of order m.
     * n is the highest order; diameter orders have no gaps, so n = by_diameter_strahler.n.
     * Owned. */
    double *daughters;
    BifurcationSpread symmetry;   /* radius of the thinnest daughter / radius of the thickest */
    BifurcationSpread area_ratio; /* sum of r^2 of the daughters / r^2 of the parent */
} TreeStatistics;

/* Computes the statistics of a tree. The symmetry leaves out bifurcations whose thickest daughter
 * has no radius; the area ratio leaves out roots, and bifurcations whose parent has no radius.
 * Release *statistics with statistics_release. Errors: STATUS_MEMORY. */
MUST_CHECK Status derive_statistics(const Tree *tree, TreeStatistics *statistics, Err *err);
void statistics_release(TreeStatistics *statistics);

/* Computes the elements of orders that are defined by n diameters: a vessel has the order 1 + the
 * number of entries of `bound_mm` below its diameter, or the largest order of its daughters if that
 * is higher.
 *
 * bound_mm   n diameters, rising.
 * elements   receives a row for each order that has vessels; the caller frees `row`.
 * daughters  receives the connectivity as TreeStatistics.daughters: m x m entries, where m is the
 *            order of the last row; the caller frees it.
 * Errors     STATUS_MEMORY. */
MUST_CHECK Status statistics_by_bounds(const Tree *tree, const double *bound_mm, size_t n,
                                       StatisticsTable *elements, double **daughters, Err *err);

/* Computes Horton's ratios from the rows whose numbers are in [first, last]. */
OrderRatios statistics_ratios(const StatisticsTable *table, int first, int last);

#endif
