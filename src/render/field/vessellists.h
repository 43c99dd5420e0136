/* Which segments of an implicit model may matter in which tile of a picture. */
#ifndef CORCAST_RENDER_VESSELLISTS_H
#define CORCAST_RENDER_VESSELLISTS_H

#include "render/field/fieldterms.h"
#include "render/light/lightview.h"
#include "render/tile/interval.h"
#include "render/tile/samplegrid.h"

/* Constant once built. */
typedef struct VesselLists {
    Viewpoint eye;
    const bool *hidden;    /* per segment: not seen; NULL: none is hidden. Borrowed; set before. */
    int n_columns, n_rows; /* samples */
    double *x, *y;         /* of the grid's columns and rows, in the camera's plane */
    double per_x, per_y;   /* samples in a unit there, per_y below 0 */
    double stray;          /* samples are up to so much off their places, in samples */
    int tile_columns, tile_rows;
    TileSpan listed_columns, listed_rows; /* of tiles: those whose lists are not left empty */
    FrameSegment *segments;
    size_t n_segments;
    TileSpan *segment_rows; /* of tiles */
    IndexLists rows;        /* segments of each row of tiles */
    size_t longest;         /* of those */
} VesselLists;

/* Moves the segments to the frame of the camera and sorts them into the rows of tiles of the grid.
 * *lists is zeroed before except `hidden`, and the caller's even when this fails. STATUS_MEMORY. */
MUST_CHECK Status vessellists_make(const Geometry *geometry, const Camera *camera,
                                   const SampleGrid *grid, int threads, VesselLists *lists,
                                   Err *err);
/* The same for the tiles of a light's view. */
MUST_CHECK Status vessellists_of_light(const Geometry *geometry, const LightView *view, int threads,
                                       VesselLists *lists, Err *err);
void vessellists_release(VesselLists *lists);

/* Sets the lists of the tiles of one row: *tiles, zeroed before or used for these lists; `columns`
 * has room for the longest row. STATUS_MEMORY. */
MUST_CHECK Status vessellists_row(const VesselLists *lists, size_t row, TileSpan *columns,
                                  IndexLists *tiles, Err *err);

#endif
