/* In which tiles of a view an item may be seen, and where in them. */
#ifndef CORCAST_RENDER_RASTERREACH_H
#define CORCAST_RENDER_RASTERREACH_H

#include "render/raster/rasterview.h"

/* The slab that the lines of sight of a row of tiles fill. */
typedef struct RasterSlab {
    double y[2], per_length[2]; /* lowest and highest */
} RasterSlab;

RasterSlab rasterslab_of(const RasterView *view, size_t row);

/* Sets tiles and box of an item. */
void rasterreach_set(const RasterView *view, RasterItem *item);
/* A depth before which nothing of it is, less z_middle. */
float rasterreach_near(const RasterView *view, const RasterItem *item);
/* The columns of one of its rows, and the box there. */
TileSpan rasterreach_in_row(const RasterView *view, const RasterItem *item, int row,
                            const RasterSlab *slab, uint32_t *box);

#endif
