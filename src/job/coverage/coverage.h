/* The operation `coverage`: measures how far the tissue that a tree supplies is from the nearest
 * vessel. */
#ifndef CORCAST_JOB_COVERAGE_COVERAGE_H
#define CORCAST_JOB_COVERAGE_COVERAGE_H

#include "coverage/coverage.h"
#include "options/options.h"

extern const Command command_coverage;

/* Distances expected in a grown tree with the same density of terminals [COVERAGE_LAW_MEAN], for
 * comparison with the measured distances. All members are NAN in two dimensions. */
typedef struct CoverageLaw {
    double mean_mm, within_95_mm, largest_mm; /* mean, 95 % quantile and maximum of the distance */
    double density_needed; /* terminals per mm^3 that bring 95 % of the tissue within the largest
                            * distance of CoverageResult.beyond */
} CoverageLaw;

/* What the command prints. */
typedef struct CoverageResult {
    CoverageReport report; /* owned */
    NumberList beyond;     /* the distances of report.beyond, mm, increasing */
    size_t terminals;      /* number of terminals of the tree */
    double spacing_mm;     /* side of a voxel */
    int dimension;         /* dimension of the domain, 2 or 3 */
    CoverageLaw law;
} CoverageResult;

/* Reads the tree, which is the first operand, and the domain. Measures the distances, and writes
 * the files that the options name.
 *
 * options  the options that command_coverage sets.
 * result   is overwritten; release it with coverageresult_release even after an error.
 * Errors   STATUS_USAGE if an output has no format of volumes, if `beyond` does not increase, or if
 *          the voxels are too large for the domain; STATUS_INPUT if neither the options nor the
 *          tree state a domain, if no vessel is in the domain, or if the vessels fill it; the
 *          errors of reading_tree, tree_domain_parse, volume_check, work_make, coverage_measure
 *          and work_write; STATUS_MEMORY. */
MUST_CHECK Status coverage_make(void *options, Parsed *parsed, CoverageResult *result, Err *err);
/* Returns the result as JSON: a new reference; NULL if memory runs out. `command` is the command
 * line for provenance. */
json_t *coverage_json(const CoverageResult *result, const char *command);
void coverageresult_release(CoverageResult *result);

#endif
