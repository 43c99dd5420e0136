/* The kernels that process several samples of a tile of primitives at once, in one version for each
 * instruction set. The raster engine calls `trace` for a tile and then, if a sample hits an item,
 * `resolve`. raster_shadows calls `cover`.
 *
 * Kernels read and write whole blocks of as many samples as the processor has lanes, at most 16.
 * Arrays of TILE_SAMPLES elements are not exceeded; where a kernel reads or writes farther, its
 * contract says so. Nothing is allocated, and nothing can fail. */
#ifndef CORCAST_RENDER_RASTER_RASTERKERNELS_H
#define CORCAST_RENDER_RASTER_RASTERKERNELS_H

#include "render/light/shadowengine.h"
#include "render/raster/rastertile.h"

typedef struct RasterKernels {
    /* Finds the first item at each sample. Returns a mask: bit i is set if sample i hits an item.
     * Reads tile->list[0 .. n), and those parts of the bins that raster_intersect reads.
     *
     * hits     receives the items and their depths.
     * surface  receives the normals of spheres and cylinders; nothing else of *surface is set. */
    uint64_t (*trace)(const RasterTile *tile, RasterHits *hits, TileHits *surface);
    /* Completes the result of `trace`, for the same tile and hits.
     *
     * hits     of joints, completes the item.
     * surface  receives state, z, the index of the primitive (in `segment`), and the normals of
     *          joints and of samples that were decided in double precision. any_hit and any_unsure
     *          are not changed. */
    void (*resolve)(const RasterTile *tile, RasterHits *hits, TileHits *surface);
    /* Answers the shadow queries of the points in one tile of a light view: sets points->state.
     *
     * If points->item is a sphere or a cylinder whose hit was found in single precision, this item
     * is not tested as a blocker of its point: rounding would let it shadow itself.
     *
     * tile     tile->list holds n items and, behind them, their n boxes [RasterBox.box];
     *          tile->nears holds their n depths. Of both, up to 15 words past the end are read and
     *          ignored.
     * points   elements past the last point are overwritten, up to a multiple of the lanes. */
    void (*cover)(const RasterTile *tile, ShadowPoints *points);
} RasterKernels;

DECLARE_KERNELS(RasterKernels, rasterkernels);
/* One entry per instruction set, in the order of tilekernels [tilekernels.h]. */
extern const RasterKernels *const rasterkernels[KINDS_OF_KERNELS];

#endif
