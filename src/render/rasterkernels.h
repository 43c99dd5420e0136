/* What is done to a tile of primitives several samples at once, in one version for each kind of
 * processor. */
#ifndef CORCAST_RENDER_RASTERKERNELS_H
#define CORCAST_RENDER_RASTERKERNELS_H

#include "render/rastertile.h"

/* Lines of sight that belong to no grid, and depths on them. */
typedef struct RasterProbes {
    int n;
    double x[TILE_SAMPLES], y[TILE_SAMPLES]; /* in the plane of the view */
    float z[TILE_SAMPLES];                   /* less z_middle */
    uint8_t covered[TILE_SAMPLES];           /* 1 where an item is seen before that depth, else 0 */
} RasterProbes;

typedef struct RasterKernels {
    /* Finds the first items of the tile; bit i is set where sample i sees one. */
    uint64_t (*trace)(const RasterTile *tile, RasterHits *hits);
    /* State, normal and item (as `segment`) of the hits. */
    void (*resolve)(const RasterTile *tile, const RasterHits *hits, TileHits *surface);
    /* Gives the samples that see nothing the background. */
    void (*clear)(const RasterHits *hits, const float background[3], float color[3][TILE_SAMPLES]);
    /* Stores a whole tile's colours as rows of pixels, `stride` floats from row to row. */
    void (*paint)(float color[3][TILE_SAMPLES], float *pixels, size_t stride);
    /* Sets `covered` of the probes, all of which lie in this tile. */
    void (*cover)(const RasterTile *tile, RasterProbes *probes);
} RasterKernels;

extern const RasterKernels rasterkernels_portable;
#ifdef __x86_64__
extern const RasterKernels rasterkernels_avx2;
#endif
/* The fastest that this processor can run. */
const RasterKernels *rasterkernels_best(void);

#endif
