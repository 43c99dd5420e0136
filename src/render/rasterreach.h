/* In which tiles of a view an item may be seen, and where in them. */
#ifndef CORCAST_RENDER_RASTERREACH_H
#define CORCAST_RENDER_RASTERREACH_H

#include "render/rasterview.h"

/* The slab that the lines of sight of a row of tiles fill. */
typedef struct RasterSlab {
    double y[2], per_length[2]; /* lowest and highest */
} RasterSlab;

RasterSlab rasterslab_of(const RasterView *view, size_t row);

/* Where the whole of an item is seen. */
typedef struct RasterReach {
    RasterSpan rows, columns;
    uint32_t box; /* RasterBox, its y the least in the first row and the greatest in the last */
    float near;
} RasterReach;

/* The rows alone. */
RasterSpan rasterreach_rows(const RasterView *view, const RasterItem *item);
/* Box and depth only if the view asks for boxes. */
RasterReach rasterreach_of(const RasterView *view, const RasterItem *item);
/* The columns of a row, one of reach->rows, and the box there. */
RasterSpan rasterreach_in_row(const RasterReach *reach, const RasterView *view,
                              const RasterItem *item, int row, const RasterSlab *slab,
                              uint32_t *box);

#endif
