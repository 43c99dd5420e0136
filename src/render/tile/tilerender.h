/* Draws an image tile by tile, with an engine that finds the hits of a tile. The engine is a
 * TileEngine, a table of functions: `bin` sorts the geometry once per view, `list` prepares one row
 * of tiles, and `trace` finds the first hit of each sample of a tile. The tilerender_... functions
 * do everything else: batches of tiles, shadows, shading, antialiasing and threads. */
#ifndef CORCAST_RENDER_TILE_TILERENDER_H
#define CORCAST_RENDER_TILE_TILERENDER_H

#include "render/light/shadowengine.h"
#include "render/tile/thincells.h"

/* A tile of a batch (tiles that are shaded together), and the results for its samples. The first
 * pass over the tiles draws the centre sample of each pixel. Antialiasing draws N x N further
 * samples per pixel, in the way that TileEngine.fine_grid selects. */
typedef struct BatchTile {
    TracedTile traced; /* traced.hits points to `hits`; NULL if no sample hits anything */
    TileHits hits;
    double depth_base;                 /* depth to which depths are relative, mm; used if
                                        * TileEngine.single_depths is true */
    void *own;                         /* the engine's own data of the tile, TileEngine.tile_bytes
                                        * long; initially zero */
    uint32_t *items;                   /* per sample: ShadowPoints.item, set by TileEngine.trace;
                                        * NULL: the engine's shadows do not use it */
    uint8_t (*shadowed)[TILE_SAMPLES]; /* [light][sample]: 1 if the sample is in the shadow of the
                                        * light */
    float (*sum)[TILE_SAMPLES];        /* per channel: sum of the pixel's samples so far; used by
                                        * shifted passes */
    ThinCells cells;                   /* thin vessels in the cells of the samples: pixels, or, with
                                        * fine_grid, 1 / N pixels */
    ThinCells further;                 /* thin vessels in the 1 / N pixel cells of shifted passes */
} BatchTile;

/* A tile engine. A pass draws one sample per point of a sample grid; the grid of the first pass has
 * the centres of the pixels. Each worker (thread) has its own workspace in the bins. */
typedef struct TileEngine {
    /* How the N x N further samples of antialiasing are drawn. true: on a second sample grid, N
     * times as fine, with bins of its own. false: by N x N shifted passes over the same tiles. */
    bool fine_grid;
    bool either_side;   /* true: normals of hits may point away from the viewer */
    bool single_depths; /* true: depths are single-precision numbers, relative to
                         * BatchTile.depth_base */
    /* With shadows, tiles are shaded in batches, because many shadow queries are answered faster
     * together; without shadows both numbers are 1. */
    int batch_tiles;             /* number of tiles of a batch */
    int rows_at_once;            /* number of rows of tiles that share batches */
    size_t tile_bytes;           /* size of BatchTile.own */
    const ShadowEngine *shadows; /* answers shadow queries */

    /* Sorts the drawing's geometry into the tiles of `grid`. *bins receives the result; the caller
     * frees it with `release`. Set on success only. Errors: STATUS_MEMORY; STATUS_USAGE for a view
     * that the engine cannot draw. */
    Status (*bin)(const Drawing *drawing, const SampleGrid *grid, void **bins, Err *err);
    void (*release)(void *bins);
    /* Makes the lists of one row of tiles in the worker's workspace: per tile, the items that may
     * be hit in it. They are valid until the worker's next call. Errors: STATUS_MEMORY. */
    Status (*list)(void *bins, int row, int worker, Err *err);
    /* Returns true if the list of the tile in column `column` of the row of the last `list` call is
     * not empty. */
    bool (*is_listed)(const void *bins, int column, int worker);
    /* Computes the sample positions and the hits of `tile`, a tile of the row of the last `list`
     * call. `shift` is the index of a shifted pass, row by row; -1: the positions of the grid.
     * Errors: STATUS_MEMORY. */
    Status (*trace)(void *bins, int worker, int shift, BatchTile *tile, Err *err);
} TileEngine;

/* Implementations of the members prepare, rows and free of Engine, with the contracts of
 * render/engine.h. `engine` is borrowed until tilerender_free. If shadowengine_needs_rays returns
 * true for the drawing, Drawing.caster must not be NULL. */
MUST_CHECK Status tilerender_prepare(const TileEngine *engine, const Drawing *drawing,
                                     void **prepared, Err *err);
MUST_CHECK Status tilerender_rows(const Drawing *drawing, void *prepared, Frame *frame, Err *err);
void tilerender_free(void *prepared);

/* Returns the light bins that tilerender_prepare made for a light, for points in the frame of the
 * camera. `prepared` is its result, `light` an index in View.lights. The bins are borrowed. Returns
 * NULL if none were made. */
LightBins *tilerender_light_bins(const void *prepared, size_t light);

#endif
