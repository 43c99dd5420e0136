/* A tile of an image: 8 x 8 samples, their lines of sight, and their hits.
 *
 * Lengths are in mm, in the frame of a viewpoint [viewpoint.h]: x right, y up, z along the view
 * direction, the origin at its location. A sample is a point (x, y) of the view's plane. Its line
 * of sight consists of the points (x, y, z) in a parallel view, and of the points (x z, y z, z) in
 * perspective. In both, z is the parameter of the line. */
#ifndef CORCAST_RENDER_TILE_TILE_H
#define CORCAST_RENDER_TILE_TILE_H

#include "render/job.h"
#include "scene/scene.h"
#include <stdint.h>

/* Columns and rows of a tile, and number of its samples: the bits of a uint64_t. */
enum { TILE_SIDE = 8, TILE_SAMPLES = TILE_SIDE * TILE_SIDE };

/* Samples of a tile are numbered in Morton order: each aligned group of 4, 8 or 16 samples is a
 * rectangular block. These functions return the column and the row of a sample in its tile. */
static inline int tile_sample_x(int sample)
{
    return (sample >> 4 & 1) * 4 + (sample >> 2 & 1) * 2 + (sample & 1);
}

static inline int tile_sample_y(int sample)
{
    return (sample >> 5) * 4 + (sample >> 3 & 1) * 2 + (sample >> 1 & 1);
}

/* Returns the index of the sample in column x and row y of its tile, each in 0 .. 7. */
static inline int tile_sample_at(int x, int y)
{
    return (y >> 2) << 5 | (x >> 2) << 4 | (y >> 1 & 1) << 3 | (x >> 1 & 1) << 2 | (y & 1) << 1 |
           (x & 1);
}

/* What is known about a sample. */
typedef enum TileState {
    TILE_MISS = 0, /* the line of sight certainly hits nothing */
    TILE_HIT,      /* the stored hit is certainly the first */
    TILE_UNSURE    /* not decided: within rounding errors, or the line starts inside a vessel */
} TileState;

/* The hits of the samples. For a sample that is not TILE_HIT, only `state` is defined. */
typedef struct TileHits {
    double z[TILE_SAMPLES];         /* depth, mm */
    float normal[3][TILE_SAMPLES];  /* unit; may point away from the viewer if the engine has
                                     * TileEngine.either_side [tilerender.h] */
    uint32_t segment[TILE_SAMPLES]; /* index of the field segment or primitive of the geometry */
    uint8_t state[TILE_SAMPLES];    /* TileState */
    bool any_hit, any_unsure;       /* set by engines of implicit surfaces only. any_hit: a sample
                                     * is TILE_HIT. any_unsure: a sample is TILE_UNSURE, or was
                                     * before it was decided */
} TileHits;

/* Returns the vector of a sample from arrays per component. */
static inline Vec3 tile_vector(const float v[3][TILE_SAMPLES], int sample)
{
    return vec3((double)v[0][sample], (double)v[1][sample], (double)v[2][sample]);
}

/* Stores the vector of a sample in arrays per component. */
static inline void tile_set_vector(float to[3][TILE_SAMPLES], int sample, Vec3 v)
{
    to[0][sample] = (float)v.x;
    to[1][sample] = (float)v.y;
    to[2][sample] = (float)v.z;
}

/* A tile whose lines of sight have been traced. */
typedef struct TracedTile {
    int column, row;       /* position of its upper left sample in the image's grid of samples */
    int n_columns, n_rows; /* numbers of its columns and rows that are inside the grid */
    bool perspective;
    const float *x, *y;        /* positions of samples in the view's plane, relative to the tile's
                                * middle */
    double middle_x, middle_y; /* middle of the tile in the view's plane */
    const TileHits *hits;      /* borrowed; NULL: no sample of the tile hits anything */
    uint64_t ground;           /* bit mask: bit i is set if the hit of sample i is on the ground
                                * [canvas_trace_ground] */
} TracedTile;

/* The sample positions of one pass over an image: a grid of side x side samples per pixel. */
typedef struct SampleGrid {
    int side;                             /* samples per pixel in each direction, 1 or more */
    double offsets[RENDER_MAX_ANTIALIAS]; /* offsets of a pixel's samples from its centre, in
                                           * pixels, the same in both directions */
    int n_columns, n_rows;                /* number of samples across and down the image */
} SampleGrid;

/* Returns the position of a column or row of samples, in pixels as in camera_ray. */
static inline double samplegrid_at(const SampleGrid *grid, int index)
{
    return index / grid->side + grid->offsets[index % grid->side];
}

/* Returns the number of columns (or rows) of a tile in an image of which `left` > 0 columns (rows)
 * remain. */
static inline int tile_extent(int left)
{
    return left < TILE_SIDE ? left : TILE_SIDE;
}

/* Returns the position of a sample in the view's plane, with z = 1. In perspective this is the
 * point of its line of sight at depth 1. */
static inline Vec3 tile_line(const TracedTile *traced, int sample)
{
    return vec3(traced->middle_x + (double)traced->x[sample],
                traced->middle_y + (double)traced->y[sample], 1);
}

/* Returns the point where the line of sight of a TILE_HIT meets the surface, in the view's
 * frame. */
static inline Vec3 tile_hit_point(const TracedTile *traced, int sample)
{
    Vec3 line = tile_line(traced, sample);
    double z = traced->hits->z[sample], scale = traced->perspective ? z : 1;
    return vec3(line.x * scale, line.y * scale, z);
}

/* Returns the distance along the line of sight to the hit of a sample, mm. */
static inline double tile_hit_distance(const TracedTile *traced, int sample)
{
    Vec3 line = tile_line(traced, sample);
    double z = traced->hits->z[sample];
    return traced->perspective ? z * sqrt(1 + line.x * line.x + line.y * line.y) : z;
}

#endif
