/* Coverage of the cells of a picture by thin vessels. A cell is the square of the picture that one
 * sample stands for: a pixel for the sample at the pixel's centre, 1 / N of a pixel across for N x
 * N samples per pixel. */
#ifndef CORCAST_RENDER_TILE_THINCELLS_H
#define CORCAST_RENDER_TILE_THINCELLS_H

#include "render/job.h"
#include "render/tile/tile.h"

/* The projection of a thin vessel: a strip about a line. Positions are pixels from the left and
 * upper edges. */
typedef struct ThinStrip {
    float x[2], y[2]; /* ends of the axis, clipped to the picture */
    float z[2];       /* depth of the near wall along the view at both ends, mm */
    float part[2];    /* where the clipped ends lie on the vessel, 0..1 from its first end */
    float width;      /* drawn width, pixels */
    uint32_t vessel;  /* index of the primitive, or of the segment of a field */
    uint32_t run;     /* equal for vessels that follow one another end to end */
    uint32_t first_piece, n_pieces; /* pieces of equal length on the picture, each with one color */
} ThinStrip;

/* The thin vessels of a view. */
typedef struct ThinLayer {
    bool *is_thin; /* per vessel: drawn by strips; engines leave it out. All arrays are owned. */
    ThinStrip *strips; /* in ascending order of vessels */
    size_t n, n_pieces;
    float (*colors)[3]; /* per piece: linear color */
    IndexLists tiles;   /* per tile, row by row: the strips that may touch it, ascending */
    int tile_columns, tile_rows;
    bool perspective;
} ThinLayer;

/* Part of a cell that one run of vessels covers. */
typedef struct ThinFragment {
    uint32_t run, next; /* next: index + 1 of the cell's next fragment; 0: last */
    float area, z;      /* sums over lines of area, and of depth times area */
    float color[3];     /* sum of color times area */
} ThinFragment;

/* A fragment in the order of depth. */
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

/* The fragments of a block of cells. Zeroed, there are none. */
typedef struct ThinCells {
    CellBlock block;
    uint32_t *first; /* per cell: index + 1 of its latest fragment; 0: none. Owned. */
    size_t n_cells;  /* length of `first` */
    ARRAY(ThinFragment) fragments;
    ARRAY(ThinDepth) order; /* workspace of thincells_over */
} ThinCells;

/* Lists the strips of each tile.
 * Errors   STATUS_MEMORY.
 * Cost     O(strips and the tiles that they touch). */
MUST_CHECK Status thinlayer_sort(ThinLayer *layer, const Camera *camera, Err *err);
void thinlayer_release(ThinLayer *layer);

/* Returns true if no strip touches the tile of pixels at (column, row), in tiles. `layer` may be
 * NULL. */
bool thinlayer_misses(const ThinLayer *layer, int column, int row);

/* Returns how far along the vessel, 0..1 from its first end, the point at `s` of the strip lies; s
 * is 0..1 on the picture. */
double thinstrip_part(const ThinLayer *layer, const ThinStrip *strip, double s);

/* Finds the fragments of a block of cells.
 *
 * layer    NULL: there are no fragments.
 * cells    zeroed, or used before; release it with thincells_release even after an error.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status thincells_fill(const ThinLayer *layer, CellBlock block, ThinCells *cells,
                                 Err *err);
void thincells_release(ThinCells *cells);

/* Returns true if cell (column, row) of the block has no fragment. */
static inline bool thincells_are_empty(const ThinCells *cells, int column, int row)
{
    return cells->first[row * cells->block.columns + column] == 0;
}

/* Draws the fragments of cell (column, row) of the block over the linear color of a sample, whose
 * hit has the depth z along the view, mm. Fragments behind z are hidden. Runs are drawn from front
 * to back. Each is taken to cover a random part of the cell: transparencies multiply. */
void thincells_over(ThinCells *cells, int column, int row, float z, float color[3]);

#endif
