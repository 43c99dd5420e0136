/* Computes how thin vessels cover the cells of a picture. A cell is the square of the picture that
 * one sample represents: a pixel for the sample at the pixel's centre, and a square of 1 / N pixel
 * for one of N x N samples per pixel.
 *
 * The projection of a thin vessel is a strip. thincells_fill intersects the strips with a block of
 * cells; the part of a cell that one chain of vessels (a run) covers is a fragment. thincells_over
 * then draws the fragments of a cell over the color of its sample. */
#ifndef CORCAST_RENDER_TILE_THINCELLS_H
#define CORCAST_RENDER_TILE_THINCELLS_H

#include "render/job.h"
#include "render/tile/tile.h"

/* The projection of a thin vessel: a strip around a line. Positions are pixels from the left and
 * upper edges of the picture. */
typedef struct ThinStrip {
    float x[2], y[2];               /* ends of the axis, clipped to the picture */
    float z[2];                     /* depth of the wall nearer to the camera at both ends, along
                                     * the view, mm */
    float part[2];                  /* where the clipped ends are on the vessel: 0 is its first end,
                                     * 1 its second */
    float width;                    /* drawn width, pixels */
    uint32_t vessel;                /* index of the primitive, or of the field segment */
    uint32_t run;                   /* index of the chain of vessels, end to end, that this vessel
                                     * belongs to */
    uint32_t first_piece, n_pieces; /* its pieces, of equal length on the picture, each with one
                                     * color */
} ThinStrip;

/* The thin vessels of a view. All arrays are owned. */
typedef struct ThinLayer {
    bool *is_thin; /* per vessel: true if it is drawn as a strip; render engines skip the vessel */
    ThinStrip *strips; /* in ascending order of vessels */
    size_t n, n_pieces;
    float (*colors)[3]; /* per piece: linear color */
    IndexLists tiles;   /* per tile, row by row: the strips that may touch it, ascending */
    int tile_columns, tile_rows;
    bool perspective;
} ThinLayer;

/* The part of a cell that one run of vessels covers. */
typedef struct ThinFragment {
    uint32_t run, next; /* `next`: index + 1 of the next fragment of the cell; 0: none */
    /* Sums over the strips of the run; areas are fractions of the cell. */
    float area, z;  /* area; depth (mm) times area */
    float color[3]; /* color times area */
} ThinFragment;

/* A fragment and its depth, for sorting. */
typedef struct ThinDepth {
    float z;
    uint32_t index;
} ThinDepth;

/* A block of cells of the picture. */
typedef struct CellBlock {
    int column, row;   /* its first cell */
    int columns, rows; /* its size, cells */
    int per_pixel;     /* cells across a pixel */
} CellBlock;

/* The fragments of a block of cells. A zeroed ThinCells has none. */
typedef struct ThinCells {
    CellBlock block;
    uint32_t *first; /* per cell: index + 1 of its last added fragment; 0: none. Owned. */
    size_t n_cells;  /* length of `first` */
    ARRAY(ThinFragment) fragments;
    ARRAY(ThinDepth) order; /* workspace of thincells_over, reserved by thincells_fill */
} ThinCells;

/* Computes layer->tiles: the strips of each tile.
 *
 * Errors   STATUS_MEMORY.
 * Cost     O(strips + tiles that they touch). */
MUST_CHECK Status thinlayer_sort(ThinLayer *layer, const Camera *camera, Err *err);
void thinlayer_release(ThinLayer *layer);

/* Returns true if no strip touches the tile at (column, row) of the grid of tiles, or if `layer` is
 * NULL. */
bool thinlayer_misses(const ThinLayer *layer, int column, int row);

/* Returns the position along the vessel, 0 to 1 from its first end, of a point of the strip. `s` is
 * the position of the point along the strip on the picture, 0 to 1. */
double thinstrip_part(const ThinLayer *layer, const ThinStrip *strip, double s);

/* Computes the fragments of a block of cells.
 *
 * layer    NULL: there are no fragments.
 * cells    zeroed, or used before; the fragments are replaced. Release it with thincells_release
 *          even after an error.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status thincells_fill(const ThinLayer *layer, CellBlock block, ThinCells *cells,
                                 Err *err);
void thincells_release(ThinCells *cells);

/* Returns true if cell (column, row) of the block has no fragment. */
static inline bool thincells_are_empty(const ThinCells *cells, int column, int row)
{
    return cells->first[row * cells->block.columns + column] == 0;
}

/* Draws the fragments of cell (column, row) of the block over `color`, the linear color of the
 * cell's sample. `z` is the depth of the sample's hit along the view, mm; fragments behind it are
 * hidden. The remaining runs are drawn from front to back. The positions of different runs in the
 * cell are assumed to be independent, so the transparencies multiply. */
void thincells_over(ThinCells *cells, int column, int row, float z, float color[3]);

#endif
