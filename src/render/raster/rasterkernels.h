/* The kernels of the raster engine. A kernel processes several samples of a tile at once; there is
 * one version for each instruction set. The raster engine calls `trace` for a tile and, if any
 * sample hits an item, `resolve`. raster_shadows calls `cover`.
 *
 * Kernels process blocks of as many samples as the instruction set has lanes, at most 16. They do
 * not read or write past the ends of arrays of TILE_SAMPLES elements; where they access other
 * arrays past the end, the contract says so. Nothing is allocated, and nothing can fail. */
#ifndef CORCAST_RENDER_RASTER_RASTERKERNELS_H
#define CORCAST_RENDER_RASTER_RASTERKERNELS_H

#include "render/light/shadowengine.h"
#include "render/raster/rastertile.h"

/* The kernels for one instruction set. */
typedef struct RasterKernels {
    /* Finds the first item at each sample; what single precision cannot decide is decided in double
     * precision. Returns a bit mask: bit i is set if sample i hits an item. Reads tile->list[0 ..
     * n), and the members of the bins that raster_intersect reads.
     *
     * hits     receives the items and their depths.
     * surface  receives the normals of spheres and cylinders; its other members are not set. */
    uint64_t (*trace)(const RasterTile *tile, RasterHits *hits, TileHits *surface);
    /* Completes the result of `trace`, for the same tile and hits.
     *
     * hits     for joints, the index of the item is replaced by the index of the primitive.
     * surface  receives state, z, the index of the primitive (in `segment`), and the normals of
     *          joints and of samples that were decided in double precision. any_hit and any_unsure
     *          are not changed. */
    void (*resolve)(const RasterTile *tile, RasterHits *hits, TileHits *surface);
    /* Answers the shadow queries of the points in one tile of a light view: sets points->state to 1
     * for a point in shadow, 0 for a lit point.
     *
     * Per point: if points->item is a sphere or a cylinder whose hit was found in single precision,
     * this item does not shadow the point, because rounding may put the point inside it.
     *
     * tile     tile->list contains n indices of items, then the n packed boxes of these items
     *          [RasterBox.box]; tile->nears contains their n depths. Up to 15 elements past the
     *          end of both arrays are read and ignored.
     * points   elements past the last point are overwritten, up to a multiple of the lanes. */
    void (*cover)(const RasterTile *tile, ShadowPoints *points);
} RasterKernels;

DECLARE_KERNELS(RasterKernels, rasterkernels);
/* One entry per instruction set, in the order of tilekernels [tilekernels.h]. */
extern const RasterKernels *const rasterkernels[KINDS_OF_KERNELS];

#endif
