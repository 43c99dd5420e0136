/* The first hit of every sample of a tile of the potential. */
#ifndef CORCAST_RENDER_FIELDTILES_H
#define CORCAST_RENDER_FIELDTILES_H

#include "render/field/fieldkernels.h"
#include "render/field/vessellists.h"
#include "render/tile/viewpoint.h"

/* Constant once built but for the workspaces, one a worker. */
typedef struct FieldTiles FieldTiles;

/* Prepares the segments of an implicit model for a camera; geometry and grid are borrowed. Nothing
 * is seen nearer than z_min mm along a ray. */
MUST_CHECK Status fieldtiles_new(const Geometry *geometry, const Camera *camera,
                                 const SampleGrid *grid, double z_min, int workers,
                                 FieldTiles **out, Err *err);
void fieldtiles_free(FieldTiles *tiles);

/* Rows of tiles. */
size_t fieldtiles_rows(const FieldTiles *tiles);
/* Tiles in a row. */
size_t fieldtiles_columns(const FieldTiles *tiles);

/* Is shown a tile whose samples are known, none of them TILE_UNSURE. Its sample n is that of the
 * grid at (column + tile_sample_x(n), row + tile_sample_y(n)) if that is inside the grid. */
typedef void TileVisitor(const SeenTile *seen, int worker, void *context);

/* Finds the hits of one row of tiles and shows each tile to `visit`, from left to right: those only
 * whose byte in `wanted`, one a column of tiles, is not 0, or all when that is NULL. STATUS_MEMORY
 * when a workspace cannot grow. */
MUST_CHECK Status fieldtiles_trace(FieldTiles *tiles, size_t row, int worker, const uint8_t *wanted,
                                   TileVisitor *visit, void *context, Err *err);

/* Traces with this kernel from now on, not with the fastest. */
void fieldtiles_use_kernel(FieldTiles *tiles, FieldKernel *trace);

#endif
