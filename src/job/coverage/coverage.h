/* The operation `coverage`: measures how far the tissue that a tree supplies is from the nearest
 * vessel. Call coverage_make, then coverage_json or read the result, then coverageresult_release.
 */
#ifndef CORCAST_JOB_COVERAGE_COVERAGE_H
#define CORCAST_JOB_COVERAGE_COVERAGE_H

#include "coverage/coverage.h"
#include "options/options.h"

extern const Command command_coverage;

/* The distances that are expected in a tree that corcast grew with as many terminals per volume
 * [COVERAGE_LAW_MEAN, coverage/coverage.h]. They are reported beside the measured distances. All
 * members are NAN in two dimensions. */
typedef struct CoverageLaw {
    /* mean, 95 % quantile and maximum of the distance between a point of the tissue and the
     * nearest vessel */
    double mean_mm, within_95_mm, largest_mm;
    /* number of terminals per mm^3 at which 95 % of the tissue is expected to be within the
     * distance d of a vessel, where d is the last number of CoverageResult.beyond */
    double density_needed;
} CoverageLaw;

/* The result of the operation. */
typedef struct CoverageResult {
    CoverageReport report; /* owned */
    NumberList beyond;     /* the distances d, mm, for which `report` has the fraction of the tissue
                            * that is farther than d from the nearest vessel; increasing */
    size_t terminals;      /* number of terminals of the tree */
    double spacing_mm;     /* side of a voxel */
    int dimension;         /* dimension of the domain, 2 or 3 */
    CoverageLaw law;
} CoverageResult;

/* Reads the tree, which is the first operand, and the domain. Measures the distances, and writes
 * the files that the options name.
 *
 * options  parsed->options, the struct that the options of command_coverage set.
 * result   is overwritten; release it with coverageresult_release even after an error.
 * Errors   STATUS_USAGE if an output is not a volume file, if the numbers of the option `beyond`
 *          are not increasing, if the voxels are too large for the domain, or if the domain's text
 *          is wrong; STATUS_INPUT if the tree cannot be used, if neither the options nor the tree
 *          state a domain, if no vessel is in the domain, or if the vessels fill it; STATUS_IO;
 *          STATUS_CANCELLED; STATUS_MEMORY. */
MUST_CHECK Status coverage_make(void *options, Parsed *parsed, CoverageResult *result, Err *err);
/* Returns the result as a JSON object: a new reference, or NULL if memory runs out. `command` is
 * the command line, which the object contains as its provenance. */
json_t *coverage_json(const CoverageResult *result, const char *command);
void coverageresult_release(CoverageResult *result);

#endif
