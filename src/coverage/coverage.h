/* The public header of the module coverage: how far tissue is from the nearest vessel.
 *
 * The tissue is the part of a domain outside the vessels. Voxel centres sample it; the distance of
 * each is exact, not a distance between voxels.
 *
 *     TRY(coveragegrid_make(&domain, 0.25, &params.grid, err));
 *     TRY(coverage_measure(&params, &report, err));
 *     double median = coverage_quantile(&report, 0.5);
 *     coveragereport_release(&report); */
#ifndef CORCAST_COVERAGE_COVERAGE_H
#define CORCAST_COVERAGE_COVERAGE_H

#include "domain/domain.h"
#include "voxel/voxel.h"

/* Makes the grid of cubic voxels of side `mm` > 0 over a domain. Centres of voxels are at multiples
 * of `mm`, as in voxelgrid_make. A domain of two dimensions has one layer of voxels. Errors:
 * STATUS_INFEASIBLE if a side would have 2^31 voxels or more. */
MUST_CHECK Status coveragegrid_make(const Domain *domain, double mm, VoxelGrid *out, Err *err);

/* Number of bins of CoverageReport.bin. */
enum { COVERAGE_BINS = 1 << 18 };

/* What is measured. All pointers are borrowed. */
typedef struct CoverageParams {
    const Domain *domain;
    VoxelGrid grid;
    const DomainTube *tubes; /* the vessels, n_tubes >= 1, mm */
    size_t n_tubes;
    const double *beyond; /* distances for CoverageReport.beyond, mm */
    size_t n_beyond;
    /* Points whose nearest one decides the territory of a voxel; NULL: the nearest tube decides. */
    const DomainTube *outlets;
    size_t n_outlets;
    const uint32_t *labels;  /* per outlet, or per tube: label of its territory, above 0; NULL: no
                              * territories */
    VolumeStream *distances; /* receives the distance of each voxel, mm: SAMPLE_FLOAT, 0 in vessels,
                              * NAN outside the domain; NULL: not wanted */
    VolumeStream *territories; /* receives the label of each voxel, 0 outside the domain: SAMPLE_16
                                * or SAMPLE_32; needs `labels`; NULL: not wanted */
    int threads;               /* number of threads; 0: one per processor */
    bool (*progress)(double fraction, void *context); /* returns false to stop; NULL: none */
    void *context;                                    /* passed to `progress` */
} CoverageParams;

/* The result. Volumes are in mm^3, or in mm^2 for a domain of two dimensions. */
typedef struct CoverageReport {
    int64_t tissue_voxels;
    double voxel_volume, tissue_volume, vessel_volume;
    double mean_mm;     /* mean distance of the tissue; NAN without tissue */
    int64_t *beyond;    /* per distance of `beyond`: tissue voxels farther than it; owned */
    int64_t *bin;       /* histogram of the tissue's distances, COVERAGE_BINS bins; owned */
    double bin_mm;      /* width of a bin; the first one begins at 0 */
    int64_t *territory; /* per outlet, or per tube: tissue voxels of its territory; NULL without
                         * `labels`; owned */
    double largest_mm;  /* largest distance of any point of the tissue; NAN without tissue */
    double largest_error_mm; /* bound of the error of largest_mm, which is never too large */
    Vec3 largest_at;         /* centre of the largest empty ball, mm */
} CoverageReport;

/* Returns the expected memory of coverage_measure in bytes. */
double coverage_memory(const CoverageParams *params);

/* Measures the distances, and writes and ends the streams, which the caller has begun.
 *
 * report   receives the result; release it with coveragereport_release. It does not depend on
 *          `threads`, nor do the bytes of the streams.
 * Errors   STATUS_CANCELLED if `progress` returned false; STATUS_IO, STATUS_MEMORY.
 * Cost     about 6 distances per voxel of the domain. Memory for a layer of 16 voxels. */
MUST_CHECK Status coverage_measure(const CoverageParams *params, CoverageReport *report, Err *err);
void coveragereport_release(CoverageReport *report);

/* Returns the distance within which the fraction `part`, in [0, 1], of the tissue is; accurate to
 * report->bin_mm. NAN without tissue. */
double coverage_quantile(const CoverageReport *report, double part);

/* The distances in trees grown in a volume, as multiples of the spacing of their terminals s =
 * (volume / terminals)^(1/3). Measured in grown trees of 5,000 and 500,000 terminals, which agree
 * to 1 % in the first two; the largest void, a single place, differs by 13 %. */
#define COVERAGE_LAW_MEAN 0.377
#define COVERAGE_LAW_95 0.675
#define COVERAGE_LAW_LARGEST 1.23

#endif
