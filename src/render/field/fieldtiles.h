/* The first hit of every sample of a tile of the potential. */
#ifndef CORCAST_RENDER_FIELDTILES_H
#define CORCAST_RENDER_FIELDTILES_H

#include "render/field/fieldkernels.h"
#include "render/field/vessellists.h"

/* Immutable after construction, except one workspace per worker. */
typedef struct FieldTiles FieldTiles;

/* What a FieldTiles is made for. Geometry, camera and `hidden` are borrowed. */
typedef struct FieldTilesParams {
    const Geometry *geometry;
    const Camera *camera;
    SampleGrid grid;
    const bool *hidden; /* per segment: not seen; NULL: none is hidden */
    double z_min;       /* nothing is seen nearer along a ray, mm */
    int workers;
    RenderKernels kernels;
} FieldTilesParams;

/* Moves the segments to the camera's frame and sorts them into the rows of tiles of the grid.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status fieldtiles_new(const FieldTilesParams *params, FieldTiles **out, Err *err);
void fieldtiles_free(FieldTiles *tiles);

/* Makes the lists of one row of tiles in the worker's workspace, until its next call. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status fieldtiles_list(FieldTiles *tiles, int row, int worker, Err *err);
/* Returns true if the tile in this column of the row has segments. */
bool fieldtiles_is_listed(const FieldTiles *tiles, int column, int worker);

/* Sets the sample positions of a tile of the row whose column, row, columns and rows are set, and
 * its hits. traced->hits becomes `hits`, or NULL if no sample hits anything. No sample is
 * TILE_UNSURE then. Errors: STATUS_MEMORY. */
MUST_CHECK Status fieldtiles_trace(FieldTiles *tiles, int worker, TracedTile *traced,
                                   TileHits *hits, Err *err);

#endif
