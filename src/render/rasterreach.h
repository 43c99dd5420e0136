/* In which tiles of a view an item may be seen, and where in them. */
#ifndef CORCAST_RENDER_RASTERREACH_H
#define CORCAST_RENDER_RASTERREACH_H

#include "render/rasterview.h"

/* The slab that the lines of sight of a row of tiles fill. */
typedef struct RasterSlab {
    double y[2], per_length[2]; /* lowest and highest */
} RasterSlab;

RasterSlab rasterslab_of(const RasterView *view, size_t row);

RasterSpan rasterreach_rows(const RasterView *view, const RasterItem *item);
/* Those of one row, the slab of which is given. */
RasterSpan rasterreach_columns(const RasterView *view, const RasterItem *item,
                               const RasterSlab *slab);

typedef struct RasterRange {
    double low, high;
} RasterRange;

/* What the boxes of an item have in common. */
typedef struct RasterReach {
    RasterRange down, across; /* pixels that the whole of it covers */
    RasterSpan columns;
    float near; /* as in RasterBox */
} RasterReach;

RasterReach rasterreach_of(const RasterView *view, const RasterItem *item);
/* The columns of a row, one of `rows`, and the box of the item there. */
RasterSpan rasterreach_box(const RasterReach *reach, const RasterView *view, const RasterItem *item,
                           RasterSpan rows, int row, const RasterSlab *slab, RasterBox *box);

#endif
