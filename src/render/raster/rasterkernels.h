/* What is done to a tile of primitives several samples at once, in one version for each kind of
 * processor. Kernels read and write whole blocks of as many samples as a processor has lanes, 16 at
 * most: of arrays of TILE_SAMPLES nothing else is touched, what reaches farther says so. */
#ifndef CORCAST_RENDER_RASTERKERNELS_H
#define CORCAST_RENDER_RASTERKERNELS_H

#include "render/light/shadowqueue.h"
#include "render/raster/rastertile.h"

/* Lines of sight of a light through places, all in one tile of its view, and depths on them. */
typedef struct ShadowQueries {
    int n;
    float *x, *y;            /* in the plane of the view, less the tile's middle; POINT_CAPACITY */
    float z[POINT_CAPACITY]; /* less z_middle */
    /* Number of the primitive whose surface the place lies on, as in RasterHits. If that is a
     * sphere or a cylinder whose hit was found in single precision, it is not tested as a blocker
     * of this place: rounding would let it shadow itself. */
    uint32_t item[POINT_CAPACITY];
    uint8_t covered[POINT_CAPACITY]; /* 1 where an item is seen before that depth, else 0 */
} ShadowQueries;

typedef struct RasterKernels {
    /* Finds the first item at each sample, in *hits, and where that is a sphere or a cylinder the
     * normal, in surface->normal; nothing else of *surface is set. Bit i of what is returned is set
     * if sample i sees an item. Reads tile->list[0 .. n), and of the bins what raster_decide
     * does. */
    uint64_t (*trace)(const RasterTile *tile, RasterHits *hits, TileHits *surface);
    /* Completes *surface after `trace` with the same tile and hits: state, z, the primitive's number
     * (as `segment`), and the normals of joints and of what was decided in double precision; leaves
     * any_hit and any_unsure alone. Of joints, completes *hits. */
    void (*resolve)(const RasterTile *tile, RasterHits *hits, TileHits *surface);
    /* The places that the hits are at. */
    void (*locate)(const RasterTile *tile, const RasterHits *hits, SeenPlaces *places);
    /* Sets `covered` of the queries, all of which lie in this tile of a light, and overwrites what
     * follows the last of them up to a multiple of the lanes. tile->list holds, behind its n items,
     * their n boxes [RasterBox], and `nears` their depths: of both, up to 15 words behind the end
     * are read and ignored. */
    void (*cover)(const RasterTile *tile, ShadowQueries *queries);
} RasterKernels;

extern const RasterKernels rasterkernels_portable;
#ifdef __x86_64__
extern const RasterKernels rasterkernels_avx2, rasterkernels_avx512;
#endif
/* As tilekernels. */
extern const RasterKernels *const rasterkernels[KINDS_OF_KERNELS];

#endif
