/* Lists, for each tile of a picture, the segments of an implicit model that can affect the tile. */
#ifndef CORCAST_RENDER_FIELD_VESSELLISTS_H
#define CORCAST_RENDER_FIELD_VESSELLISTS_H

#include "render/field/fieldterms.h"
#include "render/light/lightview.h"
#include "render/tile/interval.h"

/* The segments of a model, sorted into the rows of tiles of a picture. Nothing changes it after it
 * is made. All arrays except `hidden` are owned. */
typedef struct VesselLists {
    Viewpoint eye;
    const bool *hidden;    /* per segment: true if it is left out; NULL: none is. Borrowed. */
    int n_columns, n_rows; /* samples */
    double *x, *y;         /* positions of the columns and rows in the camera's plane */
    double per_x, per_y;   /* samples per unit of x and y; per_y is below 0 */
    double max_offset;     /* largest distance of a sample from the grid, in samples */
    int tile_columns, tile_rows;
    TileSpan listed_columns, listed_rows; /* the tiles that get lists */
    FrameSegment *segments;
    size_t n_segments;
    TileSpan *segment_rows; /* per segment: the rows of tiles that it may affect */
    IndexLists rows;        /* per row of tiles: its segments */
    size_t longest;         /* number of segments of the longest row */
} VesselLists;

/* Moves the segments to the frame of the camera and sorts them into the rows of tiles of the grid.
 * The caller sets *lists to zero first, except `hidden`. The caller releases *lists with
 * vessellists_release, even after an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status vessellists_make(const Geometry *geometry, const Camera *camera,
                                   const SampleGrid *grid, int threads, VesselLists *lists,
                                   Err *err);
/* Sorts the segments into the rows of tiles of a light view. Ownership and errors are those of
 * vessellists_make. */
MUST_CHECK Status vessellists_of_light(const Geometry *geometry, const LightView *view, int threads,
                                       VesselLists *lists, Err *err);
void vessellists_release(VesselLists *lists);

/* Sorts the segments of one row of tiles into one list per tile.
 *
 * columns   workspace of lists->longest spans.
 * tiles     receives the lists. It is zeroed, or was filled by a call with the same *lists.
 * Errors    STATUS_MEMORY. */
MUST_CHECK Status vessellists_row(const VesselLists *lists, size_t row, TileSpan *columns,
                                  IndexLists *tiles, Err *err);

#endif
