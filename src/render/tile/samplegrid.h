/* The sample positions of one pass over an image: a grid of side x side samples per pixel. */
#ifndef CORCAST_RENDER_TILE_SAMPLEGRID_H
#define CORCAST_RENDER_TILE_SAMPLEGRID_H

#include "render/job.h"

typedef struct SampleGrid {
    int side;                             /* samples per pixel in each direction, 1 or more */
    double offsets[RENDER_MAX_ANTIALIAS]; /* offsets of a pixel's samples from its centre, in
                                           * pixels, the same in both directions */
    int n_columns, n_rows;                /* number of samples across and down the image */
} SampleGrid;

/* Returns the position of a column or row of samples, in pixels as camera_ray() takes it. */
static inline double samplegrid_at(const SampleGrid *grid, int index)
{
    return index / grid->side + grid->offsets[index % grid->side];
}

#endif
