/* What is done to a tile of primitives several samples at once, in one version for each kind of
 * processor. Kernels read and write whole blocks of as many samples as a processor has lanes, 16 at
 * most: of arrays of TILE_SAMPLES nothing else is touched, what reaches farther says so. */
#ifndef CORCAST_RENDER_RASTERKERNELS_H
#define CORCAST_RENDER_RASTERKERNELS_H

#include "render/light/shadowengine.h"
#include "render/raster/rastertile.h"

typedef struct RasterKernels {
    /* Finds the first item at each sample, in *hits, and where that is a sphere or a cylinder the
     * normal, in surface->normal; nothing else of *surface is set. Bit i of what is returned is set
     * if sample i sees an item. Reads tile->list[0 .. n), and of the bins what raster_decide
     * does. */
    uint64_t (*trace)(const RasterTile *tile, RasterHits *hits, TileHits *surface);
    /* Completes *surface after `trace` with the same tile and hits: state, z, the primitive's
     * number (as `segment`), and the normals of joints and of what was decided in double precision;
     * leaves any_hit and any_unsure alone. Of joints, completes *hits. */
    void (*resolve)(const RasterTile *tile, RasterHits *hits, TileHits *surface);
    /* The places that the hits are at. */
    void (*locate)(const RasterTile *tile, const RasterHits *hits, HitPoints *points);
    /* Answers the queries of points in one tile of a light view: sets points->state. Overwrites
     * what follows the last point, up to a multiple of the lanes. If points->item is a sphere or a
     * cylinder whose hit was found in single precision, it is not tested as a blocker of its point:
     * rounding would let it shadow itself. tile->list holds, behind its n items, their n boxes
     * [RasterBox], and `nears` their depths. Of both, up to 15 words past the end are read and
     * ignored. */
    void (*cover)(const RasterTile *tile, ShadowPoints *points);
} RasterKernels;

extern const RasterKernels rasterkernels_portable;
#ifdef __x86_64__
extern const RasterKernels rasterkernels_avx2, rasterkernels_avx512;
#endif
/* As tilekernels. */
extern const RasterKernels *const rasterkernels[KINDS_OF_KERNELS];

#endif
