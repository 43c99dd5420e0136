/* Finds the first hits of the samples of an image of an implicit model, tile by tile. The segments
 * are sorted into rows of tiles once; the tiles of a row are listed when the row is drawn:
 *
 *     FieldTiles *tiles;
 *     TRY(fieldtiles_new(&params, &tiles, err));
 *     TRY(fieldtiles_list(tiles, row, worker, err));                       per row
 *     TRY(fieldtiles_trace(tiles, worker, &traced, &hits, err));           per tile of the row
 *     fieldtiles_free(tiles); */
#ifndef CORCAST_RENDER_FIELD_FIELDTILES_H
#define CORCAST_RENDER_FIELD_FIELDTILES_H

#include "render/field/fieldkernels.h"
#include "render/field/vessellists.h"

/* Immutable after construction, except one workspace per worker. */
typedef struct FieldTiles FieldTiles;

/* The parameters of fieldtiles_new. Geometry, camera and `hidden` are borrowed. */
typedef struct FieldTilesParams {
    const Geometry *geometry;
    const Camera *camera;
    SampleGrid grid;
    const bool *hidden; /* per segment: true if it is not drawn; NULL: none is hidden */
    double z_min;       /* hits nearer than this along a ray are not visible, mm */
    int workers;
    RenderKernels kernels;
} FieldTilesParams;

/* Moves the segments to the camera's frame and sorts them into the rows of tiles of the grid.
 *
 * out      receives the tiles; release them with fieldtiles_free. Set on success only.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status fieldtiles_new(const FieldTilesParams *params, FieldTiles **out, Err *err);
/* Frees the tiles. NULL is allowed. */
void fieldtiles_free(FieldTiles *tiles);

/* Makes the lists of one row of tiles in the worker's workspace. They are valid until the worker's
 * next call. `worker` is the index of the calling thread, in [0, params.workers). Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status fieldtiles_list(FieldTiles *tiles, int row, int worker, Err *err);
/* Returns true if the tile in this column of the row has segments. */
bool fieldtiles_is_listed(const FieldTiles *tiles, int column, int worker);

/* Finds the first hits of one tile of the listed row.
 *
 * traced  on entry, column, row, n_columns and n_rows are set. Receives the sample positions;
 *         traced->hits becomes `hits`, or NULL if no sample hits anything.
 * hits    receives the hits; no sample of the image is TILE_UNSURE.
 * Errors  STATUS_MEMORY. */
MUST_CHECK Status fieldtiles_trace(FieldTiles *tiles, int worker, TracedTile *traced,
                                   TileHits *hits, Err *err);

#endif
