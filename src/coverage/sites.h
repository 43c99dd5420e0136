/* The nearest of many tubes or points, for every voxel of a block.
 *
 * A site is a tube with hemispherical ends; a tube without length and radius is a point. The
 * distance to a site is the distance to its wall, and is below 0 inside it. Private to the module
 * coverage. */
#ifndef CORCAST_COVERAGE_SITES_H
#define CORCAST_COVERAGE_SITES_H

#include "base/base.h"
#include "coverage/coverage.h"
#include "geom/geom.h"

typedef struct VesselSite {
    Vec3 from, along;       /* start of the axis, and from there to its end, mm */
    double inverse_length2; /* 1 / |along|^2; 0 for a point */
    double radius_mm;
} VesselSite;

/* The sites and a tree of their boxes, both owned. */
typedef struct Sites {
    VesselSite *site;
    size_t n;
    BoxTree tree;
} Sites;

/* Builds the sites of n >= 1 tubes; release *out with sites_release. Errors: STATUS_MEMORY. */
MUST_CHECK Status sites_make(const DomainTube *tubes, size_t n, Sites *out, Err *err);
void sites_release(Sites *sites);

/* Returns the distance of a point from the wall of a site, mm. */
static inline double site_distance(const VesselSite *site, Vec3 point)
{
    Vec3 apart = vec3_sub(point, site->from);
    double t = vec3_dot(apart, site->along) * site->inverse_length2;
    return vec3_length(vec3_add_scaled(apart, site->along, -box_min(box_max(t, 0), 1))) -
           site->radius_mm;
}

/* Returns the distance of a point from the nearest site, mm. If that is `enough_mm` or less, may
 * return the distance of any site that is at most so far. */
double sites_nearest(const Sites *sites, Vec3 point, double enough_mm);

/* Workspace of one thread: a stack of lists of sites, with the distance of each. Zero it before
 * first use; release it with sitelists_release. */
typedef struct SiteLists {
    ARRAY(uint32_t) site;
    ARRAY(double) distance;
} SiteLists;

void sitelists_release(SiteLists *lists);

/* A list of the stack. */
typedef struct SiteRange {
    size_t first, n;
} SiteRange;

/* The nearest site of a point; on a tie, the one with the lowest index. */
typedef struct Nearest {
    double distance_mm;
    uint32_t site;
} Nearest;

/* Points around a centre. */
typedef struct SiteBall {
    Vec3 centre;
    double radius_mm;  /* largest distance of a point from the centre */
    double nearest_mm; /* distance of the centre from the nearest site */
} SiteBall;

/* Pushes the sites that may be the nearest one of a point in a ball. Errors: STATUS_MEMORY. */
MUST_CHECK Status sitelists_gather(SiteLists *lists, const Sites *sites, const SiteBall *ball,
                                   SiteRange *out, Err *err);
/* Returns the nearest site of `list` at a point, and stores the distances of all of them. */
Nearest sitelists_measure(SiteLists *lists, const Sites *sites, SiteRange list, Vec3 point);
/* Pushes the sites of a measured list that are at most `most_mm` away. The caller pops them by
 * resetting both lengths to the end of `list`. Errors: STATUS_MEMORY. */
MUST_CHECK Status sitelists_narrow(SiteLists *lists, SiteRange list, double most_mm, SiteRange *out,
                                   Err *err);
/* Pops all lists above `list`. */
static inline void sitelists_pop(SiteLists *lists, SiteRange list)
{
    lists->site.n = lists->distance.n = list.first + list.n;
}

/* Voxels [low, high) along each axis of a grid. */
typedef struct VoxelBlock {
    int64_t low[3], high[3];
} VoxelBlock;

/* A search for the nearest site of each wanted voxel of a block, at the voxel's centre. All
 * pointers are borrowed. */
typedef struct SiteFilling {
    const Sites *sites;
    SiteLists *lists;
    const VoxelGrid *grid;
    const VoxelBlock *block;
    const bool *wanted; /* per voxel of the block, x fastest */
    Nearest *nearest;   /* receives the result per wanted voxel */
} SiteFilling;

/* Fills filling->nearest. `nearest_mm` is sites_nearest of block_centre. Errors: STATUS_MEMORY. */
MUST_CHECK Status sites_fill(const SiteFilling *filling, double nearest_mm, Err *err);

/* Return the middle of the voxel centres of a block, and the largest distance of one from it. */
Vec3 block_centre(const VoxelGrid *grid, const VoxelBlock *block);
double block_reach(const VoxelGrid *grid, const VoxelBlock *block);

#endif
