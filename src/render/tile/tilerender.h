/* Draws an image tile by tile. An engine that draws tiles is a TileEngine, a table of functions.
 * For each tile, these find the first hit of each sample (`bin` once, `list` per row of tiles,
 * `trace` per tile). The functions tilerender_* do the rest: batches, shadows, shading,
 * antialiasing and threads. */
#ifndef CORCAST_RENDER_TILE_TILERENDER_H
#define CORCAST_RENDER_TILE_TILERENDER_H

#include "render/light/shadowengine.h"
#include "render/tile/thincells.h"

/* A tile of a batch, and the results for its samples. */
typedef struct BatchTile {
    TracedTile traced; /* traced.hits is `hits`, or NULL if the tile shows nothing */
    TileHits hits;
    double depth_base;                 /* mm; TileEngine.single_depths */
    void *own;                         /* scratch of the engine, TileEngine.tile_bytes long;
                                        * initially zero */
    uint32_t *items;                   /* per hit: ShadowPoints.item, set by TileEngine.trace; NULL:
                                        * the engine's shadows do not need it */
    uint8_t (*shadowed)[TILE_SAMPLES]; /* per light; 1: the light is hidden from the sample */
    float (*sum)[TILE_SAMPLES];        /* per channel: sum of a pixel's samples; shifted passes */
    ThinCells cells, further;          /* thin vessels over the samples, and over shifted samples */
} BatchTile;

/* A tile engine. One pass takes one sample per grid point. Each worker has its own workspace. */
typedef struct TileEngine {
    /* How antialiasing with N x N samples per pixel is done. True: on a second grid, N times as
     * fine, with bins of its own. False: by N x N shifted passes over the same tiles. */
    bool fine_grid;
    bool either_side;   /* hits have normals that may point away from the viewer */
    bool single_depths; /* depths are single precision about BatchTile.depth_base */
    int batch_tiles;    /* tiles that are shaded together if there are shadows, else 1 */
    int rows_at_once;   /* rows of tiles that share batches if there are shadows, else 1 */
    size_t tile_bytes;  /* size of BatchTile.own */
    const ShadowEngine *shadows;

    /* Sorts the drawing's geometry into the tiles of `grid` in *bins, which the caller releases.
     * Sets *bins on success only. Errors: STATUS_MEMORY; STATUS_USAGE for a view that the engine
     * cannot draw. */
    Status (*bin)(const Drawing *drawing, const SampleGrid *grid, void **bins, Err *err);
    void (*release)(void *bins);
    /* Makes the lists of one row of tiles in the worker's workspace. They are valid until its next
     * call. Errors: STATUS_MEMORY. */
    Status (*list)(void *bins, int row, int worker, Err *err);
    /* Returns true if the list of a tile of that row is not empty. */
    bool (*is_listed)(const void *bins, int column, int worker);
    /* Sets the sample positions of `tile`, a tile of that row, and its hits. `shift` is the index
     * of a shifted pass, row by row, or -1 for the positions of the grid. Errors: STATUS_MEMORY. */
    Status (*trace)(void *bins, int worker, int shift, BatchTile *tile, Err *err);
} TileEngine;

/* Functions for the members prepare, rows and free of an Engine, with the contracts of
 * render/engine.h. `engine` is borrowed until tilerender_free. The drawing must have a caster if
 * shadowengine_needs_rays returns true for it. */
MUST_CHECK Status tilerender_prepare(const TileEngine *engine, const Drawing *drawing,
                                     void **prepared, Err *err);
MUST_CHECK Status tilerender_rows(const Drawing *drawing, void *prepared, Frame *frame, Err *err);
void tilerender_free(void *prepared);

/* Returns the light bins of light `light` (an index in View.lights) from the result of
 * tilerender_prepare, for points in the frame of the camera. Borrowed. NULL: none were made. */
LightBins *tilerender_light_bins(const void *prepared, size_t light);

#endif
