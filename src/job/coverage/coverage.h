/* Measures how far the tissue that a tree supplies is from its vessels: the operation of `corcast
 * coverage`. */
#ifndef CORCAST_JOB_COVERAGE_COVERAGE_H
#define CORCAST_JOB_COVERAGE_COVERAGE_H

#include "coverage/coverage.h"
#include "options/options.h"

extern const Command command_coverage;

/* A distance law of grown trees beside the measured distance. */
typedef struct CoverageLaw {
    double mean_mm, within_95_mm, largest_mm; /* NAN in two dimensions, and without terminals */
    double density_needed; /* terminals per mm^3 for 95 % of the tissue within beyond[last] */
} CoverageLaw;

/* What the command prints. */
typedef struct CoverageResult {
    CoverageReport report; /* owned */
    NumberList beyond;     /* the distances of report.beyond, mm */
    size_t terminals;
    double spacing_mm; /* sides of the voxels */
    int dimension;     /* of the domain */
    CoverageLaw law;
} CoverageResult;

/* The quantiles that are reported. */
enum { COVERAGE_QUANTILES = 7 };
extern const double coverage_quantiles[COVERAGE_QUANTILES];

/* Reads the tree and the domain, measures, and writes the files that the options name.
 *
 * result   receives the result; release it with coverageresult_release.
 * Errors   STATUS_USAGE for a domain or voxels that do not fit; STATUS_INPUT if the tree states no
 *          domain or is outside it; as reading_tree, tree_domain_parse, volume_check, work_make,
 *          coverage_measure and work_write. */
MUST_CHECK Status coverage_make(void *options, Parsed *parsed, CoverageResult *result, Err *err);
void coverageresult_release(CoverageResult *result);

#endif
