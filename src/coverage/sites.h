/* Finds, for every voxel of a block, the nearest of many tubes or points. Call sites_make once,
 * sites_nearest for the middle of a block, then sites_search for its voxels. Private to the module
 * coverage.
 *
 * A site is a tube with hemispherical ends; with length and radius 0 it is a point. The distance to
 * a site is the distance to its surface; it is negative inside the tube. */
#ifndef CORCAST_COVERAGE_SITES_H
#define CORCAST_COVERAGE_SITES_H

#include "base/base.h"
#include "coverage/coverage.h"
#include "geom/geom.h"

/* A site, prepared for many distances. */
typedef struct VesselSite {
    Vec3 from, along;       /* start of the axis, and the vector from the start to the end, mm */
    double inverse_length2; /* 1 / |along|^2; 0 for a point */
    double radius_mm;
} VesselSite;

/* The sites, and a hierarchy of their bounding boxes. Both are owned. */
typedef struct Sites {
    VesselSite *site;
    size_t n;
    BoxTree tree;
} Sites;

/* Builds the sites of n >= 1 tubes; release *out with sites_release. Errors: STATUS_MEMORY. */
MUST_CHECK Status sites_make(const DomainTube *tubes, size_t n, Sites *out, Err *err);
void sites_release(Sites *sites);

/* Returns the distance of a point from the surface of a site, mm; negative inside. */
static inline double site_distance(const VesselSite *site, Vec3 point)
{
    Vec3 apart = vec3_sub(point, site->from);
    double t = vec3_dot(apart, site->along) * site->inverse_length2;
    return vec3_length(vec3_add_scaled(apart, site->along, -box_min(box_max(t, 0), 1))) -
           site->radius_mm;
}

/* Returns the distance of a point from the nearest site, mm. The search stops at the first site
 * that it finds whose distance is at most `enough_mm`, and then returns this distance. -INFINITY:
 * always finds the nearest site. */
double sites_nearest(const Sites *sites, Vec3 point, double enough_mm);

/* Workspace of one thread: a stack of lists of candidate sites. The lists are stored one after the
 * other in two parallel arrays. Zero it before first use; release it with sitelists_release. */
typedef struct SiteLists {
    ARRAY(uint32_t) site; /* indices in Sites.site */
    /* Per site: its distance, mm, from the point for which the distance was last computed. */
    ARRAY(double) distance;
} SiteLists;

void sitelists_release(SiteLists *lists);

/* The nearest site of a point; on a tie, the one with the lowest index. */
typedef struct Nearest {
    double distance_mm;
    uint32_t site;
} Nearest;

/* Voxels [low, high) along each axis of a grid. */
typedef struct VoxelBlock {
    int64_t low[3], high[3];
} VoxelBlock;

/* A search for the nearest site of each wanted voxel of a block, at the voxel's centre. All
 * pointers are borrowed. */
typedef struct SiteSearch {
    const Sites *sites;
    SiteLists *lists;
    const VoxelGrid *grid;
    const VoxelBlock *block;
    const bool *wanted; /* per voxel of the block, x fastest */
    Nearest *nearest;   /* receives the result per wanted voxel */
} SiteSearch;

/* Finds the nearest site of each wanted voxel, and sets search->nearest. `nearest_mm` is the exact
 * result of sites_nearest for the block_centre of search->block. Errors: STATUS_MEMORY. */
MUST_CHECK Status sites_search(const SiteSearch *search, double nearest_mm, Err *err);

/* Returns the middle of the voxel centres of a block. */
Vec3 block_centre(const VoxelGrid *grid, const VoxelBlock *block);

#endif
