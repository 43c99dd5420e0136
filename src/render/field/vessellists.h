/* Lists, for each tile of a picture, the segments of an implicit surface that can affect the tile.
 * vessellists_make or vessellists_of_light sorts the segments into rows of tiles; vessellists_row
 * then sorts one row into tiles. */
#ifndef CORCAST_RENDER_FIELD_VESSELLISTS_H
#define CORCAST_RENDER_FIELD_VESSELLISTS_H

#include "render/field/fieldterms.h"
#include "render/light/lightview.h"
#include "render/tile/interval.h"

/* The segments of an implicit surface, sorted into the rows of tiles of a picture. The lists do not
 * change after they are made. All arrays except `hidden` are owned. */
typedef struct VesselLists {
    Viewpoint eye;
    const bool *hidden;    /* per segment: true if it is left out; NULL: none is. Borrowed. */
    int n_columns, n_rows; /* numbers of columns and rows of samples */
    double *x, *y; /* positions of the columns and rows of samples in the view's plane: mm, or,
                    * in perspective, mm at depth 1 */
    double per_x, per_y; /* samples per unit of x and y; per_y is below 0, as rows run downwards */
    double max_offset;   /* maximum distance of a sample from its grid position, in samples */
    int tile_columns, tile_rows;
    TileSpan listed_columns, listed_rows; /* the tiles that get lists */
    FrameSegment *segments;
    size_t n_segments;
    TileSpan *segment_rows; /* per segment: the rows of tiles that it may affect */
    IndexLists rows;        /* per row of tiles: its segments */
    size_t longest;         /* number of segments of the longest row */
} VesselLists;

/* Transforms the segments to the frame of the camera, and sorts them into the rows of tiles of the
 * sample grid. Before the call, the caller zeroes *lists and may set lists->hidden. The caller
 * releases *lists with vessellists_release, even after an error. Errors: STATUS_MEMORY. */
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
 * columns   workspace for lists->longest elements.
 * tiles     receives the lists. It must be zeroed, or be the result of a previous call with the
 *           same *lists.
 * Errors    STATUS_MEMORY. */
MUST_CHECK Status vessellists_row(const VesselLists *lists, size_t row, TileSpan *columns,
                                  IndexLists *tiles, Err *err);

#endif
