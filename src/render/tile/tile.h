/* A tile of a picture: 8 x 8 samples, their lines of sight, and what these see.
 *
 * Lengths are in mm, in the frame of a viewpoint [viewpoint.h]: x right, y up, z along the view,
 * the origin at its location. The line of sight of the sample (x, y) of the view's plane consists
 * of the points (x, y, z) when lines are parallel and (x z, y z, z) in perspective: z is the
 * parameter of both. */
#ifndef CORCAST_RENDER_TILE_H
#define CORCAST_RENDER_TILE_H

#include "scene/scene.h"
#include <stdint.h>

enum { TILE_SIDE = 8, TILE_SAMPLES = TILE_SIDE * TILE_SIDE };

/* Samples of a tile are numbered so that each run of 16, of 8, and of 4, is a compact block; these
 * are column and row of a sample in its tile. */
static inline int tile_sample_x(int sample)
{
    return (sample >> 4 & 1) * 4 + (sample >> 2 & 1) * 2 + (sample & 1);
}

static inline int tile_sample_y(int sample)
{
    return (sample >> 5) * 4 + (sample >> 3 & 1) * 2 + (sample >> 1 & 1);
}

/* The number of the sample at (x, y) of the tile. */
static inline int tile_sample_at(int x, int y)
{
    return (y >> 2) << 5 | (x >> 2) << 4 | (y >> 1 & 1) << 3 | (x >> 1 & 1) << 2 | (y & 1) << 1 |
           (x & 1);
}

typedef enum TileState {
    TILE_MISS = 0, /* proven: nothing is there */
    TILE_HIT,      /* proven: the first hit is there */
    TILE_UNSURE    /* within the margin of the arithmetic, or seen from inside */
} TileState;

/* What the samples see; undefined, but for the state, of samples that are no hits. */
typedef struct TileHits {
    double z[TILE_SAMPLES];
    float normal[3][TILE_SAMPLES];  /* unit; either side of the surface until geometry is stored */
    uint32_t segment[TILE_SAMPLES]; /* index of the scene's segment or primitive */
    uint8_t state[TILE_SAMPLES];    /* TileState */
    bool any_hit, any_unsure; /* of the potential: whether a state is such, or was before it was
                               * decided */
} TileHits;

/* A tile of a picture: the lines of sight of its samples, and what they see. */
typedef struct SeenTile {
    int column, row;       /* of its first sample, in the grid of all samples of the picture */
    int n_columns, n_rows; /* how many of its samples are inside that grid */
    bool perspective;
    const float *x, *y; /* where samples are in the view's plane, from the tile's middle */
    double middle_x, middle_y;
    const TileHits *hits; /* NULL: nothing is seen in the whole tile */
    uint64_t ground;      /* bit i: the hit of sample i is on the ground [canvas_see_ground] */
} SeenTile;

/* How many of a tile's columns or rows are in a picture of which so many are left. */
static inline int tile_extent(int left)
{
    return left < TILE_SIDE ? left : TILE_SIDE;
}

/* In perspective: where a sample's line of sight is at the depth 1 of the view. */
static inline Vec3 seen_line(const SeenTile *seen, int sample)
{
    return vec3(seen->middle_x + (double)seen->x[sample], seen->middle_y + (double)seen->y[sample],
                1);
}

/* Where a sample that is a hit meets the surface, in the frame of the view. */
static inline Vec3 seen_place(const SeenTile *seen, int sample)
{
    Vec3 line = seen_line(seen, sample);
    double z = seen->hits->z[sample], scale = seen->perspective ? z : 1;
    return vec3(line.x * scale, line.y * scale, z);
}

/* How far that is along the line of sight, mm. */
static inline double seen_depth(const SeenTile *seen, int sample)
{
    Vec3 line = seen_line(seen, sample);
    double z = seen->hits->z[sample];
    return seen->perspective ? z * sqrt(1 + line.x * line.x + line.y * line.y) : z;
}

#endif
