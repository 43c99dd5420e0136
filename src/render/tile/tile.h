/* What fieldtiles.c prepares and the kernels of kernel_trace.h trace: one tile of 8 x 8 samples,
 * the vessels near it, and what its rays meet. Lengths in mm, in the camera's frame: x right, y up,
 * z along the direction, its origin at the camera's location.
 *
 * The ray of the sample (x, y) of the camera's plane is (x, y, z) when orthographic and
 * (x z, y z, z) when perspective: z is the parameter of both. */
#ifndef CORCAST_RENDER_TILE_H
#define CORCAST_RENDER_TILE_H

#include "scene/scene.h"
#include <stdint.h>

enum { TILE_SIDE = 8, TILE_SAMPLES = TILE_SIDE * TILE_SIDE };

/* A term of the potential as the tile sees it. `o` is where the middle ray passes at z = z_near:
 * its place less the point of the axis that is nearest to the ray. k = potential_k. */
typedef struct TileTerm {
    double z_near;
    double on, off; /* z between which the term may exceed the cut-off on a ray of the tile */
    float k, per_k2;
    float reach2; /* the term is below the cut-off where (k distance)^2 of the segment exceeds it */
    float u, v;   /* k times the distances of that point from the two ends */
    float o[3];
    float axis[3];                /* unit */
    float cross[3];               /* (middle ray's direction) x axis; orthographic: of length k */
    float sine, per_sine, cosine; /* orthographic: of the angle between axis and ray */
    uint32_t segment;             /* index in the scene */
} TileTerm;

/* Samples are numbered so that each run of 16, of 8, and of 4, is a compact block:
 * tile_sample_x/y. */
typedef struct FieldTile {
    const TileTerm *terms; /* by rising `on`, unless in a plane */
    size_t n_terms;
    const Blend *blend;
    bool perspective;
    bool plane;         /* all blend, and lie in one plane, square to all rays */
    const float *x, *y; /* of the samples, relative to the middle ray */
    double middle_x, middle_y;
    float half_size; /* largest distance of a sample from the middle ray */
    double z_min;    /* nothing is seen before it */
} FieldTile;

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

enum { TILE_WORK_BYTES = 1344 }; /* of one term in a kernel's workspace */

typedef enum TileState {
    TILE_MISS = 0, /* proven: nothing is there */
    TILE_HIT,      /* proven: the first hit is there */
    TILE_UNSURE    /* within the margin of the arithmetic, or seen from inside */
} TileState;

typedef struct TileHits {
    double z[TILE_SAMPLES];
    float normal[3][TILE_SAMPLES]; /* unit, facing the viewer, in the camera's frame */
    uint32_t segment[TILE_SAMPLES];
    uint8_t state[TILE_SAMPLES]; /* TileState; z, normal and segment are 0 unless it is a hit */
    bool any_hit, any_unsure;    /* whether a state is such, or was before it was decided */
} TileHits;

/* A tile of a picture: the lines of sight of its samples, and what they see. */
typedef struct SeenTile {
    int column, row;       /* of its first sample, in the grid of all samples of the picture */
    int n_columns, n_rows; /* how many of its samples are inside that grid */
    bool perspective;
    const float *x, *y; /* where samples are in the view's plane, from the tile's middle */
    double middle_x, middle_y;
    const TileHits *hits; /* NULL: nothing is seen in the whole tile */
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

/* The workspace of a kernel, for up to `capacity` terms. */
typedef struct TileWork {
    void *memory;
    size_t capacity;
} TileWork;

/* Makes room for `n` terms. */
MUST_CHECK Status tilework_reserve(TileWork *work, size_t n, Err *err);
void tilework_release(TileWork *work);

#endif
