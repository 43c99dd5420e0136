/* The public header of the module coverage: measures the distance of tissue from the nearest
 * vessel.
 *
 * The tissue is the part of a domain outside the vessels. It is sampled at the centres of voxels.
 * The distance of a voxel centre is measured to the exact wall of the nearest vessel, not to the
 * nearest voxel of a vessel.
 *
 *     TRY(coveragegrid_make(&domain, 0.25, &params.grid, err));
 *     TRY(coverage_measure(&params, &report, err));
 *     double median = coverage_quantile(&report, 0.5);
 *     coveragereport_release(&report); */
#ifndef CORCAST_COVERAGE_COVERAGE_H
#define CORCAST_COVERAGE_COVERAGE_H

#include "domain/domain.h"
#include "voxel/voxel.h"

/* Makes the grid of cubic voxels of side `mm` > 0 over the bounding box of a domain. The
 * coordinates of voxel centres are multiples of `mm`, as in voxelgrid_make. A domain of two
 * dimensions has one layer of voxels. Errors: STATUS_INFEASIBLE if there would be 2^31 voxels or
 * more along an axis. */
MUST_CHECK Status coveragegrid_make(const Domain *domain, double mm, VoxelGrid *out, Err *err);

/* Number of bins of CoverageReport.bin. Quantiles have the error of one bin. Reason for 2^18 not
 * recorded. */
enum { COVERAGE_BINS = 1 << 18 };

/* The inputs of coverage_measure. All pointers are borrowed. Lengths are in mm. */
typedef struct CoverageParams {
    const Domain *domain;
    VoxelGrid grid;
    const DomainTube *tubes; /* the vessels */
    size_t n_tubes;          /* at least 1 */
    const double *beyond;    /* distances for CoverageReport.beyond */
    size_t n_beyond;
    /* Tubes of length and radius 0, such as the ends of terminals. A voxel belongs to the territory
     * of the nearest outlet. NULL: to the territory of the nearest tube of `tubes`. */
    const DomainTube *outlets;
    size_t n_outlets;
    const uint32_t *labels; /* per outlet, or per tube if `outlets` is NULL: label of its territory,
                             * above 0; NULL: territories are not computed */
    VolumeStream *distances; /* receives the distance of each voxel: SAMPLE_FLOAT, 0 in vessels, NAN
                              * outside the domain; NULL: not wanted */
    VolumeStream *territories; /* receives the label of each voxel, 0 outside the domain: SAMPLE_16
                                * or SAMPLE_32; needs `labels`; NULL: not wanted */
    int threads;               /* maximum number of threads; 0: all processors */
    bool (*progress)(double fraction, void *context); /* returns false to stop; NULL: none */
    void *context;                                    /* passed to `progress` */
} CoverageParams;

/* The result. Volumes are in mm^3, or in mm^2 for a domain of two dimensions. */
typedef struct CoverageReport {
    int64_t tissue_voxels; /* number of voxels whose centre is in the tissue */
    double voxel_volume, tissue_volume, vessel_volume;
    double mean_mm;  /* mean distance of the tissue; NAN without tissue */
    int64_t *beyond; /* per distance in CoverageParams.beyond: number of tissue voxels farther from
                      * the nearest vessel; owned */
    int64_t *bin;    /* histogram: number of tissue voxels per bin of distance, COVERAGE_BINS bins;
                      * owned */
    double bin_mm;   /* width of a bin; the first bin begins at 0 */
    int64_t *territory; /* per outlet or per tube, as `labels`: number of tissue voxels in its
                         * territory; NULL without `labels`; owned */
    double largest_mm;  /* largest distance of any point of the tissue, not only of voxel centres
                         * [farthest.h]; NAN without tissue */
    double largest_error_mm; /* the true largest distance is in [largest_mm, largest_mm +
                              * largest_error_mm] */
    Vec3 largest_at;         /* point of the tissue with the distance largest_mm, mm */
} CoverageReport;

/* Returns the expected memory of coverage_measure in bytes. */
double coverage_memory(const CoverageParams *params);

/* Measures the distances. Writes and ends the streams params->distances and params->territories,
 * which the caller has begun with volume_begin.
 *
 * report   receives the result; release it with coveragereport_release.
 * Errors   STATUS_CANCELLED if `progress` returned false; STATUS_IO, STATUS_MEMORY.
 * Threads  neither the report nor the bytes of the streams depend on their number.
 * Cost     computes about 6 distances to a tube per voxel of the domain. Stores one layer of the
 *          grid, 16 voxels high, which is also the side of the blocks that threads measure. */
MUST_CHECK Status coverage_measure(const CoverageParams *params, CoverageReport *report, Err *err);
void coveragereport_release(CoverageReport *report);

/* Returns the quantile of the distances, mm: the fraction `part`, in [0, 1], of the tissue voxels
 * is at most this far from the nearest vessel. The error is at most report->bin_mm. Returns NAN
 * without tissue. */
double coverage_quantile(const CoverageReport *report, double part);

/* Mean, 95 % quantile and maximum of the distance in trees that corcast grows in three dimensions,
 * as multiples of the spacing of the terminals, (tissue volume / number of terminals)^(1/3). The
 * values were measured in trees of 5,000 and 500,000 terminals. The means and the quantiles of
 * these trees agree to 1 %. Their maxima, which are single points, differ by 13 %. */
#define COVERAGE_LAW_MEAN 0.377
#define COVERAGE_LAW_95 0.675
#define COVERAGE_LAW_LARGEST 1.23

#endif
