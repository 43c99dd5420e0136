/* The shading points of a band of pixels, and the visibility of area lights at them.
 * pixelpoints_find finds the points, arealights_compute computes the visibility. The points are
 * sorted so that consecutive points query the same few tiles of a light view. */
#ifndef CORCAST_RENDER_LIGHT_PIXELPOINTS_H
#define CORCAST_RENDER_LIGHT_PIXELPOINTS_H

#include "render/light/bandvisibility.h"

/* Columns and rows of a block of pixels. */
enum { PIXEL_BLOCK = VISIBILITY_BLOCK };

/* A block of pixels of the band: columns [first_column, end_column), rows [first_row, end_row). */
typedef struct PixelBlock {
    int first_column, end_column, first_row, end_row;
} PixelBlock;

/* Returns the number of blocks that cover a side of `pixels` pixels. */
static inline size_t blocks_across(int pixels)
{
    return ((size_t)pixels + PIXEL_BLOCK - 1) / PIXEL_BLOCK;
}

/* Returns block `index` of the `rows` rows from row `first` of the band on. Blocks are numbered row
 * by row, from the left. */
static inline PixelBlock pixelblock_at(const PixelVisibility *visibility, size_t index, int first,
                                       int rows)
{
    size_t across = blocks_across(visibility->width);
    int column = (int)(index % across) * PIXEL_BLOCK;
    int row = first + (int)(index / across) * PIXEL_BLOCK;
    int end_column = column + PIXEL_BLOCK, end_row = row + PIXEL_BLOCK;
    return (PixelBlock){column, end_column < visibility->width ? end_column : visibility->width,
                        row, end_row < first + rows ? end_row : first + rows};
}

/* Returns the index of the pixel at (column, row) in the band's arrays per pixel. */
static inline size_t pixel_at(const PixelVisibility *visibility, int column, int row)
{
    return (size_t)row * (size_t)visibility->width + (size_t)column;
}

/* The shading points with the indices [begin, end). All belong to one sample set. */
typedef struct PointRun {
    size_t begin, end;
    int sample_set;
} PointRun;

/* The two parts of an element of PixelPoints.n_visible. GROUND_FLAG: the pixel shows the ground
 * plane. VISIBLE_COUNT: mask of the number of visible points of the light that arealights_compute
 * processes; it takes one light after another. An element has 16 bits, so a light may have at most
 * VISIBLE_COUNT points. */
enum { GROUND_FLAG = 1 << 15, VISIBLE_COUNT = GROUND_FLAG - 1 };

/* Additional data of the shading points of a band; their positions are PixelVisibility.points. All
 * arrays are owned.
 *
 * Points are sorted by groups of a few rows of pixel blocks, then by sample set [shadowpass.h],
 * then by pixel block. If no area light is queried, all points belong to set 0, so that
 * neighbouring pixels are consecutive; pixel_of_point and n_visible are then NULL. */
typedef struct PixelPoints {
    bool queries_lights; /* true: area lights are queried */
    size_t n;            /* number of points */
    PointRun *runs;
    size_t n_runs;
    Box bounds;               /* bounds of the points, mm, relative to PixelVisibility.origin; set
                               * if queries_lights */
    uint32_t *pixel_of_point; /* per point: its pixel */
    uint16_t *n_visible;      /* per pixel: the flag and the count. pixelpoints_find sets the flag;
                               * the count is 0 until arealights.c sets it. */
} PixelPoints;

/* Finds the shading points of the band: draws the vessels with sources->draw_planes, then adds the
 * view's ground plane.
 *
 * visibility  receives point_index and points. The caller sets all other members before.
 * points      receives the data. Before the call, the caller sets queries_lights and zeroes the
 *             rest. Release it with pixelpoints_release, even after an error.
 * Errors      STATUS_MEMORY. */
MUST_CHECK Status pixelpoints_find(const Drawing *drawing, const VisibilitySources *sources,
                                   PixelVisibility *visibility, PixelPoints *points, Err *err);
void pixelpoints_release(PixelPoints *points);

/* Computes soft shadows at the shading points [arealights.c]. Sets visibility->lights[i] for each
 * area light i of the view that casts shadows, and the visibility of these lights at
 * sources->off_pixel.
 *
 * points   the data of visibility->points, with queries_lights true.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status arealights_compute(const Drawing *drawing, const VisibilitySources *sources,
                                     PixelPoints *points, PixelVisibility *visibility, Err *err);

#endif
